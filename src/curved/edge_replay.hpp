// Arcs of recorded edges, in the order of the records.
#pragma once

#include <cstdint>
#include <vector>

#include <curved/arc_pieces.hpp>
#include <curved/lattice_numbers.hpp>

#include <hexhex/types.hpp>

#include <base/shared_counts.hpp>
#include <extract/edge_records.hpp>
#include <map/prepare.hpp>

namespace hexhex {

/// Where an edge has its number from: the owner of its midpoint, the axis of its chart, and where
/// the edge begins there.
struct EdgeKey {
  Index tet;
  std::int32_t axis;
  GridPoint z;
};

/// Arcs of a block of records, in their order.
struct BlockArcs {
  ArcPieces pieces;
  Array<EdgeKey> keys;
};

/// Computes the points where recorded edges cross faces, and traces those anew that meet edges or
/// vertices of the tets or lie in faces.
/// @param counts  by tet: increased by the number of arcs that belong to each
[[nodiscard]] BlockArcs replayEdges(const PreparedMap& map, const LatticeNumbers& vertices,
                                    const EdgeRecords& records, const SharedCounts& counts);

}  // namespace hexhex
