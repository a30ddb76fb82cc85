// Hex cells: the eight corners of each, collected by walking from propeller to opposite
// (Section 5.4, end).
#pragma once

#include <cstdint>

#include <hexhex/types.hpp>

#include <propeller/global_connectivity.hpp>

namespace hexhex::propeller {

/// Number of cells that the hex corners of all vertices make up.
[[nodiscard]] std::uint64_t countCells(const HexVertices& vertices, const LocalConnectivity& local);

/// All cells in canonical order (cell_centers.hpp). Each is entered from its centre at its first
/// corner; from there the walk goes from propeller to opposite.
[[nodiscard]] Array<Hex> collectCells(const igm::PreparedMap& map,
                                      const Array<lattice::NormalSigns>& signs,
                                      const HexVertices& vertices, const LocalConnectivity& local,
                                      const GlobalConnectivity& global, Stage& stage);

}  // namespace hexhex::propeller
