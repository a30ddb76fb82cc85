// Projections onto convex sets (Kaczmarz 1937, Agmon 1954): each gap is closed in turn by the least
// moves of the corners of its quad, until all are short enough.
#include <algorithm>
#include <cmath>

#include <base/vector3.hpp>
#include <improve/closing.hpp>

namespace hexhex::improvement {

namespace {

constexpr int kRounds = 30;
/// Gaps next to held vertices would move other corners far: the sum of squares of the weights of
/// those that can move must exceed this.
constexpr double kLeastWeight = 0.05;

}  // namespace

Array<Vec3> closingMoves(std::span<const Gap> gaps, std::span<const Quad> quads,
                         std::span<const std::uint8_t> isHeld, double limit) {
  Array<Vec3> moves(isHeld.size(), Vec3{});
  bool isOpen = true;
  for (int round = 0; round < kRounds && isOpen; ++round) {
    isOpen = false;
    for (const Gap& gap : gaps) {
      const double size = length(gap.way);
      const Vec3 direction = times(1 / size, gap.way);
      double left = size;
      double squares = 0;
      for (std::size_t i = 0; i < 4; ++i) {
        const Index v = quads[gap.quad][i];
        left -= gap.weights[i] * dot(moves[v], direction);
        if (isHeld[v] == 0) squares += gap.weights[i] * gap.weights[i];
      }
      if (std::abs(left) <= limit || squares < kLeastWeight) continue;
      isOpen = true;
      const double excess = left - std::copysign(limit, left);
      for (std::size_t i = 0; i < 4; ++i) {
        const Index v = quads[gap.quad][i];
        if (isHeld[v] != 0) continue;
        moves[v] = plus(moves[v], times(gap.weights[i] * excess / squares, direction));
      }
    }
  }
  for (Vec3& move : moves) {
    const double size = length(move);
    if (size > limit) move = times(limit / size, move);
  }
  return moves;
}

}  // namespace hexhex::improvement
