// The nearest triangle to a point, by a tree of boxes.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <hexhex/types.hpp>

namespace hexhex {

class TriangleTree {
 public:
  explicit TriangleTree(std::vector<std::array<Vec3, 3>> triangles);

  /// @return the distance to the nearest triangle; infinity without triangles
  [[nodiscard]] double distanceTo(const Vec3& point) const;

 private:
  struct Box {
    Vec3 low;
    Vec3 high;
    [[nodiscard]] double squaredDistance(const Vec3& point) const noexcept;
  };
  void build(std::size_t node, std::size_t begin, std::size_t end);

  std::vector<std::array<Vec3, 3>> triangles_;  ///< in order of the leaves
  std::vector<Box> boxes_;  ///< of a complete binary tree: children 2 i + 1, 2 i + 2
};

}  // namespace hexhex
