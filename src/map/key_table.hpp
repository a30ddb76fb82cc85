// A small hash table for things that are collected anew for every vertex.
#pragma once

#include <cstddef>
#include <vector>

#include <hexhex/types.hpp>

namespace hexhex {

/// Numbers keys (tets, vertices) in the order in which they come. Emptied in no time.
class KeyTable {
 public:
  KeyTable() : slots_(kInitialSlots, Slot{kNone, kNone}) {}

  void clear() noexcept { keys_.clear(); }
  [[nodiscard]] std::size_t size() const noexcept { return keys_.size(); }

  /// The number of a key; it is size() - 1 afterwards if the key is new.
  Index insert(Index key) {
    Slot& slot = slots_[find(key)];
    if (!isEmpty(slot)) return slot.number;
    slot = {key, static_cast<Index>(keys_.size())};
    keys_.push_back(key);
    if (2 * keys_.size() > slots_.size()) grow();
    return static_cast<Index>(keys_.size() - 1);
  }

  /// The number of a key that is in the table.
  [[nodiscard]] Index operator[](Index key) const noexcept { return slots_[find(key)].number; }

 private:
  static constexpr std::size_t kInitialSlots = 256;

  struct Slot {
    Index key;
    Index number;
  };

  /// A slot that was filled before the last clear() does not agree with `keys_` (or happens to be
  /// right), so that nothing needs to be wiped.
  [[nodiscard]] bool isEmpty(const Slot& slot) const noexcept {
    return slot.number >= keys_.size() || keys_[slot.number] != slot.key;
  }

  /// The slot of a key, or the one that it would get.
  [[nodiscard]] std::size_t find(Index key) const noexcept {
    const std::size_t mask = slots_.size() - 1;
    // The upper bits of a product with an odd constant near 2^32 / golden ratio spread well.
    std::size_t i = (key * 0x9e3779b9U >> 8) & mask;
    while (!isEmpty(slots_[i]) && slots_[i].key != key) i = (i + 1) & mask;
    return i;
  }

  void grow() {
    slots_.assign(2 * slots_.size(), Slot{kNone, kNone});
    for (std::size_t number = 0; number < keys_.size(); ++number) {
      slots_[find(keys_[number])] = {keys_[number], static_cast<Index>(number)};
    }
  }

  std::vector<Slot> slots_;
  std::vector<Index> keys_;
};

}  // namespace hexhex
