// The nearest triangle to a point, by a tree of boxes.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <hexhex/types.hpp>

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
  struct Box {
    Vec3 low;
    Vec3 high;
    [[nodiscard]] double squaredDistance(const Vec3& point) const noexcept;
  };
  void build(std::size_t node, std::size_t begin, std::size_t end);

  struct Triangle {
    std::array<Vec3, 3> corners;
    std::size_t number;
  };
  std::vector<Triangle> triangles_;  ///< in order of the leaves
  std::vector<Box> boxes_;           ///< of a complete binary tree: children 2 i + 1, 2 i + 2
};

}  // namespace hexhex::improvement
