// Pseudo-random numbers that are the same on every machine, and how many cases the tests draw.
#pragma once

#include <algorithm>
#include <cstdint>

#include <lattice/direction.hpp>
#include <lattice/tet_geometry.hpp>

#include "support/effort.hpp"

namespace hexhex::testing {

using namespace lattice;

/// splitmix64 (Steele, Lea, Flood 2014).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() {
    std::uint64_t x = state_ += 0x9e3779b97f4a7c15U;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
    return x ^ (x >> 31);
  }
  /// Uniform in [low, high], up to a bias that does not matter here.
  std::int64_t between(std::int64_t low, std::int64_t high) {
    const std::uint64_t count = static_cast<std::uint64_t>(high) - static_cast<std::uint64_t>(low);
    return low + static_cast<std::int64_t>(bits() % (count + 1));
  }
  std::size_t index(std::size_t count) { return static_cast<std::size_t>(bits() % count); }
  bool oneIn(std::uint64_t n) { return bits() % n == 0; }

  LatticePoint point(std::int64_t low, std::int64_t high) {
    return {between(low, high), between(low, high), between(low, high)};
  }
  Direction anyDirection() { return static_cast<Direction>(index(kDirections)); }
  Direction perpendicularTo(Direction d) {
    return direction((axisOf(d) + 1 + static_cast<int>(index(2))) % 3, oneIn(2) ? 1 : -1);
  }

 private:
  std::uint64_t state_;
};

using test::cases;

}  // namespace hexhex::testing
