// What the readers of surface files share. Polygons are triangulated by cutting off ears:
// Meisters, "Polygons have ears", The American Mathematical Monthly 82 (1975).
#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

#include <hexhex/error.hpp>

#include <base/vector3.hpp>
#include <io/formats/formats.hpp>

namespace hexhex::io {
namespace {

/// A polygon that is cut until a triangle is left, seen along its mean normal.
class Ears {
 public:
  Ears(const TriangleMesh& mesh, std::span<const Index> corners)
      : points_(mesh.points), corners_(corners.begin(), corners.end()) {
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      normal_ = plus(normal_, cross(at(i), at(i + 1)));
    }
  }

  [[nodiscard]] std::size_t size() const { return corners_.size(); }
  [[nodiscard]] bool isConvex() const {
    for (std::size_t i = 0; i < size(); ++i) {
      if (turn(at(i), at(i + 1), at(i + 2)) < 0) return false;
    }
    return true;
  }
  /// Cuts off the first ear; any corner if there is none, as in polygons that cross themselves.
  std::array<Index, 3> cut() {
    std::size_t i = 0;
    while (i < size() && !isEar(i)) ++i;
    i %= size();
    const std::size_t middle = (i + 1) % size();
    const std::array<Index, 3> ear = {corners_[i], corners_[middle], corners_[(i + 2) % size()]};
    corners_.erase(corners_.begin() + static_cast<std::ptrdiff_t>(middle));
    return ear;
  }

 private:
  /// From the first corner, so that far polygons keep their digits.
  [[nodiscard]] Vec3 at(std::size_t i) const {
    return minus(points_[corners_[i % size()]], points_[corners_[0]]);
  }
  /// Positive if the way a-b-c turns left.
  [[nodiscard]] double turn(const Vec3& a, const Vec3& b, const Vec3& c) const {
    return dot(cross(minus(b, a), minus(c, b)), normal_);
  }
  [[nodiscard]] bool isEar(std::size_t i) const {
    const Vec3 a = at(i);
    const Vec3 b = at(i + 1);
    const Vec3 c = at(i + 2);
    if (!(turn(a, b, c) > 0)) return false;
    for (std::size_t k = i + 3; k < i + size(); ++k) {
      const Vec3 p = at(k);
      if (p == a || p == b || p == c) continue;  // where a bridge leads to a hole
      if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
    }
    return true;
  }

  const std::vector<Vec3>& points_;
  std::vector<Index> corners_;
  Vec3 normal_{};
};

}  // namespace

void addPolygon(TriangleMesh& mesh, std::span<const Index> corners) {
  if (corners.size() > 3) {
    Ears ears(mesh, corners);
    if (!ears.isConvex()) {
      while (ears.size() > 2) mesh.triangles.push_back(ears.cut());
      return;
    }
  }
  for (std::size_t i = 2; i < corners.size(); ++i) {
    mesh.triangles.push_back({corners[0], corners[i - 1], corners[i]});
  }
}

TriangleMesh welded(const TriangleMesh& mesh) {
  if (mesh.points.size() >= kNone) {
    throw Error(ErrorCode::TooLarge, "The surface has more vertices than can be numbered.");
  }
  std::vector<Index> order(mesh.points.size());
  std::iota(order.begin(), order.end(), Index{0});
  // Equal points are represented by the first of them.
  std::sort(order.begin(), order.end(), [&](Index a, Index b) {
    const Vec3& p = mesh.points[a];
    const Vec3& q = mesh.points[b];
    return p == q ? a < b : p < q;
  });
  std::vector<Index> first(mesh.points.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool isNew = i == 0 || mesh.points[order[i]] != mesh.points[order[i - 1]];
    first[order[i]] = isNew ? order[i] : first[order[i - 1]];
  }
  TriangleMesh result;
  std::vector<Index> vertices(mesh.points.size());
  for (Index v = 0; v < mesh.points.size(); ++v) {
    if (first[v] == v) {
      vertices[v] = static_cast<Index>(result.points.size());
      result.points.push_back(mesh.points[v]);
    } else {
      vertices[v] = vertices[first[v]];
    }
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::array<Index, 3> t = {vertices[a], vertices[b], vertices[c]};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) result.triangles.push_back(t);
  }
  return result;
}

}  // namespace hexhex::io
