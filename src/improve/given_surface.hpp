// Assigns the vertices of a mesh to places on a surface from which it was not made.
#pragma once

#include <cstdint>
#include <span>

#include <hexhex/fill.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <improve/vertex_places.hpp>

namespace hexhex::improvement {

/// Boundary vertices belong to the nearest triangle; those on curves or at corners of the mesh
/// itself, to the nearest curve of the surface within half an edge length. Each corner of the
/// surface takes the nearest of the latter vertices within the same distance. Vertices of tagged
/// quads inside are fixed.
/// @param surface         at finite positions
/// @param isAtBad, angle  as for placesOnMesh()
/// @throws Error InvalidArgument for triangles with vertices that do not exist, and if more than a
///         tenth of the boundary vertices are farther from the surface than their edges are long;
///         EmptyMesh without triangles
[[nodiscard]] VertexPlaces placesOnSurface(const HexMesh& mesh, const TriangleMesh& surface,
                                           std::span<const std::uint8_t> isAtBad, double angle,
                                           Stage& stage);

}  // namespace hexhex::improvement
