// A small hash table for things that are collected anew for every vertex.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <hexhex/types.hpp>

namespace hexhex {

/// Numbers keys (tets, vertices) in the order in which they come. Emptied in no time, and made so
/// that nothing in it is for the processor to guess: whether a key is new is as good as random.
class KeyTable {
 public:
  KeyTable() : slots_(kInitialSlots) {}

  void clear() {
    size_ = 0;
    if (++generation_ != 0) return;
    // All numbers have been used: slots of long ago would look fresh.
    std::fill(slots_.begin(), slots_.end(), Slot{});
    generation_ = 1;
  }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }

  /// The number of a key, which is the former size() if the key is new.
  Index insert(Index key) {
    if (2 * size_ >= slots_.size()) grow();
    Slot& slot = slots_[find(key)];
    const std::uint64_t tag = tagOf(key);
    const bool isNew = slot.tag != tag;
    const Index number = isNew ? size_ : slot.number;
    slot = {tag, number};
    size_ += isNew ? 1 : 0;
    return number;
  }

 private:
  /// Many more than the tets or edges at nearly all vertices, so that keys hardly ever collide.
  static constexpr std::size_t kInitialSlots = 512;

  struct Slot {
    std::uint64_t tag = 0;  ///< generation and key; the slot is empty in all other generations
    Index number = 0;
  };

  [[nodiscard]] std::uint64_t tagOf(Index key) const noexcept {
    return (std::uint64_t{generation_} << 32) | key;
  }

  /// The slot of a key, or the one that it would get.
  [[nodiscard]] std::size_t find(Index key) const noexcept {
    const std::uint64_t tag = tagOf(key);
    const std::size_t mask = slots_.size() - 1;
    // The upper bits of a product with an odd constant near 2^32 / golden ratio spread well.
    std::size_t i = ((key * 0x9e3779b9U) >> 12) & mask;
    while (static_cast<unsigned>(slots_[i].tag != tag) &
           static_cast<unsigned>((slots_[i].tag >> 32) == generation_)) {
      i = (i + 1) & mask;
    }
    return i;
  }

  void grow() {
    std::vector<Slot> old(2 * slots_.size());
    old.swap(slots_);
    for (const Slot& slot : old) {
      if ((slot.tag >> 32) == generation_) slots_[find(static_cast<Index>(slot.tag))] = slot;
    }
  }

  std::vector<Slot> slots_;
  std::uint32_t generation_ = 1;
  Index size_ = 0;
};

}  // namespace hexhex
