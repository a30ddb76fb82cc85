// How far the boundary of a mesh is from a surface.
#pragma once

#include <span>
#include <vector>

#include <hexhex/improve.hpp>

#include <base/stage.hpp>
#include <improve/reference_surface.hpp>
#include <improve/triangle_tree.hpp>

namespace hexhex::improvement {

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

/// Between two boundaries, whatever is inside. Quads are four triangles around their centres.
/// @param quads     of the boundary of the mesh
/// @param tree      of the surface's boundary
/// @param diagonal  by which distances are divided
[[nodiscard]] BoundaryDistance distanceBetween(const Array<Vec3>& points,
                                               std::span<const Quad> quads,
                                               const ReferenceSurface& surface,
                                               const TriangleTree& tree, double diagonal,
                                               Stage& stage);

/// Of its boundary.
[[nodiscard]] TriangleTree treeOf(const ReferenceSurface& surface);

/// The largest distance of quads inside from the surface's triangles inside, in diagonals; 0 if
/// there are none of either. Not the other way: triangles that are not aligned with the map have no
/// quads.
[[nodiscard]] double innerDistance(const Array<Vec3>& points, std::span<const Quad> quads,
                                   const ReferenceSurface& surface, double diagonal, Stage& stage);

}  // namespace hexhex::improvement
