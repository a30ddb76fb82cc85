// Hex faces as planar polygons, tet by tet (Section 5.5).
#pragma once

#include <cstdint>

#include <hexhex/curved.hpp>

#include <curved/element_numbers.hpp>
#include <curved/owned_simplex.hpp>
#include <sweep/vertex_tables.hpp>

namespace hexhex {

/// What patches are made from.
struct PatchInput {
  const PreparedMap& map;
  const VertexTables& vertices;
  const ElementNumbers& edges;
  const ElementNumbers& faces;
  const Arcs& arcs;  ///< of the edges

  /// In the numbering that polygons use, behind hex vertices and points of arcs.
  [[nodiscard]] std::uint64_t firstInnerPoint() const noexcept {
    return vertices.count() + arcs.points.size();
  }
};

/// Cuts every hex face once. Generators are in terms of the tets in the map, not of the caller's.
/// @throws Error TooLarge for more points than an Index can number
[[nodiscard]] Patches cutPatches(const PatchInput& input, Stage& stage);

}  // namespace hexhex
