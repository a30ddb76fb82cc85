// How far the boundary of a mesh is from that of the object, by points all over both of them: what
// judges distances that the library reports, so nothing here is the library's.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/improve.hpp>
#include <hexhex/types.hpp>

namespace hexhex::test {

/// In diagonals of the object's bounding box, unless noted otherwise; lower bounds of what all
/// points would give.
struct SampledDistance {
  double fromMesh = 0;    ///< largest of points on boundary quads, from the object's boundary
  double fromObject = 0;  ///< largest of points on its boundary, from the mesh's boundary
  [[nodiscard]] double largest() const { return std::max(fromMesh, fromObject); }
};

namespace sampled {

using Triangle = std::array<Vec3, 3>;

inline Vec3 blend(double s, const Vec3& a, double t, const Vec3& b) {
  return {s * a[0] + t * b[0], s * a[1] + t * b[1], s * a[2] + t * b[2]};
}
inline double product(const Vec3& a, const Vec3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline double distance(const Vec3& a, const Vec3& b) {
  const Vec3 d = blend(1, a, -1, b);
  return std::sqrt(product(d, d));
}

inline double toSegment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = blend(1, b, -1, a);
  const double square = product(ab, ab);
  const double t = square > 0 ? std::clamp(product(blend(1, p, -1, a), ab) / square, 0.0, 1.0) : 0;
  return distance(p, blend(1, a, t, ab));
}

/// By barycentric coordinates of the foot, or else by the sides.
inline double toTriangle(const Vec3& p, const Triangle& t) {
  const Vec3 u = blend(1, t[1], -1, t[0]);
  const Vec3 v = blend(1, t[2], -1, t[0]);
  const Vec3 w = blend(1, p, -1, t[0]);
  const double uu = product(u, u);
  const double uv = product(u, v);
  const double vv = product(v, v);
  const double det = uu * vv - uv * uv;
  if (det > 0) {
    const double b = (vv * product(w, u) - uv * product(w, v)) / det;
    const double c = (uu * product(w, v) - uv * product(w, u)) / det;
    if (b >= 0 && c >= 0 && b + c <= 1) return distance(p, blend(1, t[0], 1, blend(b, u, c, v)));
  }
  return std::min({toSegment(p, t[0], t[1]), toSegment(p, t[1], t[2]), toSegment(p, t[2], t[0])});
}

/// Triangles that a look at a sphere around each mostly spares.
class Surface {
 public:
  void add(const Triangle& triangle) {
    const Vec3 centre =
        blend(1, blend(1.0 / 3, triangle[0], 1.0 / 3, triangle[1]), 1.0 / 3, triangle[2]);
    double radius = 0;
    for (const Vec3& corner : triangle) radius = std::max(radius, distance(corner, centre));
    entries_.push_back({triangle, centre, radius});
  }
  [[nodiscard]] double from(const Vec3& point) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Entry& entry : entries_) {
      if (distance(point, entry.centre) - entry.radius >= least) continue;
      least = std::min(least, toTriangle(point, entry.triangle));
    }
    return least;
  }

 private:
  struct Entry {
    Triangle triangle;
    Vec3 centre;
    double radius;
  };
  std::vector<Entry> entries_;
};

/// The faces of one cell alone, as `faces` lists corners of a cell.
template <class Cells, std::size_t n, std::size_t faceCount>
std::vector<std::array<Index, n>> boundary(
    const Cells& cells, const std::array<std::array<std::size_t, n>, faceCount>& faces) {
  std::map<std::array<Index, n>, std::pair<int, std::array<Index, n>>> found;
  for (const auto& cell : cells) {
    for (const auto& corners : faces) {
      std::array<Index, n> face{};
      for (std::size_t k = 0; k < n; ++k) face[k] = cell[corners[k]];
      std::array<Index, n> key = face;
      std::sort(key.begin(), key.end());
      auto& [count, vertices] = found[key];
      ++count;
      vertices = face;
    }
  }
  std::vector<std::array<Index, n>> alone;
  for (const auto& [key, entry] : found) {
    if (entry.first == 1) alone.push_back(entry.second);
  }
  return alone;
}

/// As VTK_HEXAHEDRON numbers corners.
inline constexpr std::array<std::array<std::size_t, 4>, 6> kFacesOfHex = {
    {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};
inline constexpr std::array<std::array<std::size_t, 3>, 4> kFacesOfTet = {
    {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}}};

inline std::vector<Quad> boundaryOf(const HexMesh& mesh) {
  return boundary(mesh.cells, kFacesOfHex);
}
inline std::vector<std::array<Index, 3>> boundaryOf(const TetMap& map) {
  return boundary(map.tets, kFacesOfTet);
}

/// A point of a bilinear quad.
inline Vec3 pointOf(const std::array<Vec3, 4>& quad, double s, double t) {
  return blend(1 - t, blend(1 - s, quad[0], s, quad[1]), t, blend(1 - s, quad[3], s, quad[2]));
}
inline std::array<Vec3, 4> cornersOf(const HexMesh& mesh, const Quad& quad) {
  return {mesh.points[quad[0]], mesh.points[quad[1]], mesh.points[quad[2]], mesh.points[quad[3]]};
}

/// Quads as four triangles around their centres.
inline Surface surfaceOf(const HexMesh& mesh) {
  Surface surface;
  for (const Quad& quad : boundaryOf(mesh)) {
    const std::array<Vec3, 4> corners = cornersOf(mesh, quad);
    const Vec3 centre = pointOf(corners, 0.5, 0.5);
    for (std::size_t k = 0; k < 4; ++k) surface.add({corners[k], corners[(k + 1) % 4], centre});
  }
  return surface;
}

/// Largest distance of points on boundary quads from a surface.
/// @param steps  sides of quads are divided into so many
inline double farthest(const HexMesh& mesh, const Surface& surface, int steps) {
  double most = 0;
  for (const Quad& quad : boundaryOf(mesh)) {
    const std::array<Vec3, 4> corners = cornersOf(mesh, quad);
    for (int i = 0; i <= steps; ++i) {
      for (int j = 0; j <= steps; ++j) {
        most = std::max(most, surface.from(pointOf(corners, static_cast<double>(i) / steps,
                                                   static_cast<double>(j) / steps)));
      }
    }
  }
  return most;
}

}  // namespace sampled

/// Between the boundaries of two meshes, in the unit of their points.
inline SampledDistance sampledDistance(const HexMesh& mesh, const HexMesh& object, int steps) {
  return {sampled::farthest(mesh, sampled::surfaceOf(object), steps),
          sampled::farthest(object, sampled::surfaceOf(mesh), steps)};
}

/// The reported distance looks at the points of quads at four steps; at vertices and centres of
/// triangles, which are among those at six; and on their edges at points that are at most a quarter
/// of a quad's edge apart, which are added.
/// @param steps  sides of quads and triangles are divided into so many
inline SampledDistance sampledDistance(const HexMesh& mesh, const TetMap& map, int steps = 4) {
  using namespace sampled;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Vec3 low = {kInfinity, kInfinity, kInfinity};
  Vec3 high = {-kInfinity, -kInfinity, -kInfinity};
  Surface object;
  std::vector<Triangle> triangles;
  for (const auto& [a, b, c] : boundaryOf(map)) {
    triangles.push_back({map.points[a], map.points[b], map.points[c]});
    object.add(triangles.back());
    for (const Vec3& corner : triangles.back()) {
      for (std::size_t k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], corner[k]);
        high[k] = std::max(high[k], corner[k]);
      }
    }
  }
  SampledDistance found;
  found.fromMesh = farthest(mesh, object, steps);
  const Surface quads = surfaceOf(mesh);
  double quadEdges = 0;
  double quadEdgeCount = 0;
  for (const Quad& quad : boundaryOf(mesh)) {
    for (std::size_t k = 0; k < 4; ++k) {
      quadEdges += distance(mesh.points[quad[k]], mesh.points[quad[(k + 1) % 4]]);
      ++quadEdgeCount;
    }
  }
  for (const Triangle& t : triangles) {
    for (int i = 0; i <= steps; ++i) {
      for (int j = 0; i + j <= steps; ++j) {
        const double b = static_cast<double>(i) / steps;
        const double c = static_cast<double>(j) / steps;
        const Vec3 point = blend(1, blend(1 - b - c, t[0], b, t[1]), c, t[2]);
        found.fromObject = std::max(found.fromObject, quads.from(point));
      }
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& end = t[(k + 1) % 3];
      const double parts = std::ceil(4 * distance(t[k], end) * quadEdgeCount / quadEdges);
      for (double i = 1; i < parts; ++i) {
        const Vec3 point = blend(1 - i / parts, t[k], i / parts, end);
        found.fromObject = std::max(found.fromObject, quads.from(point));
      }
    }
  }
  const double diagonal = distance(low, high);
  return {found.fromMesh / diagonal, found.fromObject / diagonal};
}

/// Whether a reported distance is right, as far as it looks.
inline void expectSampled(const SurfaceDistance& reported, const HexMesh& mesh, const TetMap& map) {
  EXPECT_NEAR(reported.fromMesh, sampledDistance(mesh, map, 4).fromMesh, 1e-9);
  const double fromObject = sampledDistance(mesh, map, 6).fromObject;
  EXPECT_LE(reported.fromSurface, fromObject + 1e-9);
  EXPECT_GE(reported.fromSurface, 0.5 * fromObject - 1e-9);
}

}  // namespace hexhex::test
