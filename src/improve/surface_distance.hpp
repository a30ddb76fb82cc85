// How far the boundary of a mesh is from a surface.
#pragma once

#include <span>
#include <vector>

#include <hexhex/improve.hpp>

#include <base/stage.hpp>
#include <improve/reference_surface.hpp>
#include <improve/triangle_tree.hpp>

namespace hexhex {

/// Of the bounding box.
[[nodiscard]] double diagonalOf(const ReferenceSurface& surface);

struct BoundaryDistance {
  SurfaceDistance largest;
  /// Per quad: the largest of its own samples, and of the surface's to which it is the nearest.
  std::vector<double> ofQuads;
  std::vector<double> fromQuads;  ///< per quad: the largest of its own samples alone

  /// Ascending.
  [[nodiscard]] std::vector<Index> quadsBeyond(double limit) const;
};

/// Quads are four triangles around their centres.
/// @param quads     of the mesh
/// @param tree      of the surface's triangles
/// @param diagonal  by which distances are divided
[[nodiscard]] BoundaryDistance distanceBetween(const Array<Vec3>& points,
                                               std::span<const Quad> quads,
                                               const ReferenceSurface& surface,
                                               const TriangleTree& tree, double diagonal,
                                               Stage& stage);

[[nodiscard]] TriangleTree treeOf(const ReferenceSurface& surface);

}  // namespace hexhex
