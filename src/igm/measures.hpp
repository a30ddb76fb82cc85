// Exact measures of a map. The mesh that it implies must have as many cells, quads and edges (not
// in the paper).
#pragma once

#include <cstdint>
#include <vector>

#include <hexhex/check.hpp>

#include <igm/igm.hpp>
#include <igm/regular_vertices.hpp>

namespace hexhex::igm {

/// ExactMap::sixfoldVolume of a map without defects, before scaling.
/// @param regular  knows the boundary, and where tets differ
[[nodiscard]] lattice::Int192 sixfoldVolume(const RegularVertices& regular, const ExactMap& map,
                                            Stage& stage);

/// Parametric volume in unit cubes before scaling: the number of cells of the mesh at scale 1.
/// @throws Error Internal if it is not an integer, which a valid map excludes
[[nodiscard]] std::uint64_t parametricVolume(const ExactMap& map);

/// Parametric area of the boundary in unit squares.
[[nodiscard]] std::uint64_t boundaryArea(const adjacency::TetTopology& topology,
                                         const ExactMap& map);

/// Parametric length of a singular edge in unit lengths times map.unit.
[[nodiscard]] std::int64_t latticeLength(const SingularEdge& edge, const ExactMap& map);

/// The number of cells at a scale.
/// @param volume  at scale 1
/// @throws Error TooLarge for `limit` or more
[[nodiscard]] std::uint64_t scaledCells(std::uint64_t volume, int scale,
                                        double limit = kMaxCountedCells);

/// Number of connected components of the tet mesh (through faces).
[[nodiscard]] std::uint64_t componentCount(const adjacency::TetTopology& topology);

/// The genus of each boundary component, in descending order.
[[nodiscard]] std::vector<std::int64_t> boundaryGenus(const adjacency::TetTopology& topology);

/// Everything that a valid map implies about its mesh.
/// @param edges  of its tets
/// @param scale  of the mesh; a multiple of that of `map`
/// @throws Error TooLarge for kMaxCountedCells
[[nodiscard]] Expectation computeExpectation(const PreparedMap& map, std::uint64_t edges,
                                             int scale);

}  // namespace hexhex::igm
