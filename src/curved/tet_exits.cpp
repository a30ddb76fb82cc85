#include <algorithm>
#include <cmath>

#include <curved/tet_exits.hpp>

namespace hexhex {

void TetExits::enter(const LatticeTet& corners) noexcept {
  corner0_ = corners[0];
  size_ = 0;
  std::array<Vec3, 3> edges;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      edges[i][k] = static_cast<double>(corners[i + 1][k] - corner0_[k]) * perUnit_;
      size_ = std::max(size_, std::abs(edges[i][k]));
    }
  }
  volume_ = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t m = k == 2 ? 0 : k + 1;
    const std::size_t n = k == 0 ? 2 : k - 1;
    const double of1 = edges[1][m] * edges[2][n] - edges[1][n] * edges[2][m];
    const double of2 = edges[2][m] * edges[0][n] - edges[2][n] * edges[0][m];
    const double of3 = edges[0][m] * edges[1][n] - edges[0][n] * edges[1][m];
    gradient_[k] = {Pair{-(of1 + of2 + of3), of1}, Pair{of2, of3}};
    volume_ += edges[0][k] * of1;
  }
  const double cube = size_ * size_ * size_;
  // Twice the bounds. Of tets so flat that weights might not tell where they are, nothing is sure.
  constexpr double kLeastVolume = 0x1p-8;
  leastWeight_ = volume_ > kLeastVolume * cube ? 0x1p-31 * cube : kInfinity;
  placeError_ = 0x1p-34 * size_;
  reach_ = 2.5 * size_;
}

void TetExits::turn(int axis) noexcept {
  constexpr Pair kZero = {0, 0};
  constexpr Pair kAll = {kInfinity, kInfinity};
  axis_ = static_cast<std::size_t>(axis);
  slopes_ = gradient_[axis_];
  const double leastSlope = 0x1p-8 * size_ * size_;
  const Pair least = {leastSlope, leastSlope};
  for (std::size_t i = 0; i < 2; ++i) {
    const Pair slope = i == 0 ? slopes_.of01 : slopes_.of23;
    const PairMask falls = slope < -least;
    const PairMask rises = slope > least;
    toZero_[i] = chosen(falls | rises, Pair{-1, -1} / slope, kZero);
    ahead_[i] = chosen(falls, kZero, kAll);
    behind_[i] = chosen(rises, kZero, kAll);
  }
}

TetExits::Weights TetExits::atMiddle(const GridPoint& begin) const noexcept {
  Weights weights = {Pair{volume_, 0}, Pair{0, 0}};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int64_t point = begin[k] * unit_ + (k == axis_ ? unit_ / 2 : 0);
    weights = weights.plus(gradient_[k], static_cast<double>(point - corner0_[k]) * perUnit_);
  }
  return weights;
}

}  // namespace hexhex
