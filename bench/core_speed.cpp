#include "core_speed.hpp"

#include <barrier>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <thread>
#include <vector>

namespace hexhex::bench {

namespace {

constexpr int kRounds = 1'000'000;
constexpr int kSumsAtATime = 8;  // more than a core has adders

/// Neither several additions at once nor all in advance.
void add(std::uint64_t& sum) {
  sum += 3;
  asm volatile("" : "+r"(sum));
}

/// Additions per nanosecond. Not inlined, so that sums are in registers wherever it is called.
[[gnu::noinline]] double speedOfThisThread() {
  std::uint64_t a = 0, b = 0, c = 0, d = 0, e = 0, f = 0, g = 0, h = 0;
  const auto begin = std::chrono::steady_clock::now();
  for (int round = 0; round < kRounds; ++round) {
    add(a), add(b), add(c), add(d), add(e), add(f), add(g), add(h);
  }
  const std::chrono::duration<double, std::nano> time = std::chrono::steady_clock::now() - begin;
  return static_cast<double>(kSumsAtATime) * kRounds / time.count();
}

}  // namespace

double additionsPerNanosecond(int threads) {
  std::vector<double> speeds(static_cast<std::size_t>(threads));
  std::barrier together(threads);
  std::vector<std::thread> others;
  for (std::size_t i = 1; i < speeds.size(); ++i) {
    others.emplace_back([&, i] {
      together.arrive_and_wait();
      speeds[i] = speedOfThisThread();
    });
  }
  together.arrive_and_wait();
  speeds[0] = speedOfThisThread();
  for (std::thread& other : others) other.join();
  return std::accumulate(speeds.begin(), speeds.end(), 0.0) / static_cast<double>(threads);
}

}  // namespace hexhex::bench
