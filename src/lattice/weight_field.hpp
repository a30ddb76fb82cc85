// Barycentric coordinates of points around a tet, in floating point with a proven bound.
#pragma once

#include <array>
#include <cstddef>

#include <lattice/corner_weights.hpp>

namespace hexhex {

/// The weights of points, as volumes, in units of a grid: positive inside of the face opposite a
/// corner.
struct WeightField {
  std::array<CornerWeights, 3> gradient;  ///< by axis
  std::array<CornerWeights, 3> zero;      ///< by axis, a point where the weight vanishes

  WeightField() = default;
  /// @param of01,of23  the corners, by axis
  WeightField(const std::array<Pair, 3>& of01, const std::array<Pair, 3>& of23) noexcept {
    // Normals are products of two edges of their faces: of faces 0 and 1 that are opposite corners
    // 0 and 1, and so on.
    std::array<Pair, 3> first01;
    std::array<Pair, 3> second01;
    std::array<Pair, 3> first23;
    std::array<Pair, 3> second23;
    for (std::size_t k = 0; k < 3; ++k) {
      const Pair c10 = {of01[k][1], of01[k][0]};
      const Pair c00 = {of01[k][0], of01[k][0]};
      first01[k] = Pair{of23[k][1], of23[k][0]} - c10;
      second01[k] = of23[k] - c10;
      first23[k] = Pair{of23[k][1], of01[k][1]} - c00;
      second23[k] = Pair{of01[k][1], of23[k][0]} - c00;
      zero[k] = {c10, c00};
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t m = k == 2 ? 0 : k + 1;
      const std::size_t n = k == 0 ? 2 : k - 1;
      gradient[k].of01 = first01[m] * second01[n] - first01[n] * second01[m];
      gradient[k].of23 = first23[m] * second23[n] - first23[n] * second23[m];
    }
  }

  [[nodiscard]] CornerWeights at(const std::array<double, 3>& point) const noexcept {
    CornerWeights weights;
    for (std::size_t k = 0; k < 3; ++k) {
      const Pair coordinate = {point[k], point[k]};
      const Pair term01 = gradient[k].of01 * (coordinate - zero[k].of01);
      const Pair term23 = gradient[k].of23 * (coordinate - zero[k].of23);
      weights = k == 0 ? CornerWeights{term01, term23}
                       : CornerWeights{weights.of01 + term01, weights.of23 + term23};
    }
    return weights;
  }

  /// Of the error of a weight at() a point, or less than 64 steps of whole units from there.
  /// @param size  what no coordinate of a corner is away from any point on the way; corners and
  ///              first points may carry one rounding of such a distance
  [[nodiscard]] static constexpr double errorBound(double size) noexcept {
    // Errors in units of u = 2^-53, with magnitudes: edges, up to 2 size, are known to 4 size;
    // products of two of them to 20 size^2, and their differences, the gradients, up to 8 size^2,
    // to 48 size^2. At the first point, three products with distances, each up to 8 size^3 and
    // known to 72 size^3, make up a weight in two additions of at most 24 size^3: known to 264
    // size^3. On the way to any other point, there are three more products, each up to 8 size^3 and
    // known to 56 size^3, and 3 additions of at most 48 size^3, or, if it is done step by step,
    // less than 64: below 264 + 168 + 64 * 48 < 2^12 size^3. 2^13 covers terms of second order as
    // well.
    return 0x1p-40 * size * size * size;
  }
};

}  // namespace hexhex
