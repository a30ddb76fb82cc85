// How directions in general position lie to the faces of tets.
#pragma once

#include <array>
#include <cstdint>

#include <base/pair.hpp>
#include <igm/plain_vertices.hpp>

namespace hexhex {

/// A direction, mirrored along an axis.
[[nodiscard]] constexpr Vec3 mirrored(Vec3 direction, std::size_t axis) noexcept {
  direction[axis] = -direction[axis];
  return direction;
}

/// Two tets at once, which may be the same: their edges from corner 0, to be projected along
/// directions onto planes across an axis. There, the orientation of a face tells from which side a
/// direction meets it.
class TetProjections {
 public:
  /// @param axisU, axisV  along which the directions have a component of 1 or -1, their largest
  TetProjections(const TetParameters& u, const TetParameters& v, std::size_t axisU = 0,
                 std::size_t axisV = 0)
      : axes_{axisU, axisV} {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t a = nextAxis(axisU, k);
      const std::size_t b = nextAxis(axisV, k);
      const Pair origin = {u[0][a], v[0][b]};
      for (std::size_t e = 0; e < 3; ++e) {
        edges_[e][k] = Pair{u[e + 1][a], v[e + 1][b]} - origin;
        size_ = larger(size_, magnitudeOf(edges_[e][k]));
      }
    }
  }

  /// For each tet, on which side of its faces a direction leads, or kUncertainSides.
  [[nodiscard]] std::array<TetSides, 2> sides(const Vec3& du, const Vec3& dv) const noexcept {
    // A shear that takes the direction to the axis keeps determinants as they are.
    const Pair sign = component(du, dv, 0);
    const std::array<Pair, 2> slopes = {component(du, dv, 1) * sign, component(du, dv, 2) * sign};
    std::array<std::array<Pair, 2>, 3> projected{};
    for (std::size_t e = 0; e < 3; ++e) {
      for (std::size_t k = 0; k < 2; ++k) {
        projected[e][k] = edges_[e][k + 1] - edges_[e][0] * slopes[k];
      }
    }
    // Of the triangles at corner 0, opposite corners 1 to 3, and of the one opposite corner 0, seen
    // from the other side.
    const Pair cross1 = crossOf(projected[1], projected[2]);
    const Pair cross2 = crossOf(projected[2], projected[0]);
    const Pair cross3 = crossOf(projected[0], projected[1]);
    const Pair cross0 = -(cross1 + cross2 + cross3);
    const Pair determinant = edges_[0][0] * cross1 + edges_[1][0] * cross2 + edges_[2][0] * cross3;
    const Pair smallest = smaller(smaller(magnitudeOf(cross0), magnitudeOf(cross1)),
                                  smaller(magnitudeOf(cross2), magnitudeOf(cross3)));
    const Pair uncertainty = kUncertainty * size_ * size_;
    const PairMask isSure =
        (size_ > kSmallestSize) & (determinant > uncertainty * size_) & (smallest > uncertainty);
    const PairMask outward =
        signBits(cross0, 0) | signBits(cross1, 1) | signBits(cross2, 2) | signBits(cross3, 3);
    // Seen along the axis, or against it.
    const PairMask inward = outward ^ (sign < 0 ? PairMask{0, 0} : PairMask{15, 15});
    const PairMask sides = inward & isSure;
    return {static_cast<TetSides>(sides[0]), static_cast<TetSides>(sides[1])};
  }

 private:
  // With u = 2^-53 and edges of at most `size` along each axis: slopes are at most 0.76 and 0.58,
  // projected edges below 1.76 and 1.58 size. Edges carry one rounding, projected ones three more,
  // 4.4 u size in all; cross products are below 5.6 size^2 and off by 40 u size^2, their sum by 150
  // u size^2, the determinant by 180 u size^3. Below the smallest size, products could underflow.
  static constexpr double kUncertainty = 0x1p-45;
  static constexpr double kSmallestSize = 0x1p-300;

  [[nodiscard]] static constexpr std::size_t nextAxis(std::size_t axis, std::size_t k) noexcept {
    return (axis + k) % 3;
  }
  [[nodiscard]] Pair component(const Vec3& du, const Vec3& dv, std::size_t k) const noexcept {
    return Pair{du[nextAxis(axes_[0], k)], dv[nextAxis(axes_[1], k)]};
  }
  [[nodiscard]] static Pair crossOf(const std::array<Pair, 2>& p,
                                    const std::array<Pair, 2>& q) noexcept {
    return p[0] * q[1] - p[1] * q[0];
  }
  /// Bit `place` where a number is negative.
  [[nodiscard]] static PairMask signBits(Pair x, int place) noexcept {
    using Bits = std::uint64_t __attribute__((vector_size(16)));
    return reinterpret_cast<PairMask>((reinterpret_cast<Bits>(x) >> 63) << place);
  }

  std::array<std::size_t, 2> axes_;
  std::array<std::array<Pair, 3>, 3> edges_{};  ///< to corners 1, 2, 3; along the axis, and across
  Pair size_ = {0, 0};
};

}  // namespace hexhex
