// The grid points of every tet as lines: of the lattice (hex vertices), or of the lattice shifted
// by one half (cell centres). The same lists hold other data of tets.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <hexhex/types.hpp>

#include <base/parallel.hpp>
#include <lattice/tet_rasterizer.hpp>

namespace hexhex::sweep {

/// Tets per block.
inline constexpr std::size_t kSweepBlock = 256;

/// The items of a block of tets, one tet after the other.
template <class Item>
class BlockLists {
 public:
  /// @param keep  whether to keep the items of all tets, or only those of the last
  explicit BlockLists(bool keep) noexcept : keep_(keep) {}

  /// Begins a new block.
  void clear() noexcept {
    items_.clear();
    tets_ = 0;
  }
  /// Frees memory if there were many items, as each thread has such a list.
  void shrink() noexcept {
    constexpr std::size_t kFew = 1024;
    if (items_.capacity() > kFew) items_ = std::vector<Item>();
  }

  /// Begins the next tet. Its items are to be appended to the result.
  [[nodiscard]] std::vector<Item>& next() noexcept {
    assert(tets_ < kSweepBlock);
    if (!keep_) items_.clear();
    begins_[tets_++] = static_cast<Index>(items_.size());
    return items_;
  }
  /// The items of the last tet.
  [[nodiscard]] std::span<const Item> last() const noexcept {
    assert(tets_ > 0);
    return std::span(items_).subspan(begins_[tets_ - 1]);
  }
  [[nodiscard]] std::span<const Item> all() const noexcept { return items_; }
  [[nodiscard]] std::span<const Index> begins() const noexcept {
    return std::span(begins_).first(tets_);
  }

 private:
  bool keep_;
  std::vector<Item> items_;
  std::array<Index, kSweepBlock> begins_;
  std::size_t tets_ = 0;
};

/// The items of all tets, stored by block.
template <class Item>
class TetLists {
 public:
  /// @param tets  number of tets
  explicit TetLists(std::size_t tets)
      : itemBegin_(tets + blockCount(tets, kSweepBlock)), blocks_(blockCount(tets, kSweepBlock)) {}

  void store(std::size_t block, const BlockLists<Item>& items) {
    // Full, or the last one.
    assert(items.begins().size() == kSweepBlock || block + 1 == blocks_.size());
    blocks_[block].assign(items.all().begin(), items.all().end());
    const auto place = itemBegin_.begin() + static_cast<std::ptrdiff_t>(block * (kSweepBlock + 1));
    *std::copy(items.begins().begin(), items.begins().end(), place) =
        static_cast<Index>(items.all().size());
  }

  [[nodiscard]] bool areEmpty(Index tet) const noexcept {
    const std::size_t place = placeOf(tet);
    return itemBegin_[place] == itemBegin_[place + 1];
  }
  [[nodiscard]] std::span<const Item> of(Index tet) const noexcept {
    const std::size_t place = placeOf(tet);
    return std::span(blocks_[tet / kSweepBlock])
        .subspan(itemBegin_[place], itemBegin_[place + 1] - itemBegin_[place]);
  }
  /// Moves out the items of a block, one tet after the other.
  [[nodiscard]] Array<Item> takeBlock(std::size_t block) noexcept {
    return std::exchange(blocks_[block], {});
  }

 private:
  static std::size_t placeOf(Index tet) noexcept { return std::size_t{tet} + tet / kSweepBlock; }

  Array<Index> itemBegin_;  ///< per tet, within its block, and at the end of each block
  std::vector<Array<Item>> blocks_;
};

using BlockLines = BlockLists<lattice::SweptLine>;
using TetLines = TetLists<lattice::SweptLine>;

}  // namespace hexhex::sweep
