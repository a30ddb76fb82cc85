// The pool of pages for arrays of medium size.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <rapidcheck.h>
#include <span>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <support/status_bytes.hpp>

#include <hexhex/array.hpp>

#include <base/memory.hpp>

namespace hexhex {
namespace {

struct Block {
  std::span<std::uint32_t> words;
  std::uint32_t name = 0;

  [[nodiscard]] std::size_t bytes() const { return words.size_bytes(); }
  /// Whether all is as fill() left it.
  [[nodiscard]] bool isIntact() const {
    return std::ranges::all_of(words, [this](std::uint32_t word) { return word == name; });
  }
  void fill() const { std::ranges::fill(words, name); }
};

/// As many words as fit, all of them the block's name.
Block take(PagePool& pool, std::size_t bytes, std::uint32_t name) {
  void* const memory = pool.allocate(bytes);
  if (memory == nullptr) return {};
  const Block block{{static_cast<std::uint32_t*>(memory), bytes / 4}, name};
  block.fill();
  return block;
}

bool isPooling() {
  PagePool pool;
  void* const memory = pool.allocate(1);
  return memory != nullptr && pool.release(memory, 1);
}

// Blocks of all sizes, taken and given back in any order, never share a byte, and nothing is left.
TEST(PagePool, BlocksDoNotOverlap) {
  if (!isPooling()) GTEST_SKIP() << "no huge pages on this system";
  const bool passed = rc::check([] {
    PagePool pool;
    std::vector<Block> blocks;
    std::uint32_t name = 0;
    const auto giveBack = [&](std::size_t i) {
      RC_ASSERT(blocks[i].isIntact());
      RC_ASSERT(pool.release(blocks[i].words.data(), blocks[i].bytes()));
      blocks.erase(blocks.begin() + static_cast<std::ptrdiff_t>(i));
    };
    const int steps = *rc::gen::inRange(1, 60);
    for (int step = 0; step < steps; ++step) {
      if (!blocks.empty() && *rc::gen::inRange(0, 5) < 2) {
        giveBack(*rc::gen::inRange(std::size_t{0}, blocks.size()));
        continue;
      }
      // In words; some whole slabs, some that end on a page.
      const auto pages =
          *rc::gen::element<std::size_t>(1, 2, 63, 64, 65, 130, 512, 1030, 2047, 2048);
      const std::size_t bytes =
          pages * PagePool::kPage - 4 * *rc::gen::inRange<std::size_t>(0, 1024);
      const Block block = take(pool, bytes, ++name);
      RC_ASSERT(!block.words.empty());
      RC_ASSERT(reinterpret_cast<std::uintptr_t>(block.words.data()) % PagePool::kPage == 0);
      blocks.push_back(block);
    }
    while (!blocks.empty()) giveBack(blocks.size() - 1);
    RC_ASSERT(pool.slabCount() == 0);
  });
  EXPECT_TRUE(passed);
}

TEST(PagePool, FillsSlabsBeforeItMakesOthers) {
  if (!isPooling()) GTEST_SKIP() << "no huge pages on this system";
  PagePool pool;
  constexpr std::size_t kBytes = PagePool::kSlab / 64;
  std::vector<void*> blocks;
  for (int i = 0; i < 64; ++i) blocks.push_back(pool.allocate(kBytes));
  EXPECT_EQ(pool.slabCount(), 1);
  // What is given back is the next to be taken, be it the first, the last or in between.
  for (const std::size_t i : {0U, 31U, 63U}) {
    EXPECT_TRUE(pool.release(blocks[i], kBytes));
    EXPECT_EQ(pool.allocate(kBytes), blocks[i]);
  }
  void* const other = pool.allocate(1);
  EXPECT_EQ(pool.slabCount(), 2);
  EXPECT_TRUE(pool.release(other, 1));
  EXPECT_EQ(pool.slabCount(), 1);
  for (void* const block : blocks) EXPECT_TRUE(pool.release(block, kBytes));
  EXPECT_EQ(pool.slabCount(), 0);
}

TEST(PagePool, LeavesAloneWhatIsNotItsOwn) {
  PagePool pool;
  EXPECT_EQ(pool.allocate(PagePool::kSlab + 1), nullptr);
  int local = 0;
  EXPECT_FALSE(pool.release(&local, sizeof local));
  EXPECT_FALSE(pool.release(nullptr, 1));
}

TEST(PagePool, ServesThreads) {
  if (!isPooling()) GTEST_SKIP() << "no huge pages on this system";
  PagePool pool;
  std::vector<int> intact(4, 0);
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < intact.size(); ++t) {
    threads.emplace_back([&pool, &intact, t] {
      bool isIntact = true;
      for (std::size_t round = 0; round < 50; ++round) {
        const std::size_t bytes = PagePool::kPage * (1 + (round * 37 + t * 11) % 300);
        const Block first = take(pool, bytes, static_cast<std::uint32_t>(4 * round + t));
        const Block second = take(pool, bytes / 4 * 3, static_cast<std::uint32_t>(1000 + t));
        isIntact = isIntact && first.isIntact() && second.isIntact() &&
                   pool.release(first.words.data(), first.bytes()) &&
                   pool.release(second.words.data(), second.bytes());
      }
      intact[t] = isIntact ? 1 : 0;
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(intact, std::vector<int>(4, 1));
  EXPECT_EQ(pool.slabCount(), 0);
}

#if !defined(HEXHEX_SANITIZED)  // sanitizers keep freed arrays for a while
TEST(Memory, OfLargeArraysIsGivenBack) {
  const auto addressSpace = [] { return test::statusBytes("VmSize:"); };
  if (!isPooling() || addressSpace() == 0) GTEST_SKIP() << "no mapped arrays on this system";
  constexpr std::size_t kBytes = (std::size_t{1} << 28) + 1;
  const std::size_t before = addressSpace();
  for (int i = 0; i < 64; ++i) {
    void* const memory = detail::allocateArray(kBytes);
    EXPECT_GE(addressSpace(), before + kBytes);
    detail::freeArray(memory, kBytes);
  }
  EXPECT_LE(addressSpace(), before + kBytes);
}
#endif

}  // namespace
}  // namespace hexhex
