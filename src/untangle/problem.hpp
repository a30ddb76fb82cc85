// The solver's input: elements whose corners are affine functions of the unknowns.
//
// An element maps its ideal shape by a Jacobian matrix that is linear in its corners u_0 to u_3:
//
//     J = C + (u_1 - u_0) g_1^T + (u_2 - u_0) g_2^T + (u_3 - u_0) g_3^T
//
// It is good if det J > 0. There are three kinds of elements:
//
// - Tets: C = 0 and g = tetGradients(ideal edges).
// - Triangles of a surface that is to face the direction e, with outward normal n: the g_i are the
//   gradients in the triangle's plane, g_3 = 0, C = e n^T. det J is the ratio of areas, negative if
//   the triangle is flipped. The energy of the tets alone does not keep triangles from folding over
//   within the plane to which they are constrained.
// - Edges of a border that is to run along s e_c (a signed axis): with direction d and length l,
//   g_1 = d / l, g_2 = g_3 = 0, C = R - s e_c d^T for a rotation R that turns d to s e_c; only
//   coordinate c of the corners varies. det J is the ratio of lengths, negative if the edge runs
//   backward.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <hexhex/types.hpp>

#include <base/vector3.hpp>

namespace hexhex::untangle {

using Matrix3 = std::array<Vec3, 3>;  ///< rows

/// Coordinate k is constant[k] + sign[k] * x[unknown[k]], or constant[k] alone if unknown[k] is
/// negative. (With Problem::sums, sums of unknowns take the place of x.) Several coordinates, even
/// of one corner, may share an unknown.
struct Corner {
  Vec3 constant{};
  std::array<int, 3> unknown = {-1, -1, -1};
  std::array<std::int8_t, 3> sign{};  ///< 1 or -1 if there is an unknown

  [[nodiscard]] Vec3 at(const double* x) const noexcept {
    Vec3 u = constant;
    for (std::size_t k = 0; k < 3; ++k) {
      if (unknown[k] >= 0) u[k] += sign[k] * x[unknown[k]];
    }
    return u;
  }
};

struct Element {
  std::array<Corner, 4> corners;
  std::array<Vec3, 3> gradients{};  ///< of corners 1 to 3; that of corner 0 is minus their sum
  double weight = 1;                ///< positive
  int offset = -1;                  ///< index of C in Problem::matrices; -1: C = 0
  int target = -1;                  ///< index of the target rotation, likewise; -1: identity
};

/// The gradients of a tet, given the three edges of its ideal shape at corner 0: the rows of the
/// inverse of the matrix whose columns are these edges.
[[nodiscard]] inline std::array<Vec3, 3> tetGradients(const std::array<Vec3, 3>& edges) {
  const double det = tripleProduct(edges[0], edges[1], edges[2]);
  std::array<Vec3, 3> rows = {cross(edges[1], edges[2]), cross(edges[2], edges[0]),
                              cross(edges[0], edges[1])};
  for (Vec3& row : rows) {
    for (double& component : row) component /= det;
  }
  return rows;
}

/// Rows of a matrix, stored one after another.
struct SparseRows {
  struct Entry {
    int column = 0;
    double factor = 0;
  };
  std::vector<Entry> entries;
  std::vector<std::size_t> begins = {0};  ///< per row, plus the end of the last one

  [[nodiscard]] std::size_t size() const noexcept { return begins.size() - 1; }
};

struct Problem {
  std::vector<Element> elements;
  std::vector<Matrix3> matrices;
  /// Weight of the term 0.5 |J - target|^2, added to the foldover-free energy. Without it, some
  /// maps without constant corners collapse.
  double pull = 0;
  std::vector<double> x;  ///< the unknowns: initial guess, then the solution
  /// If not empty, Corner::unknown refers to rows of this matrix times x instead of entries of x.
  SparseRows sums;
};

}  // namespace hexhex::untangle
