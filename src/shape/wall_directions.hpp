// The directions of a polygon's edges, given what each costs where.
#pragma once

#include <array>
#include <limits>
#include <vector>

namespace hexhex::shape {

/// A closed row of columns. Each faces one of four directions, numbered counterclockwise.
struct WallDirections {
  std::vector<int> ofColumns;
  double cost = std::numeric_limits<double>::infinity();  ///< if there are none
};

/// The cheapest directions that turn by so many right angles to the left, all in all; from a column
/// to the next by one at most.
/// @param costs  per column and direction
/// @param turns  4 or -4
[[nodiscard]] WallDirections cheapestDirections(const std::vector<std::array<double, 4>>& costs,
                                                int turns, double costOfCorner);

}  // namespace hexhex::shape
