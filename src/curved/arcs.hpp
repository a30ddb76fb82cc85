// Hex edges as polylines through the tets (Section 5.5).
#pragma once

#include <hexhex/curved.hpp>

#include <curved/element_numbers.hpp>
#include <sweep/vertex_tables.hpp>

namespace hexhex {

/// Traces every hex edge once. Generators are in terms of the tets in the map, not of the caller's.
[[nodiscard]] Arcs traceArcs(const PreparedMap& map, const VertexTables& vertices,
                             const ElementNumbers& edges, Stage& stage);

}  // namespace hexhex
