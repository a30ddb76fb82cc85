// Where arcs go, and their points and segments.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <hexhex/curved.hpp>
#include <hexhex/types.hpp>

#include <curved/face_crossing.hpp>
#include <lattice/direction.hpp>

namespace hexhex {

/// What an edge has its canonical number from: the owner of its midpoint, the axis of its chart,
/// and where the edge begins there.
struct EdgeKey {
  Index tet;
  std::int32_t axis;
  GridPoint z;

  EdgeKey() = default;
  /// @param edge  in the owner's chart
  EdgeKey(Index owner, const ChartEdge& edge) noexcept
      : tet(owner), axis(axisOf(edge.along)), z(edge.ascending().z) {}
};

/// Arcs with room for some more, from a first one on.
struct ArcColumns {
  std::array<Index, 2>* ends;
  std::uint64_t* pointBegin;
  EdgeKey* keys;  ///< nullptr if nobody asks for them
  Vec3* points;
  double* parameters;
  Index* generatorTet;
  CornerSet* generatorCorners;
  Index* segmentTet;
  CornerSet* segmentCorners;
  std::uint64_t firstPoint;  ///< the number of the first point

  /// @param arc, point  the numbers of the first ones
  /// @param keysOfArcs  of all arcs, or empty
  ArcColumns(Arcs& arcs, std::uint64_t arc, std::uint64_t point,
             std::span<EdgeKey> keysOfArcs = {}) noexcept
      : ends(arcs.ends.data() + arc),
        pointBegin(arcs.pointBegin.data() + arc),
        keys(keysOfArcs.empty() ? nullptr : keysOfArcs.data() + arc),
        points(arcs.points.data() + point),
        parameters(arcs.parameters.data() + point),
        generatorTet(arcs.generatorTet.data() + point),
        generatorCorners(arcs.generatorCorners.data() + point),
        segmentTet(arcs.segmentTet.data() + point + arc),
        segmentCorners(arcs.segmentCorners.data() + point + arc),
        firstPoint(point) {}
};

}  // namespace hexhex
