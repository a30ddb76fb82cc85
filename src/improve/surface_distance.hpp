// Finds nearest triangles by a tree of bounding boxes, and the distance between the boundary of a
// mesh and a surface.
#pragma once

#include <array>
#include <limits>
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
  explicit TriangleTree(std::span<const std::array<Vec3, 3>> triangles)
      : TriangleTree(triangles.size(), [triangles](std::size_t t) { return triangles[t]; }) {}
  /// @param triangleOf  called with 0 to count - 1
  template <class TriangleOf>
  TriangleTree(std::size_t count, const TriangleOf& triangleOf) {
    triangles_.reserve(count);
    for (std::size_t t = 0; t < count; ++t) triangles_.push_back({triangleOf(t), t});
    build();
  }

  struct Nearest {
    double distance = 0;  ///< infinite without triangles
    std::size_t triangle = 0;
    std::size_t place = 0;  ///< of the triangle among the leaves
  };
  /// @param begin   a place: that of a point nearby makes it fast
  /// @param enough  any triangle nearer than this is taken
  [[nodiscard]] Nearest nearest(const Vec3& point, std::size_t begin = 0, double enough = 0) const;

 private:
  void build();
  void build(std::size_t node, std::size_t begin, std::size_t end);

  struct Triangle {
    std::array<Vec3, 3> corners;
    std::size_t number;
  };
  std::vector<Triangle> triangles_;  ///< in order of the leaves
  std::vector<Box> boxes_;           ///< of a complete binary tree: children 2 i + 1, 2 i + 2
};

/// The mean length of the edges of quads; 0 without any.
[[nodiscard]] double meanEdge(const Array<Vec3>& points, std::span<const Quad> quads);

/// The diagonal of the bounding box.
[[nodiscard]] double diagonalOf(const ReferenceSurface& surface);

/// The way between a point of a boundary quad and the surface.
struct Gap {
  Index quad = 0;
  std::array<double, 4> weights{};  ///< of the quad's corners, whose sum is the point
  Vec3 way{};                       ///< from the point to the surface
};

struct BoundaryDistance {
  SurfaceDistance largest;
  /// Per quad: the largest distance of its own samples, and of samples of the surface for which it
  /// is the nearest quad.
  std::vector<double> ofQuads;
  std::vector<Gap> gaps;  ///< of samples in both directions: those requested

  /// Ascending.
  [[nodiscard]] std::vector<Index> quadsBeyond(double limit) const;
};

/// What is requested, in diagonals.
struct Accuracy {
  /// Distances below this may be any below it.
  double enough = 0;
  /// Longer gaps are collected.
  double gapsFrom = std::numeric_limits<double>::infinity();
};

/// The distance between the boundaries of a mesh and of a surface, in both directions. From the
/// surface, each quad counts as four triangles around its centre.
/// @param quads     of the boundary of the mesh
/// @param tree      of the surface's boundary
/// @param diagonal  by which distances are divided
[[nodiscard]] BoundaryDistance distanceBetween(const Array<Vec3>& points,
                                               std::span<const Quad> quads,
                                               const ReferenceSurface& surface,
                                               const TriangleTree& tree, double diagonal,
                                               Stage& stage, const Accuracy& accuracy = {});

/// A tree of the boundary triangles of a surface.
[[nodiscard]] TriangleTree treeOf(const ReferenceSurface& surface);

/// The largest distance of inner quads from inner triangles of the surface, in diagonals; 0 without
/// any of either. Not measured in the other direction: triangles that are not aligned with the map
/// have no quads.
[[nodiscard]] double innerDistance(const Array<Vec3>& points, std::span<const Quad> quads,
                                   const ReferenceSurface& surface, double diagonal, Stage& stage);

}  // namespace hexhex::improvement
