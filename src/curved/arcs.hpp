// Hex edges as polylines through the tets (Section 5.5).
#pragma once

#include <curved/element_numbers.hpp>
#include <curved/lattice_numbers.hpp>
#include <curved/owned_simplex.hpp>

#include <hexhex/curved.hpp>

namespace hexhex {

/// Traces every hex edge once. Generators are in terms of the tets in the map, not of the caller's.
[[nodiscard]] Arcs traceArcs(const PreparedMap& map, const LatticeNumbers& vertices,
                             const ElementNumbers& edges, Stage& stage);

}  // namespace hexhex
