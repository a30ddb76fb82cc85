// What a map does to points, computed in doubles straight from the caller's arrays.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <hexhex/types.hpp>

#include <base/vector3.hpp>

namespace hexhex::test {

class TetPoints {
 public:
  using Simplex = std::vector<Index>;  ///< vertices, ascending

  TetPoints(const TetMap& map, int scale) : map_(map), scale_(scale) {}

  [[nodiscard]] Simplex simplex(Index tet, CornerSet corners) const {
    Simplex vertices;
    for (std::size_t i = 0; i < 4; ++i) {
      if (((corners >> i) & 1U) != 0) vertices.push_back(map_.tets[tet][i]);
    }
    std::sort(vertices.begin(), vertices.end());
    return vertices;
  }

  /// The parameter of a point in space, by the affine map of a tet.
  [[nodiscard]] Vec3 parameter(Index tet, const Vec3& p) const {
    const Tet& t = map_.tets[tet];
    const Vec3 a = minus(map_.points[t[1]], map_.points[t[0]]);
    const Vec3 b = minus(map_.points[t[2]], map_.points[t[0]]);
    const Vec3 c = minus(map_.points[t[3]], map_.points[t[0]]);
    const Vec3 d = minus(p, map_.points[t[0]]);
    const double volume = dot(a, hexhex::cross(b, c));
    const std::array<double, 3> w = {dot(d, hexhex::cross(b, c)) / volume,
                                     dot(a, hexhex::cross(d, c)) / volume,
                                     dot(a, hexhex::cross(b, d)) / volume};
    const TetParameters& u = map_.parameters[tet];
    // Relative to an integer near corner 0, as charts may be far from the origin.
    Vec3 result{};
    for (std::size_t k = 0; k < 3; ++k) {
      result[k] = u[0][k] - std::round(u[0][k]);
      for (std::size_t i = 0; i < 3; ++i) result[k] += w[i] * (u[i + 1][k] - u[0][k]);
      result[k] *= scale_;
    }
    return result;
  }

  [[nodiscard]] double parametricDistance(Index tet, const Vec3& p, const Vec3& q) const {
    return length(minus(parameter(tet, p), parameter(tet, q)));
  }

  /// How far a point is from the nearest line of the grid: two coordinates are integers there.
  [[nodiscard]] double distanceFromLine(Index tet, const Vec3& p) const {
    return fractions(tet, p)[1];
  }
  /// From the nearest plane.
  [[nodiscard]] double distanceFromPlane(Index tet, const Vec3& p) const {
    return fractions(tet, p)[0];
  }

 private:
  /// Distances of the coordinates from integers, ascending.
  [[nodiscard]] Vec3 fractions(Index tet, const Vec3& p) const {
    Vec3 u = parameter(tet, p);
    for (double& coordinate : u) coordinate = std::abs(coordinate - std::round(coordinate));
    std::sort(u.begin(), u.end());
    return u;
  }

  const TetMap& map_;
  int scale_;
};

}  // namespace hexhex::test
