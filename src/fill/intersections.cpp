// If two triangles meet outside common vertices and edges, an edge of one meets the other there. So
// for all pairs whose boxes overlap, found by a box tree, each edge is tested against the other
// triangle.
#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <optional>
#include <vector>

#include <fill/exact_signs.hpp>
#include <fill/intersections.hpp>

#include <base/box.hpp>
#include <base/parallel.hpp>
#include <base/vector3.hpp>

namespace hexhex::fill {
namespace {

using Corners = std::array<Index, 3>;

bool meet(const Box& a, const Box& b) noexcept {
  for (std::size_t k = 0; k < 3; ++k) {
    if (a.low[k] > b.high[k] || b.low[k] > a.high[k]) return false;
  }
  return true;
}

/// A hierarchy of bounding boxes, by recursive bisection of the triangles.
class BoxTree {
 public:
  explicit BoxTree(const TriangleMesh& surface) : order_(surface.triangles.size()) {
    std::iota(order_.begin(), order_.end(), Index{0});
    boxes_.reserve(order_.size());
    for (const Corners& t : surface.triangles) {
      Box& box = boxes_.emplace_back();
      for (const Index v : t) box.add(surface.points[v]);
    }
    std::size_t nodes = 1;
    for (std::size_t leaves = 1; leaves * kLeaf < order_.size(); leaves *= 2) nodes += 2 * leaves;
    nodes_.resize(nodes);
    build(0, 0, order_.size());
  }

  [[nodiscard]] const Box& box(Index triangle) const { return boxes_[triangle]; }

  /// Calls visit(t) for all triangles whose boxes overlap a box.
  template <class Visit>
  void forEachAt(const Box& box, const Visit& visit) const {
    forEachAt(box, visit, 0, 0, order_.size());
  }

 private:
  static constexpr std::size_t kLeaf = 4;

  void build(std::size_t node, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      nodes_[node].add(boxes_[order_[i]].low);
      nodes_[node].add(boxes_[order_[i]].high);
    }
    if (2 * node + 2 >= nodes_.size()) return;
    const std::size_t axis = dominantAxis(minus(nodes_[node].high, nodes_[node].low));
    const std::size_t middle = begin + (end - begin) / 2;
    const auto at = [this](std::size_t i) {
      return order_.begin() + static_cast<std::ptrdiff_t>(i);
    };
    std::nth_element(at(begin), at(middle), at(end), [&](Index s, Index t) {
      const double left = boxes_[s].low[axis] + boxes_[s].high[axis];
      const double right = boxes_[t].low[axis] + boxes_[t].high[axis];
      return left == right ? s < t : left < right;
    });
    build(2 * node + 1, begin, middle);
    build(2 * node + 2, middle, end);
  }

  template <class Visit>
  void forEachAt(const Box& box, const Visit& visit, std::size_t node, std::size_t begin,
                 std::size_t end) const {
    if (!meet(box, nodes_[node])) return;
    if (2 * node + 2 >= nodes_.size()) {
      for (std::size_t i = begin; i < end; ++i) {
        if (meet(box, boxes_[order_[i]])) visit(order_[i]);
      }
      return;
    }
    const std::size_t middle = begin + (end - begin) / 2;
    forEachAt(box, visit, 2 * node + 1, begin, middle);
    forEachAt(box, visit, 2 * node + 2, middle, end);
  }

  std::vector<Index> order_;
  std::vector<Box> boxes_;  ///< per triangle
  std::vector<Box> nodes_;
};

/// An axis along which the projection of a nondegenerate triangle has an area.
std::size_t openAxis(const std::array<Vec3, 3>& t) {
  const std::size_t first =
      dominantAxis(cross(minus(t[1], t[0]), minus(t[2], t[0])));  // a guess, mostly right
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t axis = (first + k) % 3;
    if (orientation(t[0], t[1], t[2], axis) != 0) return axis;
  }
  return 3;
}

class EdgeAndTriangle {
 public:
  EdgeAndTriangle(const TriangleMesh& surface, const Corners& triangle)
      : points_(surface.points), triangle_(triangle) {
    for (std::size_t i = 0; i < 3; ++i) t_[i] = points_[triangle[i]];
  }

  /// Whether the triangle and an edge have a common point other than a common vertex or edge.
  [[nodiscard]] bool meet(Index from, Index to) const {
    const std::size_t begin = cornerOf(from);
    const std::size_t end = cornerOf(to);
    if (begin < 3 && end < 3) return false;
    const Vec3& p = points_[from];
    const Vec3& q = points_[to];
    const int sideP = begin < 3 ? 0 : orientation(t_[0], t_[1], t_[2], p);
    const int sideQ = end < 3 ? 0 : orientation(t_[0], t_[1], t_[2], q);
    if (sideP * sideQ > 0) return false;
    if (sideP == 0 && sideQ == 0) {
      if (begin < 3) return leavesInto(begin, q);
      if (end < 3) return leavesInto(end, p);
      return meetInPlane(p, q);
    }
    if (begin < 3 || end < 3) return false;  // only in that vertex
    std::array<int, 3> turns{};
    for (std::size_t i = 0; i < 3; ++i) turns[i] = orientation(p, q, t_[i], t_[(i + 1) % 3]);
    const auto [least, most] = std::minmax_element(turns.begin(), turns.end());
    return *least >= 0 || *most <= 0;
  }

 private:
  /// The corner that is this vertex; 3 if there is none.
  [[nodiscard]] std::size_t cornerOf(Index vertex) const {
    return static_cast<std::size_t>(std::find(triangle_.begin(), triangle_.end(), vertex) -
                                    triangle_.begin());
  }

  /// Whether the segment from a corner to a point of the plane starts inside the triangle.
  [[nodiscard]] bool leavesInto(std::size_t corner, const Vec3& point) const {
    const std::size_t axis = openAxis(t_);
    const Vec3& a = t_[corner];
    const Vec3& b = t_[(corner + 1) % 3];
    const Vec3& c = t_[(corner + 2) % 3];
    const int turn = orientation(a, b, c, axis);
    return turn * orientation(a, b, point, axis) >= 0 && turn * orientation(c, a, point, axis) >= 0;
  }

  /// The coplanar case: convex sets in a plane are disjoint if a side of one separates them.
  [[nodiscard]] bool meetInPlane(const Vec3& p, const Vec3& q) const {
    const std::size_t axis = openAxis(t_);
    const int turn = orientation(t_[0], t_[1], t_[2], axis);
    std::array<int, 3> sides{};
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3& a = t_[i];
      const Vec3& b = t_[(i + 1) % 3];
      if (turn * orientation(a, b, p, axis) < 0 && turn * orientation(a, b, q, axis) < 0) {
        return false;
      }
      sides[i] = orientation(p, q, a, axis);
    }
    const auto [least, most] = std::minmax_element(sides.begin(), sides.end());
    return *least <= 0 && *most >= 0;
  }

  const std::vector<Vec3>& points_;
  Corners triangle_;
  std::array<Vec3, 3> t_{};
};

bool edgesMeet(const TriangleMesh& surface, const Corners& edges, const Corners& triangle) {
  const EdgeAndTriangle pair(surface, triangle);
  for (std::size_t i = 0; i < 3; ++i) {
    if (pair.meet(edges[i], edges[(i + 1) % 3])) return true;
  }
  return false;
}

/// The first triangle after t that intersects it, or kNone.
Index firstMetBy(Index t, const TriangleMesh& surface, const BoxTree& tree) {
  Index first = kNone;
  tree.forEachAt(tree.box(t), [&](Index other) {
    if (other <= t || other >= first) return;
    const Corners& a = surface.triangles[t];
    const Corners& b = surface.triangles[other];
    if (edgesMeet(surface, a, b) || edgesMeet(surface, b, a)) first = other;
  });
  return first;
}

}  // namespace

bool isFlat(const std::array<Vec3, 3>& triangle) { return openAxis(triangle) == 3; }

std::optional<std::array<Index, 2>> firstIntersection(const TriangleMesh& surface, Stage& stage) {
  constexpr std::size_t kGrain = 256;  // takes a few hundred microseconds
  const BoxTree tree(surface);
  const std::size_t first = firstFault(
      stage, surface.triangles.size(),
      [&](std::size_t t) { return firstMetBy(static_cast<Index>(t), surface, tree) == kNone; },
      kGrain);
  if (first == surface.triangles.size()) return {};
  const auto t = static_cast<Index>(first);
  return std::array{t, firstMetBy(t, surface, tree)};
}

}  // namespace hexhex::fill
