// Small conforming tet meshes in one chart, on which the exit searches can walk.
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

#include "oracle.hpp"
#include "random.hpp"

namespace hexhex::testing {

using namespace lattice;

/// A conforming mesh of positive tets with face neighbours.
class TetPatch {
 public:
  TetPatch(std::vector<LatticePoint> points, std::vector<std::array<int, 4>> tets)
      : points_(std::move(points)), tets_(std::move(tets)), neighbors_(tets_.size()) {
    std::map<std::array<int, 3>, std::pair<std::size_t, std::size_t>> open;
    for (std::size_t t = 0; t < tets_.size(); ++t) {
      for (std::size_t f = 0; f < 4; ++f) {
        neighbors_[t][f] = -1;
        const auto [entry, isNew] = open.try_emplace(faceKey(t, f), t, f);
        if (isNew) continue;
        const auto [otherTet, otherFace] = entry->second;
        neighbors_[t][f] = static_cast<int>(otherTet);
        neighbors_[otherTet][otherFace] = static_cast<int>(t);
      }
    }
  }

  [[nodiscard]] int size() const { return static_cast<int>(tets_.size()); }
  [[nodiscard]] LatticeTet corners(int tet) const {
    LatticeTet corners;
    for (std::size_t i = 0; i < 4; ++i) {
      corners[i] = points_[static_cast<std::size_t>(tets_[static_cast<std::size_t>(tet)][i])];
    }
    return corners;
  }
  /// The tet beyond a face, or -1.
  [[nodiscard]] int neighbor(int tet, int face) const {
    return neighbors_[static_cast<std::size_t>(tet)][static_cast<std::size_t>(face)];
  }
  /// The face of `tet` beyond which `other` lies.
  [[nodiscard]] int faceTowards(int tet, int other) const {
    for (int f = 0; f < 4; ++f) {
      if (neighbor(tet, f) == other) return f;
    }
    return -1;
  }
  [[nodiscard]] bool allPositive() const {
    for (int t = 0; t < size(); ++t) {
      if (determinant<Integer256>(widened<Integer256>(corners(t))) <= 0) return false;
    }
    return true;
  }

 private:
  [[nodiscard]] std::array<int, 3> faceKey(std::size_t tet, std::size_t face) const {
    std::array<int, 3> key;
    for (std::size_t i = 0; i < 3; ++i) {
      key[i] = tets_[tet][static_cast<std::size_t>(kFaceCorners[face][i])];
    }
    std::sort(key.begin(), key.end());
    return key;
  }

  std::vector<LatticePoint> points_;
  std::vector<std::array<int, 4>> tets_;
  std::vector<std::array<int, 4>> neighbors_;
};

/// A patch and a lattice point in the interior of a vertex, edge or face common to all its tets.
struct Star {
  TetPatch patch;
  LatticePoint center;
};

/// The tets around a vertex: a cone over the triangulated surface of a cube of n^3 cells, with
/// random diagonals and distances; the points of the surface are moved by up to `jitter` 16ths of a
/// cell. Without jitter, many directions lie on edges and faces.
inline Star vertexStar(LatticeRandom& random, int n, std::int64_t jitter) {
  const LatticePoint center = random.point(-1000, 1000);
  std::vector<LatticePoint> points = {center};
  std::vector<std::array<int, 4>> tets;
  std::map<LatticePoint, int> numbers;
  const auto number = [&](const LatticePoint& surface) {
    const auto [entry, isNew] = numbers.try_emplace(surface, static_cast<int>(points.size()));
    if (isNew) {
      const std::int64_t distance = random.between(1, 8);
      LatticePoint p = random.point(-jitter, jitter);
      for (std::size_t k = 0; k < 3; ++k) {
        p[k] = center[k] + distance * (p[k] + 16 * (2 * surface[k] - n));
      }
      points.push_back(p);
    }
    return entry->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < 2 * n * n; ++i) {
      const bool upper = i >= n * n;
      const std::int64_t u = i % n;
      const std::int64_t v = i / n % n;
      const auto corner = [&](std::int64_t du, std::int64_t dv) {
        LatticePoint p;
        p[axis] = upper ? n : 0;
        p[(axis + 1) % 3] = u + du;
        p[(axis + 2) % 3] = v + dv;
        return number(p);
      };
      std::array<int, 4> quad = {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
      if (!upper) std::swap(quad[1], quad[3]);
      if (random.oneIn(2)) std::rotate(quad.begin(), quad.begin() + 1, quad.end());
      tets.push_back({0, quad[0], quad[1], quad[2]});
      tets.push_back({0, quad[0], quad[2], quad[3]});
    }
  }
  return {TetPatch(std::move(points), std::move(tets)), center};
}

/// Whether the directions follow each other around an axis by less than half a turn each, once
/// around altogether.
inline bool windOnce(const LatticePoint& axis, const std::vector<LatticePoint>& around) {
  const auto turn = [&](const LatticePoint& a, const LatticePoint& b) {
    return signum(determinant<Integer256>(Point<Integer256>{}, widened<Integer256>(axis),
                                          widened<Integer256>(a), widened<Integer256>(b)));
  };
  int wraps = 0;
  for (std::size_t i = 0; i < around.size(); ++i) {
    const LatticePoint& a = around[i];
    const LatticePoint& b = around[(i + 1) % around.size()];
    if (turn(a, b) <= 0) return false;
    // The half plane of the first direction is reached or passed once.
    if (turn(a, around[0]) > 0 && turn(around[0], b) >= 0) ++wraps;
  }
  return wraps == 1;
}

/// The tets around an edge with random directions of edge and spokes; with a small range, many
/// coordinate directions lie on edges and faces.
inline Star edgeStar(LatticeRandom& random, std::int64_t range) {
  for (;;) {
    const LatticePoint center = random.point(-1000, 1000);
    const LatticePoint axis = random.point(-range, range);
    std::vector<LatticePoint> around(3 + random.below(4));
    for (LatticePoint& spoke : around) spoke = random.point(-range, range);
    if (!windOnce(axis, around)) continue;
    const auto at = [&](const LatticePoint& d, std::int64_t distance) {
      return LatticePoint{center[0] + distance * d[0], center[1] + distance * d[1],
                          center[2] + distance * d[2]};
    };
    std::vector<LatticePoint> points = {at(axis, -random.between(1, 5)),
                                        at(axis, random.between(1, 5))};
    std::vector<std::array<int, 4>> tets;
    for (std::size_t i = 0; i < around.size(); ++i) {
      points.push_back(at(around[i], random.between(1, 5)));
      const int next = static_cast<int>((i + 1) % around.size());
      tets.push_back({0, 1, static_cast<int>(i) + 2, next + 2});
    }
    return {TetPatch(std::move(points), std::move(tets)), center};
  }
}

/// Two tets on a face, with the point at a third of each corner.
inline Star faceStar(LatticeRandom& random, std::int64_t range) {
  for (;;) {
    const LatticePoint center = random.point(-1000, 1000);
    std::vector<LatticePoint> points(5);
    for (LatticePoint& p : points) p = random.point(-range, range);
    for (std::size_t k = 0; k < 3; ++k) points[2][k] = -points[0][k] - points[1][k];
    for (LatticePoint& p : points) {
      for (std::size_t k = 0; k < 3; ++k) p[k] += center[k];
    }
    TetPatch patch(std::move(points), {{0, 1, 2, 3}, {0, 2, 1, 4}});
    if (patch.allPositive()) return {std::move(patch), center};
  }
}

/// A box of cells with six tets each (Kuhn), cut along the diagonals of the box. Inner points are
/// moved by up to an eighth of a cell, unless that makes a tet negative.
inline TetPatch boxPatch(LatticeRandom& random, const LatticePoint& origin,
                         const LatticePoint& spacing, int cells, bool jitter) {
  std::vector<LatticePoint> points;
  std::vector<std::array<int, 4>> tets;
  const int row = cells + 1;
  for (int i = 0; i < row * row * row; ++i) {
    const std::array<int, 3> grid = {i % row, i / row % row, i / (row * row)};
    const bool inner =
        std::all_of(grid.begin(), grid.end(), [&](int g) { return g > 0 && g < cells; });
    LatticePoint p;
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = origin[k] + grid[k] * spacing[k];
      if (inner && jitter) p[k] += random.between(-spacing[k] / 8, spacing[k] / 8);
    }
    points.push_back(p);
    if (*std::max_element(grid.begin(), grid.end()) == cells) continue;
    const std::array<int, 3> stride = {1, row, row * row};
    for (std::size_t a = 0; a < 3; ++a) {
      const int first = stride[a];
      const int second = stride[(a + 1) % 3];
      const int third = stride[(a + 2) % 3];
      tets.push_back({i, i + first, i + first + second, i + first + second + third});
      tets.push_back({i, i + third + second, i + third, i + first + second + third});
    }
  }
  TetPatch patch(points, tets);
  return patch.allPositive() ? patch : boxPatch(random, origin, spacing, cells, false);
}

}  // namespace hexhex::testing
