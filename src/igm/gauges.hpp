// One chart for all tets that are connected, in maps where nearly every tet has a chart of its
// own.
#pragma once

#include <cstddef>

#include <adjacency/tet_topology.hpp>

#include <hexhex/types.hpp>

#include <igm/input.hpp>
#include <igm/transitions.hpp>
#include <lattice/gauge.hpp>

namespace hexhex {

/// Transitions along a spanning tree, composed: each tet's from its chart into the common chart.
/// Across the faces that are not in the tree, gauges need not agree.
struct Gauges {
  Array<Gauge> of;         ///< per tet; empty if there are none
  Array<Index> component;  ///< per tet: of the mesh, connected by faces
  Index components = 0;
};

/// Whether so many transitions are not the identity that tets with a common chart are not worth
/// looking for.
[[nodiscard]] inline bool areMostlyNonTrivial(const TetTopology& topology,
                                              const Transitions& transitions) noexcept {
  return transitions.nonTrivial > topology.tetCount();
}

/// Tets in a block: what they need, some 140 bytes each, is to stay in a cache of one or two MB.
/// Smaller blocks are faster, but cuts are as few as those of one search only inside of blocks.
inline constexpr std::size_t kGaugeBlock = std::size_t{1} << 14;

/// The tree is one of breadth first searches: within blocks of consecutive tets, in parallel, and
/// then from block to block. It does not depend on threads.
[[nodiscard]] Gauges computeGauges(const TetTopology& topology, const Transitions& transitions,
                                   Stage& stage, std::size_t blockSize = kGaugeBlock);

/// The same before transitions are known: those along the tree are fitted.
[[nodiscard]] Gauges computeGauges(const TetTopology& topology, const LocalParameters& parameters,
                                   Stage& stage, std::size_t blockSize = kGaugeBlock);

}  // namespace hexhex
