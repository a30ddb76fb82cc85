// Dynamic programming over columns; states are the right angles since the first column.
#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <utility>

#include <shape/wall_directions.hpp>

namespace hexhex::shape {
namespace {

constexpr int kMost = 12;  // right angles to one side
constexpr int kStates = 2 * kMost + 1;

int directionOf(int first, int state) { return (first + state + 3 * kMost) % 4; }

WallDirections directionsFrom(int first, const std::vector<std::array<double, 4>>& costs, int turns,
                              double costOfCorner) {
  struct State {
    double cost = std::numeric_limits<double>::infinity();
    int before = 0;
  };
  std::vector<std::array<State, kStates>> states(costs.size() + 1);
  states[0][kMost].cost = 0;
  for (std::size_t column = 0; column < costs.size(); ++column) {
    for (int from = 0; from < kStates; ++from) {
      const double here = states[column][static_cast<std::size_t>(from)].cost +
                          costs[column][static_cast<std::size_t>(directionOf(first, from))];
      for (int to = std::max(0, from - 1); to <= std::min(kStates - 1, from + 1); ++to) {
        State& next = states[column + 1][static_cast<std::size_t>(to)];
        const double cost = here + (to == from ? 0 : costOfCorner);
        if (cost < next.cost) next = {cost, from};
      }
    }
  }
  // The first column again, after all turns.
  int state = kMost + turns;
  WallDirections found;
  found.cost = states.back()[static_cast<std::size_t>(state)].cost;
  found.ofColumns.resize(costs.size());
  for (std::size_t column = costs.size(); column-- > 0;) {
    state = states[column + 1][static_cast<std::size_t>(state)].before;
    found.ofColumns[column] = directionOf(first, state);
  }
  return found;
}

}  // namespace

WallDirections cheapestDirections(const std::vector<std::array<double, 4>>& costs, int turns,
                                  double costOfCorner) {
  assert(std::abs(turns) == 4 && costs.size() >= 4);
  WallDirections best;
  for (int first = 0; first < 4; ++first) {
    WallDirections found = directionsFrom(first, costs, turns, costOfCorner);
    if (found.cost < best.cost) best = std::move(found);
  }
  return best;
}

}  // namespace hexhex::shape
