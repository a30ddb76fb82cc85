// A small random number generator with the same output on every machine (the distributions of the
// standard library differ between implementations).
#pragma once

#include <cstdint>

namespace hexhex {

/// SplitMix64 (Steele, Lea, Flood, "Fast splittable pseudorandom number generators", 2014).
class Random {
 public:
  /// Different purposes of one seed get independent streams.
  Random(std::uint64_t seed, std::uint64_t purpose) : state_(seed) {
    state_ = next() ^ (purpose * 0xD1B54A32D192ED03ULL);
  }

  std::uint64_t next() {
    state_ += 0x9E3779B97F4A7C15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31);
  }

  /// Uniform in [0, count). The bias of the remainder is below count / 2^64.
  std::uint64_t below(std::uint64_t count) { return next() % count; }

  /// Uniform integer in [-limit, limit].
  std::int64_t integerUpTo(std::int64_t limit) {
    return static_cast<std::int64_t>(below(2 * static_cast<std::uint64_t>(limit) + 1)) - limit;
  }

  /// Uniform in [0, 1), a multiple of 2^-53.
  double share() { return static_cast<double>(next() >> 11) * 0x1p-53; }

  /// Uniform in [-limit, limit).
  double realUpTo(double limit) { return (2 * share() - 1) * limit; }

 private:
  std::uint64_t state_;
};

}  // namespace hexhex
