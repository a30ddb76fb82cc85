// The ways of hex edges through the tets, as an engine follows them anyway.
#pragma once

#include <array>
#include <vector>

#include <hexhex/types.hpp>

#include <lattice/direction.hpp>
#include <map/tet_topology.hpp>

namespace hexhex {

/// A hex edge in the chart of a tet that it begins in.
struct EdgeRecord {
  std::array<Index, 2> ends;  ///< the hex vertices at its beginning and end
  Index tet;
  GridPoint z;  ///< where it begins
  Direction along;
  bool inside;    ///< its beginning or its end is in the interior of a tet
  Index faceEnd;  ///< its faces end here; they begin where those of the record before end
};

/// Edges, each recorded from one of its ends.
struct EdgeRecords {
  Array<EdgeRecord> edges;
  /// The faces that they cross on their way, each on the side where they come from. Where edges lie
  /// in faces or meet edges and vertices of the tets, these are some tets that have parts of them.
  Array<HalfFace> faces;
};

}  // namespace hexhex
