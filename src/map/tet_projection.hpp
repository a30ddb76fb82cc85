// How a direction in general position lies to the faces of a tet.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include <base/branchless.hpp>
#include <base/pair.hpp>
#include <base/vector3.hpp>
#include <map/plain_vertices.hpp>

namespace hexhex {

/// The edges of a tet from corner 0, to be projected along directions onto the plane across an
/// axis. There, the orientation of a face tells from which side a direction meets it.
class TetProjection {
 public:
  /// @param axis  along which the directions have a component of 1 or -1, their largest
  explicit TetProjection(const TetParameters& u, std::size_t axis = 0) : axis_(axis) {
    Pair largest = {0, 0};
    for (std::size_t e = 0; e < 3; ++e) {
      along_[e] = u[e + 1][axis] - u[0][axis];
      across_[e] = acrossOf(u[e + 1]) - acrossOf(u[0]);
      largest =
          larger(larger(largest, magnitudeOf(Pair{along_[e], along_[e]})), magnitudeOf(across_[e]));
    }
    size_ = std::max(largest[0], largest[1]);
  }

  /// On which side of the faces a direction leads, or kUncertainSides.
  [[nodiscard]] TetSides sides(const Vec3& direction) const noexcept {
    // A shear that takes the direction to the axis keeps determinants as they are.
    const double sign = direction[axis_];
    const Pair slope = acrossOf(direction) * sign;
    std::array<Pair, 3> projected;  // NOLINT: written before it is read
    for (std::size_t e = 0; e < 3; ++e) {
      projected[e] = across_[e] - Pair{along_[e], along_[e]} * slope;
    }
    const Vec3 crosses = {crossOf(projected[1], projected[2]), crossOf(projected[2], projected[0]),
                          crossOf(projected[0], projected[1])};
    const double determinant =
        along_[0] * crosses[0] + along_[1] * crosses[1] + along_[2] * crosses[2];
    // Of the triangle opposite corner 0, seen from the other side.
    const double cross0 = -(crosses[0] + crosses[1] + crosses[2]);
    const double smallest = std::min(std::min(std::abs(cross0), std::abs(crosses[0])),
                                     std::min(std::abs(crosses[1]), std::abs(crosses[2])));
    if (!allOf(size_ > kSmallestSize, determinant > kUncertainty * size_ * size_ * size_,
               smallest > kUncertainty * size_ * size_)) {
      return kUncertainSides;
    }
    const unsigned against = signBit(cross0) | (signBit(crosses[0]) << 1) |
                             (signBit(crosses[1]) << 2) | (signBit(crosses[2]) << 3);
    return static_cast<TetSides>(against ^ (sign < 0 ? 0 : kAllSides));
  }

 private:
  // With u = 2^-53 and edges of at most `size` along each axis: slopes are at most 0.76 and 0.58,
  // projected edges below 1.76 and 1.58 size. Edges carry one rounding, projected ones three more,
  // 4.4 u size in all; cross products are below 5.6 size^2 and off by 40 u size^2, their sum by 150
  // u size^2, the determinant by 180 u size^3. Below the smallest size, products could underflow.
  static constexpr double kUncertainty = 0x1p-45;
  static constexpr double kSmallestSize = 0x1p-300;
  static constexpr unsigned kAllSides = 15;

  /// The two components across the axis, in cyclic order.
  [[nodiscard]] Pair acrossOf(const Vec3& v) const noexcept {
    return axis_ == 0 ? loadPair(&v[1]) : Pair{v[(axis_ + 1) % 3], v[(axis_ + 2) % 3]};
  }
  [[nodiscard]] static double crossOf(Pair p, Pair q) noexcept {
    const Pair products = p * Pair{q[1], q[0]};
    return products[0] - products[1];
  }

  std::size_t axis_;
  Vec3 along_{};                  ///< per edge to corners 1, 2, 3
  std::array<Pair, 3> across_{};  ///< per edge
  double size_ = 0;
};

/// A direction, mirrored along an axis.
[[nodiscard]] constexpr Vec3 mirrored(Vec3 direction, std::size_t axis) noexcept {
  direction[axis] = -direction[axis];
  return direction;
}

}  // namespace hexhex
