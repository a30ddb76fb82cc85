// A small hash table for things that are collected anew at every vertex.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <hexhex/types.hpp>

namespace hexhex::adjacency {

/// Numbers keys (tets, vertices) in order of insertion. Cleared in no time, and written without
/// branches, which the processor could not predict: whether a key is new follows no pattern. With
/// branches here and in tet_faces.cpp, an extraction of s17c_sphere_r0.1 takes 8 % longer.
class KeyTable {
  struct Slot {
    std::uint64_t tag = 0;  ///< generation and key; the slot is empty in all other generations
    Index number = 0;
  };

 public:
  KeyTable() : slots_(kInitialSlots) {}

  void clear() {
    size_ = 0;
    if (++generation_ != 0) return;
    // All generations have been used: old slots would look fresh.
    std::fill(slots_.begin(), slots_.end(), Slot{});
    generation_ = 1;
  }

  [[nodiscard]] std::size_t size() const noexcept { return size_; }

  /// The number of a key; it is the former size() if the key is new.
  Index insert(Index key) {
    makeRoom(size_ + 1);
    const Index number = numberer()(key, size_);
    size_ += number == size_ ? 1 : 0;
    return number;
  }

  /// Does the work, as an object that a loop can keep in registers. The caller counts the keys;
  /// size() does not notice them.
  class Numberer {
   public:
    /// The number of a key: `size` if it is new. There must be room.
    Index operator()(Index key, Index size) const noexcept {
      const std::uint64_t tag = generation_ | key;
      Slot& slot = *find(slots_, shift_, tag);
      // By arithmetic, as the compiler would turn a condition into a branch.
      const Index isKnown = slot.tag == tag ? 1 : 0;
      const Index number = size ^ ((slot.number ^ size) & (0 - isKnown));
      slot = {tag, number};
      return number;
    }

   private:
    friend class KeyTable;
    Numberer(Slot* slots, int shift, std::uint64_t generation)
        : slots_(slots), shift_(shift), generation_(generation) {}
    Slot* slots_;
    int shift_;
    std::uint64_t generation_;  ///< in the upper half
  };

  /// To be renewed after makeRoom().
  [[nodiscard]] Numberer numberer() noexcept {
    return {slots_.data(), shift_, std::uint64_t{generation_} << 32};
  }

  [[nodiscard]] bool hasRoom(std::size_t size) const noexcept { return 2 * size <= slots_.size(); }

  /// Makes room for this many keys.
  void makeRoom(std::size_t size) {
    while (!hasRoom(size)) grow();
  }

 private:
  /// Far more than the tets or edges at nearly all vertices, so that keys hardly ever collide.
  static constexpr std::size_t kInitialSlots = 512;
  static constexpr int kInitialShift = 23;  ///< 2^(32 - 23) slots

  /// The slot of a key, or the one it would get.
  [[nodiscard]] static Slot* find(Slot* slots, int shift, std::uint64_t tag) noexcept {
    const std::size_t mask = 0xffffffffU >> shift;
    // The upper bits of a product with an odd constant near 2^32 / golden ratio spread well.
    std::size_t i = (static_cast<std::uint32_t>(tag) * 0x9e3779b9U) >> shift;
    // While the slot is of this generation, but has another key: one comparison, as two would make
    // a branch.
    while ((slots[i].tag ^ tag) - 1 < 0xffffffffU) i = (i + 1) & mask;
    return &slots[i];
  }

  void grow() {
    Array<Slot> old(2 * slots_.size());
    old.swap(slots_);
    --shift_;
    for (const Slot& slot : old) {
      if ((slot.tag >> 32) == generation_) *find(slots_.data(), shift_, slot.tag) = slot;
    }
  }

  Array<Slot> slots_;
  int shift_ = kInitialShift;
  std::uint32_t generation_ = 1;
  Index size_ = 0;
};

}  // namespace hexhex::adjacency
