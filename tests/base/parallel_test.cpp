// withThreads() itself; what loops compute is tested where they are used.
#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <support/status_bytes.hpp>

#include <base/parallel.hpp>

namespace hexhex {
namespace {

#if defined(__linux__)
// Each call used to leave some seven kilobytes behind.
TEST(WithThreads, LeavesNoMemoryBehind) {
  const auto call = [] {
    for (const int threads : {0, 1, 2, 5}) {
      withThreads(threads, [] {
        Context context;
        Stage stage(context, "loop");
        std::atomic<std::size_t> sum{0};
        parallelFor(stage, 1000, 10, [&](std::size_t i) { sum += i; });
        EXPECT_EQ(sum.load(), 999U * 1000 / 2);
      });
    }
  };
  for (int i = 0; i < 100; ++i) call();
  const std::size_t before = test::statusBytes("VmRSS:");
  ASSERT_GT(before, 0U);
  for (int i = 0; i < 2000; ++i) call();
  EXPECT_LT(test::statusBytes("VmRSS:"), before + (8 << 20));
}
#endif

TEST(CollectFromBlocks, KeepsTheOrderOfBlocks) {
  for (const std::size_t n : {std::size_t{0}, std::size_t{7}, std::size_t{1000}}) {
    withThreads(2, [&] {
      Context context;
      Stage stage(context, "loop");
      const auto odd = collectFromBlocks<std::size_t>(
          stage, n, 10, [](std::size_t begin, std::size_t end, std::vector<std::size_t>& list) {
            for (std::size_t i = begin; i < end; ++i) {
              if (i % 2 != 0) list.push_back(i);
            }
          });
      ASSERT_EQ(odd.size(), n / 2);
      for (std::size_t i = 0; i < odd.size(); ++i) EXPECT_EQ(odd[i], 2 * i + 1);
    });
  }
}

TEST(WithThreads, NestsAndGivesBackAfterExceptions) {
  for (int i = 0; i < 3; ++i) {
    EXPECT_THROW(withThreads(2,
                             [] {
                               withThreads(1, [] {
                                 EXPECT_EQ(currentThreads(), 1);
                                 throw std::runtime_error("end");
                               });
                             }),
                 std::runtime_error);
  }
  withThreads(2, [] { EXPECT_EQ(currentThreads(), effectiveThreads(2)); });
}

// Calls from several threads with one thread each run beside each other, not one after the other:
// each waits here until all have arrived.
TEST(WithThreads, CallersDoNotWaitForEachOther) {
  constexpr int kCallers = 4;
  std::atomic<int> arrived{0};
  std::vector<std::thread> callers;
  callers.reserve(kCallers);
  for (int i = 0; i < kCallers; ++i) {
    callers.emplace_back([&] {
      withThreads(1, [&] {
        arrived.fetch_add(1);
        while (arrived.load() < kCallers) std::this_thread::yield();
      });
    });
  }
  for (std::thread& caller : callers) caller.join();
  EXPECT_EQ(arrived.load(), kCallers);
}

TEST(ExclusiveScan, RefusesTotalsThatDoNotFit) {
  std::vector<std::uint32_t> counts = {0x7fffffff, 0x80000000, 0};
  EXPECT_EQ(exclusiveScan(std::span(counts)), 0xffffffffU);
  EXPECT_EQ(counts, (std::vector<std::uint32_t>{0, 0x7fffffff, 0xffffffff}));
  counts = {0x7fffffff, 0x80000001, 0};
  EXPECT_THROW(exclusiveScan(std::span(counts)), Error);
}

}  // namespace
}  // namespace hexhex
