// Points as weighted sums of a tet's corners, with exact comparison of their coordinates.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include <hexhex/types.hpp>

#include <lattice/tet_geometry.hpp>

namespace hexhex::curved {

/// A point of a tet: nonnegative weights of the corners, up to a common factor. At most 124 bits
/// each (minors of coordinates), so that products with coordinates fit in 192 bits.
struct SimplexPoint {
  std::array<lattice::Int128, 4> weights{};

  /// The simplex whose interior contains the point.
  [[nodiscard]] constexpr lattice::CornerMask simplex() const noexcept {
    lattice::CornerMask mask = lattice::kNoSimplex;
    for (int i = 0; i < 4; ++i) {
      if (weights[static_cast<std::size_t>(i)] != 0) {
        mask = static_cast<lattice::CornerMask>(mask | lattice::cornerBit(i));
      }
    }
    return mask;
  }

  [[nodiscard]] static constexpr SimplexPoint corner(std::size_t i) noexcept {
    SimplexPoint point;
    point.weights[i] = 1;
    return point;
  }
  /// The point between corners i and j where a linear function vanishes that has the given values,
  /// of opposite signs, at the two.
  [[nodiscard]] static constexpr SimplexPoint between(std::size_t i, std::size_t j,
                                                      std::int64_t atI, std::int64_t atJ) noexcept {
    assert(std::min(atI, atJ) <= 0 && std::max(atI, atJ) >= 0 && atI != atJ);
    SimplexPoint point;
    point.weights[i] =
        atJ < 0 ? -static_cast<lattice::Int128>(atJ) : static_cast<lattice::Int128>(atJ);
    point.weights[j] =
        atI < 0 ? -static_cast<lattice::Int128>(atI) : static_cast<lattice::Int128>(atI);
    return point;
  }

  /// Sign of (coordinate `axis` of the point) - target.
  [[nodiscard]] int compare(const lattice::LatticeTet& corners, std::size_t axis,
                            std::int64_t target) const noexcept {
    // Weights carry two roundings and differences one; products and three sums of up to four terms
    // add at most five more: 8 * 2^-53 = 2^-50 of the sum of magnitudes, which is itself as
    // precise. 2^-49 leaves a factor of two.
    constexpr double kRelativeError = 0x1p-49;
    double sum = 0;
    double magnitude = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const double term =
          lattice::toDouble(weights[i]) * static_cast<double>(corners[i][axis] - target);
      sum += term;
      magnitude += std::abs(term);
    }
    if (std::abs(sum) > kRelativeError * magnitude) return sum > 0 ? 1 : -1;
    lattice::Int192 exact;
    for (std::size_t i = 0; i < 4; ++i) exact.addProduct(weights[i], corners[i][axis] - target);
    return exact.sign();
  }

  /// Rounded weights with sum 1.
  [[nodiscard]] std::array<double, 4> normalized() const noexcept {
    std::array<double, 4> shares{};
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) sum += shares[i] = lattice::toDouble(weights[i]);
    assert(sum > 0);
    for (double& share : shares) share /= sum;
    return shares;
  }
};

/// A coordinate of a point given by normalized weights.
[[nodiscard]] inline double coordinate(const std::array<double, 4>& shares,
                                       const lattice::LatticeTet& corners,
                                       std::size_t axis) noexcept {
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (shares[i] != 0) sum += shares[i] * static_cast<double>(corners[i][axis]);
  }
  return sum;
}

/// Where a line parallel to axis `along` leaves the interior of a simplex of a tet in the positive
/// direction. The line passes through coordinates 0 of the other axes and through the interior of
/// the simplex. Corners are in coordinates relative to the line.
[[nodiscard]] SimplexPoint exitPoint(const lattice::LatticeTet& corners,
                                     lattice::CornerMask simplex, std::size_t along) noexcept;

/// Where such a line crosses a face that is not parallel to it.
/// @return no weights at all if it does not meet the closed face
[[nodiscard]] SimplexPoint intersectionWithFace(const lattice::LatticeTet& corners, int face,
                                                std::size_t along) noexcept;

}  // namespace hexhex::curved
