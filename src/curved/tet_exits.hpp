// Hex edges through the interior of a tet, in floating point with proven bounds: through which
// faces they leave it, and where.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <hexhex/types.hpp>

#include <base/pair.hpp>
#include <curved/face_walk.hpp>
#include <lattice/corner_weights.hpp>
#include <lattice/tet_geometry.hpp>

namespace hexhex {

/// Seen from a midpoint of an edge that lies inside of a tet. What is not certain is for exact
/// arithmetic to decide.
///
/// The weights of a point, barycentric coordinates times six volumes, are four affine functions.
/// On a line, each of them vanishes where the line meets the plane of a face; the line leaves the
/// tet through the inner points of the first one if all others are positive there.
///
/// Bounds, in units of u = 2^-53 and of E, the largest coordinate of a corner relative to corner 0,
/// so that no point of the tet is farther from there than E along any axis. Coordinates carry one
/// rounding. Gradients are sums of up to six products, so they are below 6 E^2, known to 34 E^2;
/// weights at a midpoint, with steps of up to 2 E from the first one of a row, to 2^9 E^3. An exit
/// is at most 2 E away, so zeros beyond 2.5 E are none; where the slope is above E^2 / 2^8, nearer
/// ones are known to (2^9 + 85) 2^8 E plus their own roundings: less than 2^18 E, or 2^-35 E. All
/// weights there are known to 6 E^2 times that and what they had before: less than 2^-32 E^3.
class TetExits {
 public:
  explicit TetExits(std::int64_t unit) noexcept
      : unit_(unit), perUnit_(1 / static_cast<double>(unit)) {}

  /// Goes to a tet.
  void enter(const LatticeTet& corners) noexcept;
  /// Looks along an axis of its chart.
  void turn(int axis) noexcept;

  using Weights = CornerWeights;
  /// At the midpoint of an edge from a grid point along the axis.
  [[nodiscard]] Weights atMiddle(const GridPoint& begin) const noexcept;
  /// How weights change from a grid point to the next one.
  [[nodiscard]] const Weights& gradient(std::size_t axis) const noexcept { return gradient_[axis]; }

  /// The crossings of a line with the planes that it might leave the tet through.
  struct Zeros {
    std::array<Pair, 2> at;  ///< coordinates along the axis from the midpoint on, by face
  };
  [[nodiscard]] Zeros zeros(const Weights& middle) const noexcept {
    return {{middle.of01 * toZero_[0], middle.of23 * toZero_[1]}};
  }

  /// Where a line seems to leave the tet.
  struct Exit {
    int face;
    double at;  ///< coordinate along the axis from the midpoint on
  };
  template <Way way>
  [[nodiscard]] Exit exit(const Zeros& zeros) const noexcept {
    // As if it went forward.
    constexpr double kSign = way == Way::Forward ? 1 : -1;
    constexpr Pair kSigns = {kSign, kSign};
    const auto& bias = way == Way::Forward ? ahead_ : behind_;
    const Pair at01 = zeros.at[0] * kSigns + bias[0];
    const Pair at23 = zeros.at[1] * kSigns + bias[1];
    const int face01 = at01[1] < at01[0] ? 1 : 0;
    const int face23 = at23[1] < at23[0] ? 3 : 2;
    const double least01 = at01[1] < at01[0] ? at01[1] : at01[0];
    const double least23 = at23[1] < at23[0] ? at23[1] : at23[0];
    return {least23 < least01 ? face23 : face01, kSign * (least23 < least01 ? least23 : least01)};
  }

  /// Where the end of an edge is.
  enum class End : std::uint8_t { Inside, Beyond, Unsure };
  [[nodiscard]] End endAt(double distance) const noexcept {
    return distance > 0.5 + placeError_   ? End::Inside
           : distance < 0.5 - placeError_ ? End::Beyond
                                          : End::Unsure;
  }

  /// The point where an edge leaves the tet.
  struct Point {
    Weights shares;  ///< of the corners, with sum 1
    bool sure;       ///< whether the edge leaves the tet there, through the interior of that face
  };
  [[nodiscard]] Point point(const Weights& middle, const Exit& exit) const noexcept {
    const auto face = static_cast<std::size_t>(exit.face);
    const Weights there = middle.plus(slopes_, exit.at);
    const Pair of01 = there.of01 * kOthers[face].of01;
    const Pair of23 = there.of23 * kOthers[face].of23;
    const Pair least = smaller(of01 + kSelf[face].of01, of23 + kSelf[face].of23);
    const Pair sums = of01 + of23;
    const double perSum = 1 / (sums[0] + sums[1]);
    const Pair factor = {perSum, perSum};
    const bool isNear = exit.at < reach_ && exit.at > -reach_;
    return {{of01 * factor, of23 * factor},
            isNear && least[0] > leastWeight_ && least[1] > leastWeight_};
  }

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  using FaceWeights = std::array<Weights, 4>;
  /// By face: 0 for the corner opposite it, 1 for others.
  static constexpr FaceWeights kOthers = {{{{0, 1}, {1, 1}},  //
                                           {{1, 0}, {1, 1}},
                                           {{1, 1}, {0, 1}},
                                           {{1, 1}, {1, 0}}}};
  /// By face: infinite for the corner opposite it, 0 for others.
  static constexpr FaceWeights kSelf = {{{{kInfinity, 0}, {0, 0}},
                                         {{0, kInfinity}, {0, 0}},
                                         {{0, 0}, {kInfinity, 0}},
                                         {{0, 0}, {0, kInfinity}}}};

  std::int64_t unit_;
  double perUnit_;

  // Of the tet, in cells:
  LatticePoint corner0_{};
  double volume_ = 0;  ///< of a parallelepiped
  std::array<Weights, 3> gradient_{};
  double size_ = 0;         ///< E
  double leastWeight_ = 0;  ///< above it, a weight is positive where a line leaves
  double placeError_ = 0;   ///< of zeros
  double reach_ = 0;        ///< exits are nearer

  // Along the axis:
  std::size_t axis_ = 0;
  Weights slopes_{};
  std::array<Pair, 2> toZero_{};  ///< -1 / slope; 0 if it is too small
  std::array<Pair, 2> ahead_{};   ///< 0 for weights that fall along the axis, else infinity
  std::array<Pair, 2> behind_{};  ///< the same against it
};

}  // namespace hexhex
