// Common charts for the tets of maps in which many tets have charts of their own.
#pragma once

#include <cstdint>

#include <adjacency/tet_topology.hpp>

#include <hexhex/types.hpp>

#include <igm/input.hpp>
#include <igm/transitions.hpp>
#include <lattice/gauge.hpp>

namespace hexhex {

/// How the charts of tets differ from those that the caller gave (and LocalParameters moved).
class Unfolding {
 public:
  /// No chart differs.
  Unfolding() = default;
  /// @param gauges  per tet: from the given chart into the one that is used
  explicit Unfolding(Array<Gauge> gauges) noexcept : gauges_(std::move(gauges)) {}

  /// How many inner faces have another transition than the identity, between given charts.
  [[nodiscard]] std::uint64_t countGivenJumps(const TetTopology& topology,
                                              const Transitions& transitions, Stage& stage) const;

 private:
  Array<Gauge> gauges_;  ///< empty if all are identities
};

/// Whether, by a sample, so many triangles have exact transitions that are not identities that
/// unfolding is worth its time. Not for maps that come with rotations, which are between given
/// charts.
[[nodiscard]] bool needsUnfolding(const TetTopology& topology, const OrientedMap& map);

/// Rewrites the parameters of a map in charts that extend along a tree of tets. All stages behind
/// then have as little to do as if the map had been given that way: transitions, cuts and closer
/// looks at vertices are for few triangles instead of all. Rotations change nothing but the order
/// and the signs of coordinates, and where a sum would be rounded, a tet keeps its chart; so it is
/// the same map to the last bit.
[[nodiscard]] Unfolding unfoldCharts(const TetTopology& topology, OrientedMap& map, Stage& stage);

}  // namespace hexhex
