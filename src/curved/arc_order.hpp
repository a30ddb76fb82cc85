// Arcs that were made in any order, in canonical order.
#pragma once

#include <cstdint>
#include <span>

#include <curved/arc_sorter.hpp>
#include <curved/edge_replay.hpp>

#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <map/prepare.hpp>

namespace hexhex {

/// Where arcs are that were made in any order, in canonical order: by the tet that owns the
/// midpoint, and in the order in which that is swept for midpoints.
struct ArcOrder {
  Array<ArcPlace> places;           ///< per arc
  Array<std::uint64_t> pointBegin;  ///< per arc (+1): its first point
};

/// @param counts  by tet: how many arcs belong to each
[[nodiscard]] ArcOrder orderArcs(const PreparedMap& map, std::span<const BlockArcs> blocks,
                                 std::span<const Index> counts, Stage& stage);

}  // namespace hexhex
