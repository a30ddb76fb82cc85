// Batches of blocks: every element comes once, in its place, for any number of blocks and threads.
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include <curved/batches.hpp>

namespace hexhex::test {

using namespace curved;

namespace {

/// Element i makes i % 3 numbers, all of them i.
Array<std::size_t> collectInBatches(std::size_t n, std::size_t grain, int threads) {
  Array<std::size_t> all;
  withThreads(threads, [&] {
    Context context;
    Stage stage(context, "batches");
    parallelBatches<std::vector<std::size_t>>(
        stage, n, grain,
        [&](std::size_t begin, std::size_t end, std::vector<std::size_t>& piece) {
          piece.clear();
          for (std::size_t i = begin; i < end; ++i) piece.insert(piece.end(), i % 3, i);
        },
        [&](const std::vector<std::size_t>& piece, std::size_t end) {
          const std::size_t position = all.size();
          lengthen(all, position + piece.size(), static_cast<double>(end) / 10007);
          return position;
        },
        [&](const std::vector<std::size_t>& piece, std::size_t position, std::size_t /*begin*/) {
          std::copy(piece.begin(), piece.end(),
                    all.begin() + static_cast<std::ptrdiff_t>(position));
        });
  });
  return all;
}

TEST(Batches, KeepTheOrder) {
  for (const std::size_t n : {0U, 1U, 5U, 640U, 641U, 10007U}) {
    Array<std::size_t> expected;
    for (std::size_t i = 0; i < n; ++i) expected.insert(expected.end(), i % 3, i);
    for (const std::size_t grain : {1U, 10U, 4096U}) {
      for (const int threads : {1, 2, 5}) {
        EXPECT_EQ(collectInBatches(n, grain, threads), expected) << n << " " << grain;
      }
    }
  }
}

TEST(Batches, AreOfSomeBlocksPerThread) {
  withThreads(1, [] {
    EXPECT_EQ(blocksPerBatch(0), 0U);
    EXPECT_EQ(blocksPerBatch(1000), 1U);
  });
  withThreads(2, [] {
    const bool alone = currentThreads() == 1;  // as in builds without oneTBB
    EXPECT_EQ(blocksPerBatch(3), alone ? 1U : 3U);
    EXPECT_EQ(blocksPerBatch(1000), alone ? 1U : 16U);
  });
}

TEST(Batches, BlocksFollowTheElements) {
  EXPECT_EQ(tetsPerBlock(0, 1000), 4096U);
  EXPECT_EQ(tetsPerBlock(256, 1000), 1000U);
  EXPECT_EQ(tetsPerBlock(1000000, 1000), 1U);
}

}  // namespace
}  // namespace hexhex::test
