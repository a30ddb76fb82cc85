// The sparse voxel grid of the atlas: the hex vertex at every lattice point of every chart, in
// bricks of 8 x 8 x 8 points behind a hash table; and the cuts recorded for cells.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <cstddef>
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

#include <base/parallel.hpp>
#include <lattice/cell_corners.hpp>
#include <lattice/gauge.hpp>

namespace hexhex::atlas {

/// The points of one tet's sweep in its chart: a gauge, prepared for many points.
class SweepFrame {
 public:
  SweepFrame(const lattice::Gauge& gauge, const std::array<std::uint8_t, 3>& axes) noexcept
      : origin_(gauge.translation) {
    for (std::uint8_t k = 0; k < 3; ++k) {
      directions_[k] = gauge.rotation(lattice::direction(axes[k], 1));
      const auto axis = static_cast<std::size_t>(lattice::axisOf(directions_[k]));
      source_[axis] = k;
      sign_[axis] = lattice::signOf(directions_[k]) > 0 ? 1U : ~0U;
    }
  }
  [[nodiscard]] lattice::ChartPoint operator()(std::int32_t level, std::int32_t row,
                                               std::int32_t point) const noexcept {
    const lattice::ChartPoint swept = {static_cast<std::uint32_t>(level),
                                       static_cast<std::uint32_t>(row),
                                       static_cast<std::uint32_t>(point)};
    lattice::ChartPoint c;
    for (std::size_t k = 0; k < 3; ++k) c[k] = origin_[k] + sign_[k] * swept[source_[k]];
    return c;
  }
  /// The direction of a sweep axis in the chart.
  [[nodiscard]] lattice::Direction along(std::size_t axis) const noexcept {
    return directions_[axis];
  }

 private:
  lattice::ChartPoint origin_;
  std::array<lattice::Direction, 3> directions_{};
  std::array<std::uint8_t, 3> source_{};  ///< per axis of the chart: the sweep axis behind it
  std::array<std::uint32_t, 3> sign_{};   ///< 1 or -1
};

/// Points along each side of a brick, and in all of it.
inline constexpr std::uint32_t kBrickSide = 8;
inline constexpr std::size_t kBrickPoints = std::size_t{kBrickSide} * kBrickSide * kBrickSide;

/// Names a brick: chart and brick coordinates, modulo 2^16 each. Charts and places that coincide
/// modulo 2^16 overlap, nothing worse (see lattice/gauge.hpp). The bits that coordinates lose
/// change the chart; otherwise tets longer than 2^19 grid units would overlap themselves.
using BrickKey = std::uint64_t;
inline constexpr BrickKey kNoBrick = std::numeric_limits<BrickKey>::max();

[[nodiscard]] constexpr BrickKey brickKey(Index chart, const lattice::ChartPoint& c) noexcept {
  const auto part = [](std::uint32_t value) { return std::uint64_t{value & 0xffffU}; };
  const std::uint32_t sheet = chart ^ c[0] >> 17 ^ c[1] >> 15;  // and c[2] >> 19
  const BrickKey key = (std::uint64_t{sheet} << 48 ^ std::uint64_t{c[2] / kBrickSide} << 32) |
                       part(c[1] / kBrickSide) << 16 | part(c[0] / kBrickSide);
  return key == kNoBrick ? 0 : key;
}
[[nodiscard]] constexpr std::size_t placeInBrick(const lattice::ChartPoint& c) noexcept {
  return (c[2] % kBrickSide * kBrickSide + c[1] % kBrickSide) * kBrickSide + c[0] % kBrickSide;
}

/// Offset from the place of a point to that of its neighbour in a direction, in the same brick.
[[nodiscard]] constexpr std::ptrdiff_t strideInBrick(lattice::Direction d) noexcept {
  constexpr std::array<std::ptrdiff_t, 3> kStrides = {1, kBrickSide, kBrickSide * kBrickSide};
  return lattice::signOf(d) * kStrides[static_cast<std::size_t>(lattice::axisOf(d))];
}

/// A table of recently used bricks has one entry for all bricks whose coordinates agree modulo 8.
inline constexpr std::size_t kRecentBricks = 512;
[[nodiscard]] constexpr std::size_t recentBrick(const lattice::ChartPoint& c) noexcept {
  return (c[0] / kBrickSide % 8) | (c[1] / kBrickSide % 8) << 3 | (c[2] / kBrickSide % 8) << 6;
}

/// A straight row of points in a chart, in steps of one grid unit.
struct ChartRow {
  Index chart;
  lattice::ChartPoint start;
  lattice::Direction along;
  std::uint32_t count;

  /// Calls visit(point, offset, count, stride) for each part of the row within one brick: its first
  /// point, that point's offset in the row, the number of points, and the distance between their
  /// places.
  template <class Visit>
  void forEachPart(const Visit& visit) const {
    const auto axis = static_cast<std::size_t>(lattice::axisOf(along));
    const std::ptrdiff_t stride = strideInBrick(along);
    const bool forward = lattice::signOf(along) > 0;
    lattice::ChartPoint c = start;
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

// The cuts recorded for the cells of a brick.

/// Names a transition across a cut (CutTransitions).
using CutTransitionId = std::uint8_t;
/// No cut.
inline constexpr CutTransitionId kNoCut = 0;
/// Several cuts with different transitions, or a cut whose transition has no name.
inline constexpr CutTransitionId kAnyCuts = std::numeric_limits<CutTransitionId>::max();

/// The cuts that the half diagonals of a cell may meet: for each corner, in terms of the chart, the
/// transition across them. A cell records two different transitions: with one, whole extractions of
/// s17c_sphere_r0.1 take 6 % longer, of s17c_sphere_r10 5 %.
class alignas(4) CutCell {
 public:
  [[nodiscard]] constexpr bool isCut() const noexcept { return transitions_[0] != kNoCut; }
  /// The corners with a cut in front of them.
  [[nodiscard]] constexpr lattice::CellCornerSet corners() const noexcept {
    lattice::CellCornerSet all = 0;
    for (const std::uint8_t set : corners_) all |= set;
    return all;
  }
  /// The transition across all cuts in front of a corner: kNoCut if there are none, kAnyCuts if
  /// they have none in common.
  [[nodiscard]] constexpr CutTransitionId transition(std::size_t corner) const noexcept {
    CutTransitionId common = kNoCut;
    for (std::size_t i = 0; i < kMost; ++i) {
      if (((corners_[i] >> corner) & 1U) == 0) continue;
      common = common == kNoCut ? transitions_[i] : kAnyCuts;
    }
    return common;
  }

  /// The same, with one more cut in front of some corners.
  [[nodiscard]] constexpr CutCell with(lattice::CellCornerSet corners,
                                       CutTransitionId transition) const noexcept {
    CutCell after = *this;
    std::size_t i = 0;
    while (i < kMost && transitions_[i] != kNoCut && transitions_[i] != transition) ++i;
    if (i == kMost) {
      // Forget which transition was last.
      i = kMost - 1;
      transition = kAnyCuts;
    }
    after.transitions_[i] = transition;
    after.corners_[i] = static_cast<std::uint8_t>(corners_[i] | corners);
    return after;
  }

  [[nodiscard]] constexpr bool operator==(const CutCell&) const = default;

 private:
  static constexpr std::size_t kMost = 2;

  std::array<std::uint8_t, kMost> corners_{};
  std::array<CutTransitionId, kMost> transitions_{};  ///< from the first on, then kNoCut
};

/// The cells of a brick, named by their smallest corners.
struct CutCells {
  std::array<CutCell, kBrickPoints> cells{};

  /// Adds a cut face to a cell. Thread-safe.
  void add(std::size_t place, lattice::CellCornerSet corners, CutTransitionId transition) noexcept {
    const std::atomic_ref cell(cells[place]);
    CutCell before = cell.load(std::memory_order_relaxed);
    for (;;) {
      const CutCell after = before.with(corners, transition);
      if (after == before || cell.compare_exchange_weak(before, after, std::memory_order_relaxed)) {
        return;
      }
    }
  }
};

// The grid itself: the hex vertex at every lattice point of every chart, in bricks of 8 x 8 x 8
// points behind a hash table.

template <class Id>
struct Brick {
  /// No hex vertex is known at a point.
  static constexpr Id kEmpty = std::numeric_limits<Id>::max();
  /// Several hex vertices claim a point: the chart overlaps itself there.
  static constexpr Id kContested = kEmpty - 1;
  [[nodiscard]] static constexpr bool isVertex(Id id) noexcept { return id < kContested; }

  std::array<Id, kBrickPoints> ids;
  CutCells* cuts;           ///< null if no cut may meet any cell
  std::uint32_t contested;  ///< nonzero if two vertices claim one of the points
  std::uint32_t locked;     ///< nonzero while a thread changes the brick

  void clear() noexcept {
    ids.fill(kEmpty);
    cuts = nullptr;
    contested = 0;
    locked = 0;
  }
  /// Stands for bricks that do not exist: no vertices, no cuts.
  [[nodiscard]] static const Brick& none() {
    static const Brick brick = [] {
      Brick empty;
      empty.clear();
      return empty;
    }();
    return brick;
  }
};

/// Keeps other threads from a brick, for no longer than a few points take; atomic exchanges of all
/// these points would take longer.
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
    assert(next == count && 2 * used_ <= slots_.size());
    parallelFor(stage, count, 16, [&](std::size_t i) { bricks_[i].clear(); });
  }

  [[nodiscard]] Brick<Id>* find(BrickKey key) const noexcept {
    if (slots_.empty()) return nullptr;
    for (std::size_t i = home(key);; i = (i + 1) & mask_) {
      if (slots_[i].key == key) return slots_[i].brick;
      if (slots_[i].key == kNoBrick) return nullptr;
    }
  }

  /// The brick of a key; adds it if there is none. Not while other threads use the grid.
  Brick<Id>& add(BrickKey key) {
    assert(key != kNoBrick);
    if (Brick<Id>* const brick = find(key)) return *brick;
    if (2 * (used_ + 1) > slots_.size()) grow();
    Brick<Id>& brick = added_.emplace_back();
    brick.clear();
    place({key, &brick});
    ++used_;
    return brick;
  }

  /// The cuts recorded in a brick, allocated on first use. Thread-safe.
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
  /// At most half full, so that probes stay short.
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
    assert(key != kNoBrick);
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

/// Finds bricks without the hash table as long as accesses stay close together. One per thread.
template <class Id>
class BrickCache {
 public:
  explicit BrickCache(const BrickGrid<Id>& grid) : grid_(grid) {
    // All bits of kNoBrick are set; bricks are only read behind other keys.
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
