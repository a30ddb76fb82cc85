#include <algorithm>
#include <cmath>
#include <limits>

#include <base/vector3.hpp>
#include <improve/reference_surface.hpp>
#include <improve/triangle_tree.hpp>

namespace hexhex::improvement {

namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();
/// Triangles in a leaf.
constexpr std::size_t kLeaf = 4;

}  // namespace

double TriangleTree::Box::squaredDistance(const Vec3& point) const noexcept {
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double d = std::max({low[k] - point[k], point[k] - high[k], 0.0});
    sum += d * d;
  }
  return sum;
}

TriangleTree::TriangleTree(std::span<const std::array<Vec3, 3>> triangles) {
  triangles_.reserve(triangles.size());
  for (const std::array<Vec3, 3>& corners : triangles) {
    triangles_.push_back({corners, triangles_.size()});
  }
  std::size_t nodes = 1;
  for (std::size_t leaves = 1; leaves * kLeaf < triangles_.size(); leaves *= 2) nodes += 2 * leaves;
  boxes_.resize(nodes);
  build(0, 0, triangles_.size());
}

void TriangleTree::build(std::size_t node, std::size_t begin, std::size_t end) {
  Box box{{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
  for (std::size_t t = begin; t < end; ++t) {
    for (const Vec3& corner : triangles_[t].corners) {
      for (std::size_t k = 0; k < 3; ++k) {
        box.low[k] = std::min(box.low[k], corner[k]);
        box.high[k] = std::max(box.high[k], corner[k]);
      }
    }
  }
  boxes_[node] = box;
  if (2 * node + 2 >= boxes_.size()) return;
  const std::size_t axis = dominantAxis(minus(box.high, box.low));
  const std::size_t middle = begin + (end - begin) / 2;
  const auto at = [this](std::size_t i) {
    return triangles_.begin() + static_cast<std::ptrdiff_t>(i);
  };
  std::nth_element(at(begin), at(middle), at(end), [axis](const Triangle& s, const Triangle& t) {
    const auto& [a, b] = std::pair(s.corners, t.corners);
    return a[0][axis] + a[1][axis] + a[2][axis] < b[0][axis] + b[1][axis] + b[2][axis];
  });
  build(2 * node + 1, begin, middle);
  build(2 * node + 2, middle, end);
}

TriangleTree::Nearest TriangleTree::nearest(const Vec3& point) const {
  struct Range {
    std::size_t node;
    std::size_t begin;
    std::size_t end;
    double squared;
  };
  double best = kFar;
  std::size_t triangle = 0;
  std::vector<Range> open = {{0, 0, triangles_.size(), boxes_[0].squaredDistance(point)}};
  while (!open.empty()) {
    const Range range = open.back();
    open.pop_back();
    if (range.squared >= best) continue;
    if (2 * range.node + 2 >= boxes_.size()) {
      for (std::size_t t = range.begin; t < range.end; ++t) {
        const Vec3 d = minus(nearestOf(triangles_[t].corners, point), point);
        if (dot(d, d) >= best) continue;
        best = dot(d, d);
        triangle = triangles_[t].number;
      }
      continue;
    }
    const std::size_t middle = range.begin + (range.end - range.begin) / 2;
    const std::size_t child = 2 * range.node + 1;
    Range low{child, range.begin, middle, boxes_[child].squaredDistance(point)};
    Range high{child + 1, middle, range.end, boxes_[child + 1].squaredDistance(point)};
    if (low.squared < high.squared) std::swap(low, high);
    open.push_back(low);
    open.push_back(high);
  }
  return {std::sqrt(best), triangle};
}

}  // namespace hexhex::improvement
