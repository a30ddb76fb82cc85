// Arcs of hex edges that an engine has followed from tet to tet.
#pragma once

#include <vector>

#include <curved/lattice_numbers.hpp>

#include <hexhex/curved.hpp>

#include <extract/edge_records.hpp>
#include <map/prepare.hpp>

namespace hexhex {

/// Computes the points where recorded edges cross faces, traces those anew that meet edges or
/// vertices of the tets or lie in faces, and brings them into canonical order: what traceArcs()
/// returns, bit for bit.
/// @param records  of all edges
/// @throws Error TooLarge for more edges than an Index can number
[[nodiscard]] Arcs gatherArcs(const PreparedMap& map, const LatticeNumbers& vertices,
                              std::vector<EdgeRecords> records, Stage& stage);

}  // namespace hexhex
