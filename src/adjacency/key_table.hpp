// A small hash table for things that are collected anew for every vertex.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <hexhex/types.hpp>

namespace hexhex {

/// Numbers keys (tets, vertices, pairs of vertices) in the order in which they come. Keeps its
/// memory, and is emptied in no time.
template <class Key = Index>
class KeyTable {
 public:
  void clear() {
    size_ = 0;
    if (++generation_ != 0) return;
    // All numbers have been used: slots of long ago would look fresh.
    std::fill(slots_.begin(), slots_.end(), Slot{});
    generation_ = 1;
  }

  [[nodiscard]] std::size_t size() const noexcept { return size_; }

  /// The number of a key, which is the former size() if the key is new.
  Index insert(Key key) {
    Slot& slot = slotOf(key);
    if (slot.generation == generation_) return slot.number;
    const Index number = size_++;
    slot = {key, generation_, number};
    if (2 * std::size_t{size_} > mask_) grow();
    return number;
  }

 private:
  struct Slot {
    Key key = 0;
    std::uint32_t generation = 0;  ///< the slot is empty in all others
    Index number = 0;
  };
  /// Many more than the tets or edges at nearly all vertices, so that keys hardly ever collide.
  static constexpr int kInitialBits = 9;

  /// The slot of a key, or the one that it would get.
  [[nodiscard]] Slot& slotOf(Key key) noexcept {
    // The upper bits of a product with an odd constant near 2^64 / golden ratio spread well.
    std::size_t i = (std::uint64_t{key} * 0x9e3779b97f4a7c15U) >> shift_;
    while (slots_[i].generation == generation_ && slots_[i].key != key) {
      i = (i + 1) & mask_;
    }
    return slots_[i];
  }

  void grow() {
    Array<Slot> old(2 * slots_.size());
    old.swap(slots_);
    --shift_;
    mask_ = 2 * mask_ + 1;
    for (const Slot& slot : old) {
      if (slot.generation == generation_) slotOf(slot.key) = slot;
    }
  }

  Array<Slot> slots_ = Array<Slot>(std::size_t{1} << kInitialBits);
  std::size_t mask_ = (std::size_t{1} << kInitialBits) - 1;  ///< one less than slots
  int shift_ = 64 - kInitialBits;
  std::uint32_t generation_ = 1;
  Index size_ = 0;
};

}  // namespace hexhex
