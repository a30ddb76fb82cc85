// The sparse voxel grid of the atlas: for every lattice point of every chart the hex vertex there,
// in bricks of 8 x 8 x 8 points behind a hash table.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <deque>
#include <limits>
#include <mutex>
#include <span>
#include <thread>
#include <utility>
#include <vector>

#include <hexhex/types.hpp>

#include <atlas/bricks.hpp>
#include <atlas/cut_cells.hpp>
#include <base/parallel.hpp>

namespace hexhex::atlas {

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
  /// What stands for bricks that do not exist: no vertices, no cuts.
  [[nodiscard]] static const Brick& none() {
    static const Brick brick = [] {
      Brick empty;
      empty.clear();
      return empty;
    }();
    return brick;
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
    if (CutCells* const cuts = known.load(std::memory_order_acquire)) return *cuts;
    const std::lock_guard lock(cutsMutex_);
    if (CutCells* const cuts = known.load(std::memory_order_acquire)) return *cuts;
    CutCells& made = cuts_.emplace_back();
    known.store(&made, std::memory_order_release);
    return made;
  }

 private:
  struct Slot {
    BrickKey key;
    Brick<Id>* brick;
  };

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
  std::deque<CutCells> cuts_;
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
  [[nodiscard]] Brick<Id>* find(Index chart, const lattice::ChartPoint& c) noexcept {
    const BrickKey key = brickKey(chart, c);
    Entry& entry = entries_[recentBrick(c)];
    if (entry.key != key) entry = {key, grid_.find(key)};
    return entry.brick;
  }
  /// The same, or Brick::none().
  [[nodiscard]] const Brick<Id>& at(Index chart, const lattice::ChartPoint& c) noexcept {
    const Brick<Id>* const brick = find(chart, c);
    return brick != nullptr ? *brick : Brick<Id>::none();
  }
  /// What the grid shows at a point of a chart.
  [[nodiscard]] Id idAt(Index chart, const lattice::ChartPoint& c) noexcept {
    return at(chart, c).ids[placeInBrick(c)];
  }

 private:
  struct Entry {
    BrickKey key;
    Brick<Id>* brick;
  };
  const BrickGrid<Id>& grid_;
  std::array<Entry, kRecentBricks> entries_;
};

}  // namespace hexhex::atlas
