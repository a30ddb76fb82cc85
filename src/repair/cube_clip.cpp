#include <algorithm>
#include <cmath>
#include <utility>

#include <base/vector3.hpp>
#include <lattice/tet_geometry.hpp>
#include <repair/cube_clip.hpp>

namespace hexhex {

namespace {

using Polygon = std::vector<Vec3>;

/// Keeps the side of a plane across an axis on which (x - level) * sign >= 0.
/// (Sutherland and Hodgman, "Reentrant polygon clipping", 1974)
void clip(Polygon& polygon, std::size_t axis, double level, double sign) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3& a = polygon[i];
    const Vec3& b = polygon[(i + 1) % polygon.size()];
    const double da = (a[axis] - level) * sign;
    const double db = (b[axis] - level) * sign;
    if (da >= 0) kept.push_back(a);
    if ((da > 0 && db < 0) || (da < 0 && db > 0)) {
      const double share = da / (da - db);
      Vec3 cut{};
      for (std::size_t k = 0; k < 3; ++k) cut[k] = a[k] + share * (b[k] - a[k]);
      cut[axis] = level;
      kept.push_back(cut);
    }
  }
  polygon = std::move(kept);
}

/// A convex body by its faces.
using Body = std::vector<Polygon>;

/// The new face that a cut at a plane leaves: corners of the other faces on the plane, sorted by
/// their angle around it, counter-clockwise as seen from where the axis points.
Polygon capOf(const Body& body, std::size_t axis, double level) {
  Polygon cap;
  Vec3 middle{};
  for (const Polygon& face : body) {
    for (const Vec3& corner : face) {
      if (corner[axis] == level) cap.push_back(corner);
    }
  }
  for (const Vec3& corner : cap) {
    for (std::size_t k = 0; k < 3; ++k) middle[k] += corner[k] / static_cast<double>(cap.size());
  }
  const std::size_t j = (axis + 1) % 3;
  const std::size_t l = (axis + 2) % 3;
  const auto angle = [&](const Vec3& corner) {
    return std::atan2(corner[l] - middle[l], corner[j] - middle[j]);
  };
  std::sort(cap.begin(), cap.end(),
            [&](const Vec3& p, const Vec3& q) { return angle(p) < angle(q); });
  return cap;
}

bool liesIn(const Polygon& face, std::size_t axis, double level) {
  for (const Vec3& corner : face) {
    if (corner[axis] != level) return false;
  }
  return true;
}

/// Of a closed body whose faces are counter-clockwise from outside.
double volumeOf(const Body& body, const Vec3& from) {
  double volume = 0;
  for (const Polygon& face : body) {
    for (std::size_t i = 1; i + 1 < face.size(); ++i) {
      volume += tripleProduct(minus(face[0], from), minus(face[i], from), minus(face[i + 1], from));
    }
  }
  return volume / 6;
}

}  // namespace

double volumeInCube(const std::array<Vec3, 4>& tet) {
  Body body;
  for (const std::array<int, 3>& face : kFaceCorners) {
    // Outward.
    body.push_back({tet[static_cast<std::size_t>(face[0])], tet[static_cast<std::size_t>(face[2])],
                    tet[static_cast<std::size_t>(face[1])]});
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const double level : {0.0, 1.0}) {
      for (Polygon& face : body) clip(face, axis, level, level == 0 ? 1 : -1);
      std::erase_if(
          body, [&](const Polygon& face) { return face.size() < 3 || liesIn(face, axis, level); });
      if (body.empty()) return 0;
      Polygon cap = capOf(body, axis, level);
      if (cap.size() < 3) continue;
      if (level == 0) std::reverse(cap.begin(), cap.end());
      body.push_back(std::move(cap));
    }
  }
  return volumeOf(body, {0.5, 0.5, 0.5});
}

ClippedTriangle clipToCube(const std::array<Vec3, 3>& triangle) {
  Polygon polygon(triangle.begin(), triangle.end());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    clip(polygon, axis, 0, 1);
    clip(polygon, axis, 1, -1);
  }
  ClippedTriangle clipped;
  Vec3 weighted{};
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const double area =
        0.5 * length(cross(minus(polygon[i], polygon[0]), minus(polygon[i + 1], polygon[0])));
    clipped.area += area;
    for (std::size_t k = 0; k < 3; ++k) {
      weighted[k] += area * (polygon[0][k] + polygon[i][k] + polygon[i + 1][k]) / 3;
    }
  }
  if (clipped.area > 0) {
    for (std::size_t k = 0; k < 3; ++k) clipped.centre[k] = weighted[k] / clipped.area;
  }
  return clipped;
}

}  // namespace hexhex
