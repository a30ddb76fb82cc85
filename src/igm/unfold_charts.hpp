// Charts in which as many transitions as possible are the identity. Maps with a chart per tet are
// rewritten in common charts, along a spanning tree of the dual graph, before transitions are
// computed (not in the paper; before its Section 5.1.1).
#pragma once

#include <cstddef>
#include <cstdint>

#include <adjacency/tet_topology.hpp>

#include <hexhex/types.hpp>

#include <igm/input.hpp>
#include <igm/transitions.hpp>
#include <lattice/gauge.hpp>

namespace hexhex::igm {

/// Whether, judging by a sample, so many triangles have exact transitions other than the identity
/// that unfolding is worth its time. Not for maps that come with rotations, which are between given
/// charts.
[[nodiscard]] bool needsUnfolding(const adjacency::TetTopology& topology, const OrientedMap& map);

/// Rewrites the parameters of a map in charts that extend along a tree of tets. Later stages then
/// have as little to do as if the map had been given that way: transitions, cuts and closer looks
/// at vertices concern few triangles instead of all. Rotations only change the order and signs of
/// coordinates, and where a sum would be rounded, a tet keeps its chart; so the map stays the same
/// to the last bit.
/// @return per tet: from the given chart (as LocalParameters moved it) into the one used
[[nodiscard]] Array<lattice::Gauge> unfoldCharts(const adjacency::TetTopology& topology,
                                                 OrientedMap& map, Stage& stage);

/// Number of inner faces whose transition between given charts is not the identity.
/// @param gauges  from unfoldCharts(), or empty: no chart differs
[[nodiscard]] std::uint64_t countGivenTransitions(const adjacency::TetTopology& topology,
                                                  const Transitions& transitions,
                                                  const Array<lattice::Gauge>& gauges,
                                                  Stage& stage);

/// Tets per block: what they need should stay in a cache of one or two MB. Smaller blocks are
/// faster, but only inside blocks are cuts as few as those of a single search.
inline constexpr std::size_t kGaugeBlock = std::size_t{1} << 14;

/// Per tet, the transition into a chart that all connected tets share: fitted transitions, composed
/// along a spanning tree. Across faces outside the tree, gauges need not agree.
///
/// The tree comes from breadth-first searches: within blocks of consecutive tets, in parallel, and
/// then from block to block. It does not depend on threads.
[[nodiscard]] Array<lattice::Gauge> computeGauges(const adjacency::TetTopology& topology,
                                                  const LocalParameters& parameters, Stage& stage,
                                                  std::size_t blockSize = kGaugeBlock);

}  // namespace hexhex::igm
