// A set of global vertex numbers that knows the rank of each: it converts global to local numbers.
//
// Numbers come in runs, so they are stored as bits in pages, about a fifth of a byte per vertex.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include <hexhex/types.hpp>

#include <base/parallel.hpp>
#include <base/sorted.hpp>

namespace hexhex::parts {

/// Whether each corner of a cell follows that of the cell before.
template <class Cell>
[[nodiscard]] bool follows(const Cell& cell, const Cell& before) noexcept {
  typename Cell::value_type differences = 0;
  for (std::size_t k = 0; k < 8; ++k) differences |= cell[k] ^ (before[k] + 1);
  return differences == 0;
}

class VertexSet {
 public:
  static constexpr std::uint64_t kPageBits = 1024;

  /// Finds pages without a search while numbers stay close. One per thread.
  class Cache {
   public:
    explicit Cache(const VertexSet& set) noexcept : set_(set) {}
    /// The rank of a number, or kNone if it is not in the set.
    [[nodiscard]] Index rank(std::uint64_t vertex) noexcept {
      if (!holds(vertex)) return kNone;
      const std::size_t bit = vertex % kPageBits;
      const Page& page = set_.pages_[look(vertex / kPageBits).page];
      const std::uint64_t below = page.bits[bit / 64] & ((std::uint64_t{1} << (bit % 64)) - 1);
      return page.before[bit / 64] + static_cast<Index>(std::popcount(below));
    }

    /// Whether any corner of a cell is in the set.
    template <class Cell>
    [[nodiscard]] bool holdsAny(const Cell& cell) noexcept {
      return std::any_of(cell.begin(), cell.end(),
                         [this](std::uint64_t vertex) { return holds(vertex); });
    }

   private:
    friend class VertexSet;
    [[nodiscard]] bool holds(std::uint64_t vertex) noexcept {
      const Entry& entry = look(vertex / kPageBits);
      if (entry.page == kNoPage) return false;
      const std::size_t bit = vertex % kPageBits;
      return (set_.pages_[entry.page].bits[bit / 64] >> (bit % 64) & 1U) != 0;
    }
    static constexpr std::size_t kNoPage = ~std::size_t{0};
    struct Entry {
      std::uint64_t key = ~std::uint64_t{0};
      std::size_t page = kNoPage;
    };
    const Entry& look(std::uint64_t key) noexcept {
      Entry& entry = entries_[key % entries_.size()];
      if (entry.key != key) entry = {key, set_.find(key)};
      return entry;
    }
    const VertexSet& set_;
    std::array<Entry, 64> entries_;
  };

  VertexSet() = default;
  /// The set of the corners of cells.
  template <class Cell>
  VertexSet(std::span<const Cell> cells, Stage& stage) {
    collectPages(cells, stage);
    parallelBlocks(stage, cells.size(), kGrain,
                   [&](std::size_t begin, std::size_t end, std::size_t) {
                     Cache cache(*this);
                     forEachRange(cells.subspan(begin, end - begin),
                                  [&](std::uint64_t first, std::uint64_t last) {
                                    for (; first <= last; first = enter(first, last, cache)) {
                                    }
                                  });
                   });
    count();
  }

  [[nodiscard]] std::uint64_t size() const noexcept { return size_; }

  /// All numbers, ascending.
  [[nodiscard]] Array<std::uint64_t> list() const {
    Array<std::uint64_t> all;
    all.reserve(size_);
    for (std::size_t p = 0; p < pages_.size(); ++p) {
      for (std::size_t w = 0; w < kWords; ++w) {
        for (std::uint64_t rest = pages_[p].bits[w]; rest != 0; rest &= rest - 1) {
          all.push_back(keys_[p] * kPageBits + w * 64 +
                        static_cast<std::uint64_t>(std::countr_zero(rest)));
        }
      }
    }
    return all;
  }

 private:
  static constexpr std::size_t kWords = kPageBits / 64;
  static constexpr std::size_t kGrain = 4096;
  struct Page {
    std::array<std::uint64_t, kWords> bits{};
    std::array<Index, kWords> before{};  ///< numbers in the set below each word
  };

  /// Calls visit(first, last) for ranges that make up all corners of cells. For consecutive cells
  /// on a line, each corner mostly follows that of the previous cell.
  template <class Cell, class Visit>
  static void forEachRange(std::span<const Cell> cells, const Visit& visit) {
    if (cells.empty()) return;
    Cell first = cells[0];
    Cell last = cells[0];
    for (const Cell& cell : cells.subspan(1)) {
      if (!follows(cell, last)) {
        for (std::size_t k = 0; k < 8; ++k) {
          if (cell[k] == last[k] + 1) continue;
          visit(first[k], last[k]);
          first[k] = cell[k];
        }
      }
      last = cell;
    }
    for (std::size_t k = 0; k < 8; ++k) visit(first[k], last[k]);
  }
  /// Enters the numbers that belong to one word. Thread-safe.
  /// @return the first number beyond
  [[nodiscard]] std::uint64_t enter(std::uint64_t first, std::uint64_t last, Cache& cache) {
    const std::uint64_t next = std::min(last, first | 63U) + 1;
    const std::size_t bit = first % 64;
    const std::uint64_t mask = (~std::uint64_t{0} >> (64 - (next - first))) << bit;
    Page& page = pages_[cache.look(first / kPageBits).page];
    const std::atomic_ref word(page.bits[first % kPageBits / 64]);
    if ((word.load(std::memory_order_relaxed) & mask) != mask) {
      word.fetch_or(mask, std::memory_order_relaxed);
    }
    return next;
  }
  template <class Cell>
  void collectPages(std::span<const Cell> cells, Stage& stage) {
    keys_ = collectFromBlocks<std::uint64_t>(
        stage, cells.size(), kGrain,
        [&](std::size_t begin, std::size_t end, std::vector<std::uint64_t>& keys) {
          std::array<std::uint64_t, 64> recent;
          recent.fill(~std::uint64_t{0});
          forEachRange(
              cells.subspan(begin, end - begin), [&](std::uint64_t first, std::uint64_t last) {
                for (std::uint64_t key = first / kPageBits; key <= last / kPageBits; ++key) {
                  if (recent[key % recent.size()] == key) continue;
                  recent[key % recent.size()] = key;
                  keys.push_back(key);
                }
              });
        });
    sortUnique(keys_);
    pages_.resize(keys_.size());
  }
  void count() {
    for (Page& page : pages_) {
      for (std::size_t w = 0; w < kWords; ++w) {
        page.before[w] = static_cast<Index>(size_);
        size_ += static_cast<std::uint64_t>(std::popcount(page.bits[w]));
      }
    }
  }
  [[nodiscard]] std::size_t find(std::uint64_t key) const noexcept {
    const auto found = std::lower_bound(keys_.begin(), keys_.end(), key);
    if (found == keys_.end() || *found != key) return ~std::size_t{0};
    return static_cast<std::size_t>(found - keys_.begin());
  }

  std::vector<std::uint64_t> keys_;  ///< ascending
  std::vector<Page> pages_;
  std::uint64_t size_ = 0;
};

}  // namespace hexhex::parts
