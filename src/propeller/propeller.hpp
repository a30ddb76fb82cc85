// The propeller engine, which is the paper's: its stages behind preprocessing, in a row, and the
// last of them: the eight corners of each cell, collected by walking from propeller to opposite
// (Section 5.4, end).
#pragma once

#include <cstdint>

#include <hexhex/context.hpp>
#include <hexhex/extract.hpp>
#include <hexhex/types.hpp>

#include <igm/prepare.hpp>
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

/// Extracts the mesh of a map that has passed all checks and is scaled.
/// @param expectedCells  the map's parametric volume
/// @param epsilon        as in ExtractOptions
/// @param[in,out] statistics  receives what the stages count
[[nodiscard]] HexMesh runPipeline(const igm::PreparedMap& map, std::uint64_t expectedCells,
                                  double epsilon, Context& context, ExtractStatistics& statistics);

}  // namespace hexhex::propeller
