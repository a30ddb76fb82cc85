// Pseudo-random numbers that are the same on every machine, and how many cases the tests draw.
#pragma once

#include <algorithm>
#include <cstdint>

#include <lattice/direction.hpp>
#include <lattice/tet_geometry.hpp>

#include "support/effort.hpp"
#include "support/random.hpp"

namespace hexhex::testing {

using namespace lattice;

class LatticeRandom : public test::Random {
 public:
  using Random::Random;

  LatticePoint point(std::int64_t low, std::int64_t high) {
    return {between(low, high), between(low, high), between(low, high)};
  }
  Direction anyDirection() { return static_cast<Direction>(below(kDirections)); }
  Direction perpendicularTo(Direction d) {
    return direction((axisOf(d) + 1 + static_cast<int>(below(2))) % 3, oneIn(2) ? 1 : -1);
  }
};

using test::cases;

}  // namespace hexhex::testing
