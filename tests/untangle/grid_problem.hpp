// Problems whose best answer is known: a box of unit cubes, cut into tets, that is to be as it is.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include <untangle/untangle.hpp>

#include <base/vector3.hpp>
#include <mesh/grid_meshes.hpp>

namespace hexhex::test {

enum class Boundary : std::uint8_t { Fixed, Sliding };

struct GridProblem {
  untangle::Problem problem;
  std::vector<double> best;  ///< the unknowns of the undistorted box
};

/// @param boundary  whether vertices of the box's sides may move in their planes
inline GridProblem gridProblem(std::size_t n, Boundary boundary) {
  const TetMap map = testing::identityMap(n);
  const auto side = static_cast<double>(n);
  GridProblem grid;
  std::vector<untangle::Corner> corners;
  for (const Vec3& p : map.points) {
    untangle::Corner corner;
    bool isOutside = false;
    for (const double x : p) isOutside = isOutside || x == 0 || x == side;
    for (std::size_t k = 0; k < 3; ++k) {
      const bool isBound = boundary == Boundary::Fixed ? isOutside : p[k] == 0 || p[k] == side;
      if (isBound) {
        corner.constant[k] = p[k];
        continue;
      }
      corner.unknown[k] = static_cast<int>(grid.best.size());
      corner.sign[k] = 1;
      grid.best.push_back(p[k]);
    }
    corners.push_back(corner);
  }
  for (const Tet& tet : map.tets) {
    untangle::Element element;
    for (std::size_t i = 0; i < 4; ++i) element.corners[i] = corners[tet[i]];
    std::array<Vec3, 3> edges{};
    for (std::size_t i = 0; i < 3; ++i) {
      edges[i] = minus(map.points[tet[i + 1]], map.points[tet[0]]);
    }
    element.gradients = untangle::tetGradients(edges);
    grid.problem.elements.push_back(element);
  }
  grid.problem.x = grid.best;
  return grid;
}

/// Moves unknowns at random, by so much at most.
inline void shuffle(untangle::Problem& problem, double most, std::uint64_t seed = 1) {
  std::mt19937_64 random(seed);
  for (double& x : problem.x) {
    x += most * (2 * static_cast<double>(random() >> 11) * 0x1p-53 - 1);
  }
}

/// The volume of a tet, times six.
inline double volumeOf(const untangle::Problem& problem, const untangle::Element& element) {
  std::array<Vec3, 4> u{};
  for (std::size_t i = 0; i < 4; ++i) u[i] = element.corners[i].at(problem.x.data());
  return tripleProduct(minus(u[1], u[0]), minus(u[2], u[0]), minus(u[3], u[0]));
}

inline std::size_t flippedTets(const untangle::Problem& problem) {
  std::size_t count = 0;
  for (const untangle::Element& element : problem.elements) {
    count += volumeOf(problem, element) > 0 ? 0 : 1;
  }
  return count;
}

}  // namespace hexhex::test
