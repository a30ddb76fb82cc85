// Hex edges as polylines through the tets (Section 5.5).
#pragma once

#include <hexhex/curved.hpp>

#include <curved/element_numbers.hpp>
#include <curved/lattice_numbers.hpp>

namespace hexhex {

/// Traces every hex edge once. Generators are in terms of the tets in `map`, not of the caller's.
[[nodiscard]] Arcs traceArcs(const PreparedMap& map, const LatticeNumbers& vertices,
                             const ElementNumbers& edges, Stage& stage);

}  // namespace hexhex
