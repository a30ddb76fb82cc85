// Hex edges as polylines through the tets (Section 5.5).
#pragma once

#include <curved/element_numbers.hpp>
#include <curved/lattice_numbers.hpp>
#include <curved/owned_simplex.hpp>

#include <hexhex/curved.hpp>

namespace hexhex {

struct TracedArcs {
  Arcs arcs;  ///< generators in terms of the tets in the map, not of the caller's
  Array<SimplexVertices> crossings;  ///< per inner point: its generator's vertices
};

/// Traces every hex edge once.
[[nodiscard]] TracedArcs traceArcs(const PreparedMap& map, const LatticeNumbers& vertices,
                                   const ElementNumbers& edges, Stage& stage);

}  // namespace hexhex
