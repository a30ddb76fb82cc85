// Bodies of unit cubes, cut into tets and labelled as their faces are, then deformed: what a
// polycube of such labels is like is known from the cubes.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/context.hpp>
#include <hexhex/quantize.hpp>
#include <hexhex/types.hpp>

#include "extract/support.hpp"

namespace hexhex::test {

/// A tet mesh and the labels of its boundary.
struct Labelled {
  TetMesh tets;
  std::vector<FaceFlags> flags;
};

inline TetMap mapOf(const Labelled& input) {
  Context context;
  return mapFromFlags(input.tets, input.flags, context);
}

class CubeBody {
 public:
  using Cell = std::array<int, 3>;

  CubeBody(Cell size, std::function<bool(const Cell&)> isFull)
      : size_(size), isFull_(std::move(isFull)) {}

  [[nodiscard]] bool isFull(const Cell& cell) const {
    for (std::size_t k = 0; k < 3; ++k) {
      if (cell[k] < 0 || cell[k] >= size_[k]) return false;
    }
    return isFull_(cell);
  }

  /// How many lattice points have so many full cubes around them, of 1, 3, 5 and 7: corners, which
  /// no other numbers of hexahedra on edges and faces change.
  [[nodiscard]] std::map<int, int> corners() const {
    std::map<int, int> corners;
    forEach(1, [&](const Cell& point) {
      int count = 0;
      for (int i = 0; i < 8; ++i) {
        count += isFull({point[0] - (i & 1), point[1] - (i >> 1 & 1), point[2] - (i >> 2)}) ? 1 : 0;
      }
      if (count % 2 != 0) ++corners[count];
    });
    return corners;
  }

  /// Each cube becomes fineness^3 smaller ones, of six tets that share a diagonal.
  /// @param place  of a point whose coordinates are those of cubes
  [[nodiscard]] Labelled labelled(int fineness,
                                  const std::function<Vec3(const Vec3&)>& place) const {
    Labelled result;
    std::map<Cell, Index> numbers;
    const auto vertex = [&](const Cell& point) {
      const auto [found, isNew] = numbers.try_emplace(point, result.tets.points.size());
      if (isNew) {
        Vec3 p{};
        for (std::size_t k = 0; k < 3; ++k) p[k] = static_cast<double>(point[k]) / fineness;
        result.tets.points.push_back(place(p));
      }
      return found->second;
    };
    forEach(0, [&](const Cell& coarse) {
      if (!isFull(coarse)) return;
      for (int i = 0; i < fineness * fineness * fineness; ++i) {
        addTets(
            {coarse[0] * fineness + i % fineness, coarse[1] * fineness + i / fineness % fineness,
             coarse[2] * fineness + i / fineness / fineness},
            fineness, vertex, result);
      }
    });
    return result;
  }

 private:
  template <class Visit>
  void forEach(int more, const Visit& visit) const {
    for (int x = 0; x < size_[0] + more; ++x) {
      for (int y = 0; y < size_[1] + more; ++y) {
        for (int z = 0; z < size_[2] + more; ++z) visit(Cell{x, y, z});
      }
    }
  }

  /// Walks along the axes in each of six orders, from the lowest corner to the highest.
  template <class Vertex>
  void addTets(const Cell& cell, int fineness, const Vertex& vertex, Labelled& result) const {
    std::array<std::size_t, 3> axes = {0, 1, 2};
    int number = 0;
    do {
      std::array<Cell, 4> corners = {cell, cell, cell, cell};
      for (std::size_t i = 1; i < 4; ++i) {
        for (std::size_t j = i; j < 4; ++j) ++corners[j][axes[i - 1]];
      }
      // Orders that are odd permutations turn the other way.
      constexpr std::array<bool, 6> kIsOdd = {false, true, true, false, false, true};
      if (kIsOdd[static_cast<std::size_t>(number++)]) std::swap(corners[1], corners[2]);
      FaceFlags& flags = result.flags.emplace_back();
      Tet& tet = result.tets.tets.emplace_back();
      for (std::size_t i = 0; i < 4; ++i) {
        tet[i] = vertex(corners[i]);
        flags[i] = labelOpposite(corners, i, cell, fineness);
      }
    } while (std::next_permutation(axes.begin(), axes.end()));
  }

  /// Of the face opposite a corner of a tet in a cell.
  [[nodiscard]] std::int8_t labelOpposite(const std::array<Cell, 4>& corners, std::size_t opposite,
                                          const Cell& cell, int fineness) const {
    const auto& first = corners[opposite == 0 ? 1 : 0];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      bool isLevel = true;
      for (std::size_t i = 0; i < 4; ++i) {
        isLevel = isLevel && (i == opposite || corners[i][axis] == first[axis]);
      }
      if (!isLevel) continue;
      const bool isUpper = first[axis] > cell[axis];
      Cell beyond = cell;
      beyond[axis] += isUpper ? 1 : -1;
      for (int& x : beyond) x = x < 0 ? -1 : x / fineness;
      if (!isFull(beyond)) return static_cast<std::int8_t>(2 * axis + (isUpper ? 0 : 1));
    }
    return -1;
  }

  Cell size_;
  std::function<bool(const Cell&)> isFull_;
};

/// A tet with a long spike on each face, at whose tips three triangles meet: no labels of the
/// twelve triangles are those of a polycube.
inline TetMesh spikedTet() {
  return {{{0.962, 0.811, 0.716},
           {1.259, -0.970, -0.731},
           {-1.039, 0.991, -1.048},
           {-1.108, -1.102, 0.793},
           {-4.642, -5.753, -5.640},
           {-6.646, 3.734, 2.684},
           {7.201, -7.848, 4.996},
           {6.225, 4.393, -5.535}},
          {{0, 2, 1, 3}, {4, 1, 2, 3}, {0, 5, 2, 3}, {0, 1, 6, 3}, {0, 1, 2, 7}}};
}

/// How many vertices of a mesh have so many cells, of odd numbers.
inline std::map<int, int> cornersOf(const HexMesh& mesh) {
  std::vector<int> counts(mesh.points.size());
  for (const Hex& cell : mesh.cells) {
    for (const Index v : cell) ++counts[v];
  }
  std::map<int, int> corners;
  for (const int count : counts) {
    if (count % 2 != 0) ++corners[count];
  }
  return corners;
}

/// Quantizes, extracts and verifies the polycube, whose corners and topology are those of the body.
/// @param handles  through the body
inline void expectPolycube(const CubeBody& body, const Labelled& input, int handles = 0) {
  const QuantizedMap quantized = quantize(mapOf(input), {.cells = 500});
  ExtractOptions exact;
  exact.tolerance = 0;
  const HexMesh mesh = verifiedExtraction(quantized.map, exact);
  EXPECT_EQ(cornersOf(mesh), body.corners());
  const Expectation expected = check(quantized.map).expected;
  EXPECT_TRUE(expected.innerSingularEdges.empty());
  EXPECT_EQ(expected.eulerCharacteristic, 1 - handles);
}

/// Points of the square [-1, 1]^2 or of a cube moved onto circles or balls of the same height.
template <std::size_t N>
std::array<double, N> rounded(const std::array<double, N>& p) {
  double most = 0;
  double square = 0;
  for (const double x : p) most = std::max(most, std::abs(x)), square += x * x;
  std::array<double, N> result = p;
  if (square > 0) {
    for (double& x : result) x *= most / std::sqrt(square);
  }
  return result;
}

/// Turned about (1, 2, 3).
inline Vec3 turned(const Vec3& p, double angle) {
  const double norm = std::sqrt(14);
  const Vec3 n = {1 / norm, 2 / norm, 3 / norm};
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  const double along = (1 - c) * (n[0] * p[0] + n[1] * p[1] + n[2] * p[2]);
  return {c * p[0] + s * (n[1] * p[2] - n[2] * p[1]) + along * n[0],
          c * p[1] + s * (n[2] * p[0] - n[0] * p[2]) + along * n[1],
          c * p[2] + s * (n[0] * p[1] - n[1] * p[0]) + along * n[2]};
}

}  // namespace hexhex::test
