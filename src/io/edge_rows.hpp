// The edges of a vertex to larger vertices, in rows of eight places, which threads fill at the same
// time; pairs of them, which stand for faces, as bits of a word.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include <hexhex/types.hpp>

namespace hexhex {

inline constexpr std::size_t kRowPlaces = 8;
/// Larger vertices that edges lead to, in ascending order. Signed, since processors compare such
/// numbers at once.
using EdgeRow = std::array<std::int32_t, kRowPlaces>;
inline constexpr std::int32_t kFreePlace = std::numeric_limits<std::int32_t>::max();

/// The same while threads fill it: two places in each word, so that a look takes few steps.
using RowWords = std::array<std::uint64_t, kRowPlaces / 2>;
inline constexpr std::uint64_t kBothPlaces = 0x0000000100000001U;
inline constexpr std::uint64_t kFreeRowWord = kFreePlace * kBothPlaces;

/// Puts a vertex into a row unless it is there. Places are filled in order, each only once, so
/// that threads with the same vertex meet.
/// @param alone  no other thread is at work, so that nothing has to be exchanged at once, which
///               takes a processor much longer
/// @return false if there is no place
inline bool insertIntoRow(RowWords& words, std::uint64_t vertex, bool alone) {
  constexpr std::uint64_t kSigns = 0x80000000U * kBothPlaces;
  for (std::uint64_t& places : words) {
    const std::atomic_ref word(places);
    std::uint64_t before = word.load(std::memory_order_relaxed);
    for (;;) {
      // No number has a sign, so that one appears where 1 is taken from a place that is equal.
      const std::uint64_t equal = (before ^ (vertex * kBothPlaces)) - kBothPlaces;
      if ((equal & kSigns) != 0) return true;
      if (before >> 32U != kFreePlace) break;
      const unsigned shift = (before & kFreePlace) == kFreePlace ? 0 : 32;
      const std::uint64_t after = before ^ ((kFreePlace ^ vertex) << shift);
      if (alone) {
        word.store(after, std::memory_order_relaxed);
        return true;
      }
      if (word.compare_exchange_weak(before, after, std::memory_order_relaxed)) return true;
    }
  }
  return false;
}

/// A row that is filled.
[[nodiscard]] inline EdgeRow sortedRow(const RowWords& words) {
  EdgeRow row;
  for (std::size_t i = 0; i < kRowPlaces; ++i) {
    row[i] = static_cast<std::int32_t>(words[i / 2] >> (32 * (i % 2)) & kFreePlace);
  }
  // Few places are taken, so that this is quick: most rows have no more than four.
  const auto order = [&row](std::size_t i, std::size_t k) {
    const std::int32_t a = row[i];
    const std::int32_t b = row[k];
    row[i] = std::min(a, b);
    row[k] = std::max(a, b);
  };
  order(0, 1);
  order(2, 3);
  order(0, 2);
  order(1, 3);
  order(1, 2);
  for (std::size_t i = 4; i < kRowPlaces && row[i] != kFreePlace; ++i) {
    for (std::size_t k = i; k > 0 && row[k] < row[k - 1]; --k) std::swap(row[k], row[k - 1]);
  }
  return row;
}

/// Two places of a row, the first one smaller.
struct PlacePair {
  std::uint8_t first = 0;
  std::uint8_t second = 0;
};
inline constexpr std::size_t kRowPairs = kRowPlaces * (kRowPlaces - 1) / 2;

constexpr std::array<PlacePair, kRowPairs> makeRowPairs() {
  std::array<PlacePair, kRowPairs> pairs;
  std::size_t next = 0;
  for (std::uint8_t i = 0; i < kRowPlaces; ++i) {
    for (std::uint8_t j = i + 1; j < kRowPlaces; ++j) pairs[next++] = {i, j};
  }
  return pairs;
}
inline constexpr std::array<PlacePair, kRowPairs> kRowPairOf = makeRowPairs();

/// The number of a pair, with its places in either order.
constexpr std::array<std::uint8_t, kRowPlaces * kRowPlaces> makeRowPairNumbers() {
  std::array<std::uint8_t, kRowPlaces * kRowPlaces> numbers{};
  for (std::uint8_t pair = 0; pair < kRowPairs; ++pair) {
    const PlacePair& p = kRowPairOf[pair];
    numbers[p.first * kRowPlaces + p.second] = numbers[p.second * kRowPlaces + p.first] = pair;
  }
  return numbers;
}
inline constexpr std::array<std::uint8_t, kRowPlaces* kRowPlaces> kRowPairNumbers =
    makeRowPairNumbers();

/// The place of a vertex that a row has: how many entries are smaller.
[[nodiscard]] inline unsigned placeInRow(const EdgeRow& row, Index vertex) {
  const auto wanted = static_cast<std::int32_t>(vertex);
  std::int32_t smaller = 0;
  for (const std::int32_t end : row) smaller += end < wanted ? 1 : 0;
  return static_cast<unsigned>(smaller);
}

/// std::popcount() without a processor's instruction for it would be a call.
[[nodiscard]] inline unsigned countBits(std::uint32_t bits) {
  bits -= (bits >> 1U) & 0x55555555U;
  bits = (bits & 0x33333333U) + ((bits >> 2U) & 0x33333333U);
  return ((bits + (bits >> 4U)) & 0x0f0f0f0fU) * 0x01010101U >> 24U;
}

}  // namespace hexhex
