// A surface that a mesh did not come from: which of its places the vertices of the mesh belong to.
#pragma once

#include <cstdint>
#include <span>

#include <hexhex/fill.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <improve/vertex_places.hpp>

namespace hexhex::improvement {

/// A vertex of the mesh's boundary belongs to the nearest triangle. One that is on a curve of the
/// mesh itself belongs to the nearest curve within half an edge, and one at a corner of it to the
/// nearest such corner, which takes one vertex only. Those of tagged quads inside stay.
/// @param surface         at finite positions
/// @param isAtBad, angle  as of placesOnMesh()
/// @throws Error InvalidArgument for triangles of vertices that do not exist, and if more than a
///         tenth of the boundary's vertices are farther from the surface than edges there are long;
///         EmptyMesh without triangles
[[nodiscard]] VertexPlaces placesOnSurface(const HexMesh& mesh, const TriangleMesh& surface,
                                           std::span<const std::uint8_t> isAtBad, double angle,
                                           Stage& stage);

}  // namespace hexhex::improvement
