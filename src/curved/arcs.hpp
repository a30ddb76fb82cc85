// Hex edges as polylines through the tets (Section 5.5).
#pragma once

#include <cstdint>

#include <hexhex/curved.hpp>

#include <curved/element_numbers.hpp>
#include <curved/lattice_numbers.hpp>
#include <curved/owned_simplex.hpp>

namespace hexhex {

/// To look along the axes of a tet is worth it for so many edges.
inline constexpr std::uint64_t kEnoughEdges = 4;

/// Traces every hex edge once. Generators are in terms of the tets in the map, not of the caller's.
/// @param enough  of the edges that fewer belong to the same tet, exact arithmetic finds the exits;
///                the result is the same up to rounding
[[nodiscard]] Arcs traceArcs(const PreparedMap& map, const LatticeNumbers& vertices,
                             const ElementNumbers& edges, Stage& stage,
                             std::uint64_t enough = kEnoughEdges);

}  // namespace hexhex
