// Hex faces as planar polygons, tet by tet (Section 5.5).
#pragma once

#include <cstdint>
#include <span>

#include <hexhex/curved.hpp>

#include <curved/element_numbers.hpp>
#include <curved/lattice_numbers.hpp>
#include <curved/owned_simplex.hpp>

namespace hexhex {

/// What patches are made from.
struct PatchInput {
  const PreparedMap& map;
  const LatticeNumbers& vertices;
  const ElementNumbers& edges;
  const ElementNumbers& faces;
  const Arcs& arcs;              ///< of the edges
  std::span<const Index> arcOf;  ///< per edge; empty if arcs come in the order of edges

  [[nodiscard]] Index arc(Index edge) const noexcept { return arcOf.empty() ? edge : arcOf[edge]; }

  /// In the numbering that polygons use, behind hex vertices and points of arcs.
  [[nodiscard]] std::uint64_t firstInnerPoint() const noexcept {
    return vertices.count() + arcs.points.size();
  }
};

/// Cuts every hex face once. Generators are in terms of the tets in the map, not of the caller's.
/// @throws Error TooLarge for more points than an Index can number
[[nodiscard]] Patches cutPatches(const PatchInput& input, Stage& stage);

}  // namespace hexhex
