// What parallel loops lend their blocks.
#include <atomic>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include <base/workspaces.hpp>

namespace hexhex {
namespace {

/// Cannot be copied or moved, like some workspaces.
struct Counter {
  Counter() = default;
  Counter(const Counter&) = delete;
  Counter& operator=(const Counter&) = delete;

  std::atomic<int> users{0};
  std::size_t elements = 0;  ///< that passed; not atomic, as there is one user at a time
};

TEST(Workspaces, AreLentToOneAtATime) {
  constexpr std::size_t kElements = 20000;
  for (const int threads : {1, 2, 5}) {
    Workspaces<Counter> workspaces;
    std::atomic<int> made{0};
    withThreads(threads, [&] {
      Context context;
      Stage stage(context, "loop");
      parallelBlocks(stage, kElements, 7, [&](std::size_t begin, std::size_t end, std::size_t) {
        const auto make = [&made] {
          ++made;
          return Counter();
        };
        workspaces.with(make, [&](Counter& counter) {
          EXPECT_EQ(counter.users.fetch_add(1), 0);
          counter.elements += end - begin;
          counter.users.fetch_sub(1);
        });
      });
    });
    EXPECT_GE(made.load(), 1);
    EXPECT_LE(made.load(), threads);
    std::size_t elements = 0;
    int seen = 0;
    workspaces.forEach([&](const Counter& counter) {
      elements += counter.elements;
      ++seen;
    });
    EXPECT_EQ(elements, kElements);
    EXPECT_EQ(seen, made.load());
  }
}

TEST(Workspaces, ComeBackUnlessAnExceptionInterruptsThem) {
  Workspaces<std::vector<int>> workspaces;
  int made = 0;
  const auto make = [&made] {
    ++made;
    return std::vector<int>();
  };
  const auto use = [&](bool fail) {
    workspaces.with(make, [fail](std::vector<int>& workspace) {
      workspace.push_back(7);
      if (fail) throw std::runtime_error("end");
    });
  };
  const auto next = [&] {
    std::vector<int> found;
    workspaces.with(make, [&found](const std::vector<int>& workspace) { found = workspace; });
    return found;
  };
  use(false);
  EXPECT_EQ(next(), std::vector<int>{7});
  EXPECT_EQ(made, 1);
  EXPECT_THROW(use(true), std::runtime_error);
  EXPECT_TRUE(next().empty());
  EXPECT_EQ(made, 2);
  // While an exception that has nothing to do with it is on its way, all is as ever.
  struct Cleanup {
    decltype(use)& useNow;
    ~Cleanup() { useNow(false); }
  };
  EXPECT_THROW(
      {
        const Cleanup cleanup{use};
        throw std::runtime_error("elsewhere");
      },
      std::runtime_error);
  EXPECT_EQ(next(), std::vector<int>{7});
  EXPECT_EQ(made, 2);
}

TEST(Workspaces, LoopsSeeEveryElementOnce) {
  for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{1000}}) {
    std::vector<std::atomic<int>> visits(n);
    withThreads(2, [&] {
      Context context;
      Stage stage(context, "loop");
      const auto make = [] { return std::vector<std::size_t>(); };
      parallelBlocksWith(stage, n, 10, make,
                         [&](std::size_t begin, std::size_t end, std::size_t block,
                             std::vector<std::size_t>& list) {
                           EXPECT_EQ(begin, 10 * block);
                           list.clear();
                           for (std::size_t i = begin; i < end; ++i) list.push_back(i);
                           for (const std::size_t i : list) ++visits[i];
                         });
      parallelForWith(stage, n, 10, make, [&](std::size_t i, std::vector<std::size_t>& list) {
        list.assign(1, i);
        ++visits[list.front()];
      });
    });
    for (const std::atomic<int>& count : visits) EXPECT_EQ(count.load(), 2);
  }
}

}  // namespace
}  // namespace hexhex
