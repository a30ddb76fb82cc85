// Whether the system has threads to spare, and that they are there.
//
// oneTBB takes it for granted that threads can be started. If one cannot, because address space is
// limited or exhausted or there are too many threads, it throws where it cannot recover from that,
// or where the program ends. So whoever wants threads of it asks here first.
#pragma once

#include <atomic>

namespace hexhex {

/// How many more threads, up to `wanted`, can run at the same time, each with the memory that it
/// takes: found out by starting and ending them. Returns at least 0.
[[nodiscard]] int spareThreads(int wanted);

/// Threads that wait for each other, but not for ever.
class Gathering {
 public:
  explicit Gathering(int expected) : expected_(expected) {}
  /// Returns when all are here, or when there is no hope left that they come: other work may occupy
  /// them.
  void arriveAndWait();

 private:
  int expected_;
  std::atomic<int> arrived_{0};
};

}  // namespace hexhex
