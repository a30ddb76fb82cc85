// The nearest triangle to a point, by a tree of boxes.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <hexhex/improve.hpp>
#include <hexhex/types.hpp>

#include <base/box.hpp>
#include <base/stage.hpp>
#include <improve/reference_surface.hpp>

namespace hexhex::improvement {

class TriangleTree {
 public:
  explicit TriangleTree(std::span<const std::array<Vec3, 3>> triangles);

  struct Nearest {
    double distance = 0;  ///< infinity without triangles
    std::size_t triangle = 0;
  };
  [[nodiscard]] Nearest nearest(const Vec3& point) const;

 private:
  void build(std::size_t node, std::size_t begin, std::size_t end);

  struct Triangle {
    std::array<Vec3, 3> corners;
    std::size_t number;
  };
  std::vector<Triangle> triangles_;  ///< in order of the leaves
  std::vector<Box> boxes_;           ///< of a complete binary tree: children 2 i + 1, 2 i + 2
};

// How far the boundary of a mesh is from a surface.

/// Of the bounding box.
[[nodiscard]] double diagonalOf(const ReferenceSurface& surface);

struct BoundaryDistance {
  SurfaceDistance largest;
  /// Per quad: the largest of its own samples, and of the surface's to which it is the nearest.
  std::vector<double> ofQuads;

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
