#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

namespace hexhex::test {

/// Splitmix64 (Steele, Lea, Flood 2014): the same numbers on every machine.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15U;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31U);
  }
  /// Uniform in [0, n), up to a bias that does not matter here.
  std::size_t below(std::size_t n) { return next() % n; }
  bool oneIn(std::uint64_t n) { return next() % n == 0; }
  /// In [low, high].
  std::int64_t between(std::int64_t low, std::int64_t high) {
    const std::uint64_t count = static_cast<std::uint64_t>(high) - static_cast<std::uint64_t>(low);
    return low + static_cast<std::int64_t>(next() % (count + 1));
  }
  /// In [0, 1).
  double real() { return static_cast<double>(next() >> 11U) * 0x1p-53; }
  /// Any finite double, each bit pattern equally likely.
  double anyDouble() {
    while (true) {
      const auto value = std::bit_cast<double>(next());
      if (value - value == 0) return value;
    }
  }

 private:
  std::uint64_t state_;
};

}  // namespace hexhex::test
