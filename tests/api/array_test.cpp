// The arrays of results: whoever gets one may keep, pass on or free its memory.
#include <cstddef>
#include <memory>
#include <numeric>
#include <span>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/hexhex.hpp>

namespace hexhex {
namespace {

/// Small ones, in shared pages and in pages of their own.
constexpr std::size_t kSizes[] = {1, 1000, 100'000, 3'000'000};

Array<Index> countTo(std::size_t n) {
  Array<Index> array(n);
  std::iota(array.begin(), array.end(), Index{0});
  return array;
}

TEST(Array, IsMovedWithItsMemory) {
  HexMesh mesh = extract(generateSample(SampleKind::Box).map);
  const Vec3* const memory = mesh.points.data();
  const Array<Vec3> points = std::move(mesh.points);
  EXPECT_EQ(points.data(), memory);
  EXPECT_TRUE(mesh.points.empty());  // NOLINT(bugprone-use-after-move): what is left is empty
}

TEST(Array, IsSeenAsASpan) {
  Array<Index> array = countTo(5);
  const std::span<Index> writable(array);
  writable[0] = 7;
  const std::span<const Index> span = array;
  EXPECT_EQ(span.data(), array.data());
  EXPECT_EQ(span.size(), 5U);
  EXPECT_EQ(span[0], 7U);
  const std::vector<Index> copy(array.begin(), array.end());
  EXPECT_EQ(copy, (std::vector<Index>{7, 1, 2, 3, 4}));
}

TEST(Array, ReleasesItsMemoryToAnOwner) {
  for (const std::size_t n : kSizes) {
    Array<Index> array = countTo(n);
    const Index* const memory = array.data();
    auto owner = array.release();
    EXPECT_EQ(owner.get(), memory);
    EXPECT_TRUE(array.empty());
    EXPECT_EQ(array.capacity(), 0U);
    array = countTo(3);  // and may be used again
    EXPECT_EQ(owner[n - 1], n - 1);
    auto moved = std::move(owner);
    EXPECT_EQ(moved.get(), memory);
    EXPECT_EQ(moved[n - 1], n - 1);
    moved.reset();
    EXPECT_EQ(moved, nullptr);
  }
  EXPECT_EQ(Array<Index>().release(), nullptr);
}

TEST(Array, IsFreedBySharedOwnersInOtherThreads) {
  for (const std::size_t n : kSizes) {
    std::shared_ptr<Index[]> owner = countTo(n).release();
    std::thread last([other = std::move(owner), n]() mutable {
      EXPECT_EQ(other.get()[n - 1], n - 1);
      other.reset();
    });
    last.join();
  }
}

// Its interface is that of std::vector, without telling from where it has its memory.
TEST(Array, IsUsedLikeAVector) {
  static_assert(!std::is_convertible_v<Array<Index>*, std::vector<Index>*>);
  static_assert(std::is_nothrow_move_constructible_v<Array<Index>>);
  Array<Index> array = {3, 1};
  array.push_back(4);
  array.insert(array.begin() + 1, {1, 5});
  EXPECT_EQ(array, (Array<Index>{3, 1, 5, 1, 4}));
  array.erase(array.begin());
  array.pop_back();
  EXPECT_EQ(array.front() + array.back() + array.at(1), 7U);
  array.assign(2, 9);
  Array<Index> other(std::size_t{1}, 8);
  array.swap(other);
  EXPECT_EQ(array, Array<Index>{8});
  EXPECT_EQ(other, (Array<Index>{9, 9}));
  EXPECT_LT(array, other);
  other = {1, 2, 3};
  other.resize(4, 0);
  EXPECT_EQ(other, (Array<Index>{1, 2, 3, 0}));
  EXPECT_THROW(array.reserve(array.max_size() + 1), std::exception);
}

}  // namespace
}  // namespace hexhex
