#include <array>
#include <deque>

#include <shape/chart_moves.hpp>

namespace hexhex::shape {
namespace {

class BorderMoves {
 public:
  BorderMoves(const Surface& surface, std::vector<Index>& chartOf, CostOfTriangle ofTriangle,
              CostOfSide ofSide)
      : surface_(surface), chartOf_(chartOf), ofTriangle_(ofTriangle), ofSide_(ofSide) {}

  void run(Context& context) {
    constexpr double kLeastGain = 1e-9;
    constexpr std::size_t kMostPerTriangle = 200;
    const std::size_t count = surface_.triangleCount();
    std::deque<Index> queue;
    std::vector<bool> isQueued(count, true);
    for (Index t = 0; t < count; ++t) queue.push_back(t);
    for (std::size_t left = kMostPerTriangle * count; left > 0 && !queue.empty(); --left) {
      if (left % count == 0) context.throwIfCancelled();
      const Index t = queue.front();
      queue.pop_front();
      isQueued[t] = false;
      Index best = kNone;
      double most = kLeastGain;
      for (Side side = 3 * t; side < 3 * t + 3; ++side) {
        const Index chart = chartOf_[surface_.beyond(side)];
        if (chart == chartOf_[t] || !deforms(t, chart)) continue;
        const double gain = costOf(t, chartOf_[t]) - costOf(t, chart);
        if (gain > most) most = gain, best = chart;
      }
      if (best == kNone) continue;
      chartOf_[t] = best;
      for (Side first = 3 * t; first < 3 * t + 3; ++first) {
        surface_.forEachSideAround(first, [&](Side side) {
          const Index beside = Surface::triangleOf(side);
          if (!isQueued[beside]) queue.push_back(beside);
          isQueued[beside] = true;
        });
      }
    }
  }

 private:
  /// The number of borders at the tail of a side.
  [[nodiscard]] int bordersAt(Side first) const {
    int count = 0;
    surface_.forEachSideAround(first, [&](Side side) {
      count += chartOf_[Surface::triangleOf(side)] != chartOf_[surface_.beyond(side)] ? 1 : 0;
    });
    return count;
  }

  [[nodiscard]] double costOf(Index t, Index chart) const {
    double cost = ofTriangle_(t, chart);
    for (Side side = 3 * t; side < 3 * t + 3; ++side) {
      const Index beyond = chartOf_[surface_.beyond(side)];
      if (beyond != chart) cost += ofSide_(side, chart, beyond);
    }
    return cost;
  }

  /// Whether giving a triangle to another chart only deforms both, and perhaps a third one.
  [[nodiscard]] bool deforms(Index t, Index chart) const {
    // Of the triangle's own chart something has to be left at one of its sides, and what it shares
    // with the other one has to be connected.
    for (Side side = 3 * t; side < 3 * t + 3; ++side) {
      const Side next = Surface::next(side);
      const Index here = chartOf_[surface_.beyond(side)];
      const Index there = chartOf_[surface_.beyond(next)];
      const Index rest = chartOf_[surface_.beyond(Surface::next(next))];
      // What is at the vertex between both sides, the tail of the second one.
      if (here == chartOf_[t] && there == chartOf_[t]) return rest == chart && bordersAt(next) == 0;
      if (here == chart && there == chart) return rest == chartOf_[t] && bordersAt(next) == 2;
    }
    // A corner moves along the border with a third chart, from the end beside the other chart to
    // that beside the triangle's own.
    for (Side side = 3 * t; side < 3 * t + 3; ++side) {
      const Index third = chartOf_[surface_.beyond(side)];
      if (third == chart || third == chartOf_[t]) continue;
      const Side next = Surface::next(side);
      const Index atHead = chartOf_[surface_.beyond(next)];
      const Index atTail = chartOf_[surface_.beyond(Surface::next(next))];
      if (atTail == chart && atHead == chartOf_[t])
        return bordersAt(side) == 3 && bordersAt(next) == 2;
      if (atHead == chart && atTail == chartOf_[t])
        return bordersAt(next) == 3 && bordersAt(side) == 2;
      return false;
    }
    return false;
  }

  const Surface& surface_;
  std::vector<Index>& chartOf_;
  CostOfTriangle ofTriangle_;
  CostOfSide ofSide_;
};

}  // namespace

void moveBorders(const Surface& surface, std::vector<Index>& chartOf, CostOfTriangle ofTriangle,
                 CostOfSide ofSide, Context& context) {
  BorderMoves(surface, chartOf, ofTriangle, ofSide).run(context);
}

}  // namespace hexhex::shape
