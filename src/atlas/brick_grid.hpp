// The sparse voxel grid of the atlas: for every lattice point of every chart the hex vertex there,
// in bricks of 8 x 8 x 8 points behind a hash table.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <deque>
#include <limits>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

#include <hexhex/types.hpp>

#include <atlas/cut_cells.hpp>
#include <atlas/gauge.hpp>
#include <base/parallel.hpp>

namespace hexhex {

/// Names a brick: chart and brick coordinates, modulo 2^16 each. Charts and places that the modulus
/// makes equal overlap, no more (see gauge.hpp).
using BrickKey = std::uint64_t;
inline constexpr BrickKey kNoBrick = std::numeric_limits<BrickKey>::max();

[[nodiscard]] constexpr BrickKey brickKey(Index chart, const ChartPoint& c) noexcept {
  const auto part = [](std::uint32_t value) { return std::uint64_t{value & 0xffffU}; };
  const BrickKey key = part(chart) << 48 | part(c[2] / kBrickSide) << 32 |
                       part(c[1] / kBrickSide) << 16 | part(c[0] / kBrickSide);
  return key == kNoBrick ? 0 : key;
}
[[nodiscard]] constexpr std::size_t placeInBrick(const ChartPoint& c) noexcept {
  return (c[2] % kBrickSide * kBrickSide + c[1] % kBrickSide) * kBrickSide + c[0] % kBrickSide;
}

/// From the place of a point to that of its neighbour in a direction, in the same brick.
[[nodiscard]] constexpr std::ptrdiff_t strideInBrick(Direction d) noexcept {
  constexpr std::array<std::ptrdiff_t, 3> kStrides = {1, kBrickSide, kBrickSide * kBrickSide};
  return signOf(d) * kStrides[static_cast<std::size_t>(axisOf(d))];
}

template <class Id>
struct Brick {
  /// No hex vertex is known at a point.
  static constexpr Id kEmpty = std::numeric_limits<Id>::max();
  /// Several hex vertices claim a point: the chart overlaps itself there.
  static constexpr Id kContested = kEmpty - 1;
  [[nodiscard]] static constexpr bool isVertex(Id id) noexcept { return id < kContested; }

  std::array<Id, kBrickPoints> ids;
  CutCells* cuts;           ///< null if no cut may meet any cell
  std::uint32_t contested;  ///< not 0 if two vertices claim one of the points
  std::uint32_t locked;     ///< not 0 while a thread changes the brick

  void clear() noexcept {
    ids.fill(kEmpty);
    cuts = nullptr;
    contested = 0;
    locked = 0;
  }
};

/// Keeps other threads from a brick, for no longer than a few points take: exchanges of all these
/// points would take longer.
template <class Id>
class BrickLock {
 public:
  explicit BrickLock(Brick<Id>& brick) noexcept : locked_(brick.locked) {
    while (locked_.exchange(1, std::memory_order_acquire) != 0) std::this_thread::yield();
  }
  ~BrickLock() { locked_.store(0, std::memory_order_release); }
  BrickLock(const BrickLock&) = delete;
  BrickLock& operator=(const BrickLock&) = delete;

 private:
  std::atomic_ref<std::uint32_t> locked_;
};

/// Bricks by key. Filled in two steps: build() from all threads' keys at once, then add() for
/// charts that come later.
template <class Id>
class BrickGrid {
 public:
  /// Allocates and clears one brick for each distinct key.
  void build(std::span<const std::vector<BrickKey>> blocks, Stage& stage) {
    std::size_t keys = 0;
    for (const std::vector<BrickKey>& block : blocks) keys += block.size();
    resizeTable(keys);
    parallelFor(stage, blocks.size(), 1, [&](std::size_t b) {
      for (const BrickKey key : blocks[b]) insertKey(key);
    });
    std::size_t count = 0;
    for (const Slot& slot : slots_) count += slot.key != kNoBrick ? 1 : 0;
    bricks_.resize(count);
    used_ = count;
    std::size_t next = 0;
    for (Slot& slot : slots_) {
      if (slot.key != kNoBrick) slot.brick = &bricks_[next++];
    }
    parallelFor(stage, count, 16, [&](std::size_t i) { bricks_[i].clear(); });
  }

  [[nodiscard]] Brick<Id>* find(BrickKey key) const noexcept {
    if (slots_.empty()) return nullptr;
    for (std::size_t i = home(key);; i = (i + 1) & mask_) {
      if (slots_[i].key == key) return slots_[i].brick;
      if (slots_[i].key == kNoBrick) return nullptr;
    }
  }

  /// The bricks with a point that two vertices claim.
  [[nodiscard]] std::vector<BrickKey> contested() const {
    std::vector<BrickKey> keys;
    for (const Slot& slot : slots_) {
      if (slot.key != kNoBrick && slot.brick->contested != 0) keys.push_back(slot.key);
    }
    return keys;
  }

  /// The brick of a key, added if there is none. Not while others use the grid.
  Brick<Id>& add(BrickKey key) {
    if (Brick<Id>* const brick = find(key)) return *brick;
    if (2 * (used_ + 1) > slots_.size()) grow();
    Brick<Id>& brick = added_.emplace_back();
    brick.clear();
    place({key, &brick});
    ++used_;
    return brick;
  }

  /// What is known of cuts in a brick, made when it is first asked for. Thread-safe.
  [[nodiscard]] CutCells& cutsOf(Brick<Id>& brick) {
    const std::atomic_ref known(brick.cuts);
    CutCells* const cuts = known.load(std::memory_order_acquire);
    return cuts != nullptr ? *cuts : makeCutsOf(brick);
  }

 private:
  struct Slot {
    BrickKey key;
    Brick<Id>* brick;
  };

  [[gnu::noinline]] CutCells& makeCutsOf(Brick<Id>& brick) {
    CutCells& made = takeCuts();
    made.clear();
    CutCells* known = nullptr;
    if (std::atomic_ref(brick.cuts)
            .compare_exchange_strong(known, &made, std::memory_order_acq_rel)) {
      return made;
    }
    giveBack(made);  // another thread was faster
    return *known;
  }
  [[nodiscard]] CutCells& takeCuts() {
    const std::lock_guard lock(cutsMutex_);
    if (unusedCuts_.empty()) {
      // In portions, so that it takes few calls and wastes little.
      constexpr std::size_t kMost = 64;
      cuts_.emplace_back(cuts_.empty() ? 16 : std::min(2 * cuts_.back().size(), kMost));
      for (CutCells& cuts : cuts_.back()) unusedCuts_.push_back(&cuts);
    }
    CutCells& taken = *unusedCuts_.back();
    unusedCuts_.pop_back();
    return taken;
  }
  void giveBack(CutCells& cuts) {
    const std::lock_guard lock(cutsMutex_);
    unusedCuts_.push_back(&cuts);
  }
  [[nodiscard]] std::size_t home(BrickKey key) const noexcept {
    return static_cast<std::size_t>((key * 0x9e3779b97f4a7c15U) >> shift_);
  }
  /// At most half full: probes stay short.
  void resizeTable(std::size_t keys) {
    std::size_t size = 64;
    shift_ = 58;
    while (size < 2 * keys) {
      size *= 2;
      --shift_;
    }
    mask_ = size - 1;
    slots_.assign(size, {kNoBrick, nullptr});
  }
  /// Thread-safe.
  void insertKey(BrickKey key) noexcept {
    for (std::size_t i = home(key);; i = (i + 1) & mask_) {
      const std::atomic_ref<BrickKey> slot(slots_[i].key);
      BrickKey found = slot.load(std::memory_order_relaxed);
      if (found == kNoBrick &&
          slot.compare_exchange_strong(found, key, std::memory_order_relaxed)) {
        return;
      }
      if (found == key) return;
    }
  }
  void place(const Slot& slot) noexcept {
    std::size_t i = home(slot.key);
    while (slots_[i].key != kNoBrick) i = (i + 1) & mask_;
    slots_[i] = slot;
  }
  void grow() {
    const std::vector<Slot> old = std::move(slots_);
    resizeTable(used_ + used_ / 2 + 64);
    for (const Slot& slot : old) {
      if (slot.key != kNoBrick) place(slot);
    }
  }

  std::vector<Slot> slots_;
  std::size_t mask_ = 0;
  int shift_ = 63;
  std::size_t used_ = 0;
  Array<Brick<Id>> bricks_;
  std::deque<Brick<Id>> added_;
  std::mutex cutsMutex_;
  std::vector<Array<CutCells>> cuts_;
  std::vector<CutCells*> unusedCuts_;
};

/// Finds bricks without the hash table while accesses stay close. One per thread.
template <class Id>
class BrickCache {
 public:
  explicit BrickCache(const BrickGrid<Id>& grid) : grid_(grid) {
    // All bits of kNoBrick are set; bricks are looked at behind other keys only.
    std::memset(entries_.data(), 0xff, sizeof entries_);
  }

  /// The brick that holds a point of a chart, or null.
  [[nodiscard]] Brick<Id>* find(Index chart, const ChartPoint& c) noexcept {
    const BrickKey key = brickKey(chart, c);
    Entry& entry = entries_[(c[0] / kBrickSide % 8) | (c[1] / kBrickSide % 8) << 3 |
                            (c[2] / kBrickSide % 8) << 6];
    if (entry.key != key) entry = {key, grid_.find(key)};
    return entry.brick;
  }

 private:
  struct Entry {
    BrickKey key;
    Brick<Id>* brick;
  };
  const BrickGrid<Id>& grid_;
  std::array<Entry, 512> entries_;
};

/// A straight row of points in a chart, in steps of one grid unit.
struct ChartRow {
  Index chart;
  ChartPoint start;
  Direction along;
  std::uint32_t count;

  /// Calls visit(point, offset, count, stride) for each part of the row within one brick: its first
  /// point, its offset in the row, its number of points, and the distance of their places.
  template <class Visit>
  void forEachPart(const Visit& visit) const {
    const auto axis = static_cast<std::size_t>(axisOf(along));
    const std::ptrdiff_t stride = strideInBrick(along);
    const bool forward = signOf(along) > 0;
    ChartPoint c = start;
    for (std::uint32_t offset = 0; offset < count;) {
      const std::uint32_t inBrick = c[axis] % kBrickSide;
      const std::uint32_t room = forward ? kBrickSide - inBrick : inBrick + 1;
      const std::uint32_t part = std::min(room, count - offset);
      visit(std::as_const(c), offset, part, stride);
      offset += part;
      c[axis] += forward ? part : 0U - part;
    }
  }
};

}  // namespace hexhex
