// How a direction in general position lies to the faces of a tet.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include <base/branchless.hpp>
#include <base/vector3.hpp>
#include <map/plain_vertices.hpp>

namespace hexhex {

/// The faces of a tet, as seen by the direction in general position, or by the same one rotated.
class TetNormals {
 public:
  explicit TetNormals(const TetParameters& u, const Vec3& direction = kGeneralDirection)
      : direction_(direction) {
    const Vec3 a = minus(u[1], u[0]);
    const Vec3 b = minus(u[2], u[0]);
    const Vec3 c = minus(u[3], u[0]);
    for (std::size_t k = 0; k < 3; ++k) {
      size_ = std::max(std::max(size_, std::abs(a[k])), std::max(std::abs(b[k]), std::abs(c[k])));
    }
    normals_ = {cross(b, c), cross(c, a), cross(a, b)};
    const double determinant = dot(a, normals_[0]);
    isPositive_ = allOf(size_ > 0x1p-300, determinant > 0x1p-46 * size_ * size_ * size_);
    for (std::size_t i = 0; i < 3; ++i) sides_[i] = dot(direction, normals_[i]);
  }

  /// As computeSides(), for this direction.
  [[nodiscard]] TetSides sides() const noexcept { return packed(sides_); }

  /// The same, with the direction mirrored along an axis.
  [[nodiscard]] TetSides mirrored(std::size_t axis) const noexcept {
    Vec3 sides = sides_;
    for (std::size_t i = 0; i < 3; ++i) {
      sides[i] -= 2 * direction_[axis] * normals_[i][axis];
    }
    return packed(sides);
  }

 private:
  /// @param sides  of faces 1 to 3
  [[nodiscard]] TetSides packed(const Vec3& sides) const noexcept {
    const double side0 = -(sides[0] + sides[1] + sides[2]);
    // With u = 2^-53: differences carry one rounding, components of normals are below 2 size^2 and
    // off by 8 u size^2, the determinant by 42 u size^3, sides 1 to 3 by 33 u size^2, or 43 u
    // size^2 if mirrored, and side 0 by 171 u size^2, in whatever order a rotated direction has its
    // components. Below 2^-300, products could underflow.
    const double uncertainty = 0x1p-45 * size_ * size_;
    const double smallest = std::min(std::min(std::abs(side0), std::abs(sides[0])),
                                     std::min(std::abs(sides[1]), std::abs(sides[2])));
    if (!allOf(isPositive_, smallest > uncertainty)) return kUncertainSides;
    const unsigned outward = signBit(side0) | (signBit(sides[0]) << 1) | (signBit(sides[1]) << 2) |
                             (signBit(sides[2]) << 3);
    return static_cast<TetSides>(outward ^ kAllSides);
  }

  static constexpr unsigned kAllSides = 15;

  Vec3 direction_;
  /// Inward, of the faces opposite corners 1, 2, 3; the four normals add up to zero.
  std::array<Vec3, 3> normals_{};
  Vec3 sides_{};  ///< scalar products of the direction with them
  double size_ = 0;
  bool isPositive_ = false;
};

}  // namespace hexhex
