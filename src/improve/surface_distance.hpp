// How far the boundary of a mesh is from a surface.
#pragma once

#include <span>

#include <hexhex/improve.hpp>

#include <base/stage.hpp>
#include <improve/reference_surface.hpp>
#include <improve/triangle_tree.hpp>

namespace hexhex {

/// Of the bounding box.
[[nodiscard]] double diagonalOf(const ReferenceSurface& surface);

/// Quads are four triangles around their centres.
/// @param quads     of the mesh
/// @param tree      of the surface's triangles
/// @param diagonal  by which distances are divided
[[nodiscard]] SurfaceDistance distanceBetween(const Array<Vec3>& points,
                                              std::span<const Quad> quads,
                                              const ReferenceSurface& surface,
                                              const TriangleTree& tree, double diagonal,
                                              Stage& stage);

[[nodiscard]] TriangleTree treeOf(const ReferenceSurface& surface);

}  // namespace hexhex
