// The boundary of a tet mesh: triangles with adjacency, normals and areas.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <adjacency/tet_topology.hpp>

#include <hexhex/types.hpp>

#include <base/vector3.hpp>

namespace hexhex::shape {

/// A side of a boundary triangle: 3 * triangle + local index, 0 to 2.
using Side = Index;

/// Rows are the directions that are turned to x, y and z.
using Rotation = std::array<Vec3, 3>;

[[nodiscard]] inline Vec3 turned(const Rotation& rotation, const Vec3& v) {
  return {dot(rotation[0], v), dot(rotation[1], v), dot(rotation[2], v)};
}
[[nodiscard]] inline Vec3 turnedBack(const Rotation& rotation, const Vec3& v) {
  Vec3 result{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) result[k] += rotation[i][k] * v[i];
  }
  return result;
}

struct Surface {
  // Per side, counterclockwise as seen from outside:
  std::vector<Index> tails;  ///< the vertex where it starts
  std::vector<Side> twins;  ///< the same edge as a side of the adjacent triangle, from head to tail
  std::vector<double> lengths;   ///< in space
  std::vector<Vec3> directions;  ///< from tail to head, normalized

  // Per triangle:
  std::vector<adjacency::HalfFace> faces;
  std::vector<Vec3> normals;  ///< outward, normalized
  std::vector<Vec3> centres;
  std::vector<double> areas;

  std::size_t pointCount = 0;  ///< of the tet mesh
  double area = 0;
  double meanEdge = 0;
  double meanArea = 0;
  double diagonal = 0;  ///< of the bounding box

  [[nodiscard]] std::size_t triangleCount() const noexcept { return faces.size(); }
  [[nodiscard]] static Index triangleOf(Side side) noexcept { return side / 3; }
  /// The next side of the same triangle, which starts at the head.
  [[nodiscard]] static Side next(Side side) noexcept { return side / 3 * 3 + (side + 2) % 3; }
  [[nodiscard]] Index head(Side side) const noexcept { return tails[next(side)]; }
  [[nodiscard]] Index beyond(Side side) const noexcept { return triangleOf(twins[side]); }

  /// Per vertex: a side that starts there, or kNone inside the object.
  [[nodiscard]] std::vector<Side> sidesAt() const;
  /// Per vertex: the first one of its component.
  [[nodiscard]] std::vector<Index> components() const;
  /// Visits the sides that start where one does, clockwise as seen from outside.
  template <class Visit>
  void forEachSideAround(Side first, const Visit& visit) const {
    Side side = first;
    do {
      visit(side);
      side = next(twins[side]);
    } while (side != first);
  }

  void turn(const Rotation& rotation);
};

/// @param topology  of tets with positive volume
[[nodiscard]] Surface surfaceOf(const adjacency::TetTopology& topology,
                                const std::vector<Vec3>& points);

/// The same triangles after each vertex has moved to the mean of its neighbours so many times.
/// @param points  of the tet mesh, turned as the surface is
[[nodiscard]] Surface smoothed(const Surface& surface, std::vector<Vec3> points, int rounds);

/// Whether each edge has two triangles and each vertex a single fan of them.
[[nodiscard]] bool isManifold(const Surface& surface);

}  // namespace hexhex::shape
