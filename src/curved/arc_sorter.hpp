// The order of the arcs that belong to one tet.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <curved/edge_replay.hpp>
#include <curved/element_numbers.hpp>

#include <hexhex/types.hpp>

#include <lattice/half_box.hpp>
#include <lattice/rasterize.hpp>

namespace hexhex {

/// An arc among those of all blocks.
struct ArcPlace {
  Index block;
  Index number;
};

/// Sorts the arcs of a tet: by axis, then in the order in which the tet is swept for midpoints.
class ArcSorter {
 public:
  void enter(const LatticeTet& corners, std::int64_t unit) {
    const HalfBox box(corners, unit);
    const HalfGridSet grids = box.grids();
    size_ = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const HalfGrid grid = ElementNumbers::midpointsOf(ElementKind::Edges, static_cast<int>(axis));
      if ((grids & halfGridBit(grid)) == 0) continue;
      const GridBox points = box.of(grid);
      Grid& g = grids_[axis];
      g.axes = chooseSweepAxes(points)();
      g.begin = size_;
      std::uint64_t size = 1;
      for (std::size_t k = 0; k < 3; ++k) {
        const GridRange& range = points.range[g.axes[k]];
        g.first[k] = range.first;
        g.size[k] = static_cast<std::uint64_t>(range.last - range.first) + 1;
        size *= std::min(g.size[k], kMost);
      }
      size_ = std::min(size_ + size, kMost);
    }
  }
  /// @param keyOf  of an arc
  template <class KeyOf>
  void sort(std::span<ArcPlace> arcs, const KeyOf& keyOf) {
    unsorted_.assign(arcs.begin(), arcs.end());
    if (size_ >= kMost) {
      std::sort(arcs.begin(), arcs.end(), [&](const ArcPlace& a, const ArcPlace& b) {
        return longPlace(keyOf(a)) < longPlace(keyOf(b));
      });
      return;
    }
    order_.clear();
    for (const ArcPlace& arc : arcs) {
      order_.push_back(place(keyOf(arc)) << 32 | static_cast<std::uint64_t>(order_.size()));
    }
    if (size_ <= kRoom * arcs.size()) {
      sortByRank(arcs);
    } else {
      sortByComparison(arcs);
    }
  }

 private:
  static constexpr std::uint64_t kMost = std::uint64_t{1} << 31;
  /// Points per arc that are worth a bit each: tets fill a sixth of their box, if they are not
  /// thin.
  static constexpr std::uint64_t kRoom = 64;

  /// Where a point stands among those of all boxes, if these are less than kMost.
  [[nodiscard]] std::uint64_t place(const EdgeKey& key) const noexcept {
    const Grid& g = grids_[static_cast<std::size_t>(key.axis)];
    const auto at = [&](std::size_t k) {
      return static_cast<std::uint64_t>(key.z[g.axes[k]] - g.first[k]);
    };
    return g.begin + (at(0) * g.size[1] + at(1)) * g.size[2] + at(2);
  }
  /// The same in two numbers, whatever the boxes.
  [[nodiscard]] std::array<std::uint64_t, 2> longPlace(const EdgeKey& key) const noexcept {
    const Grid& g = grids_[static_cast<std::size_t>(key.axis)];
    const auto at = [&](std::size_t k) {
      return static_cast<std::uint64_t>(std::int64_t{key.z[g.axes[k]]} - g.first[k]);
    };
    return {static_cast<std::uint64_t>(key.axis) << 32 | at(0), at(1) << 32 | at(2)};
  }
  /// By counting the points before, of those that are midpoints of the arcs.
  void sortByRank(std::span<ArcPlace> arcs) {
    words_.assign(size_ / 64 + 1, {});
    for (const std::uint64_t entry : order_) words_[entry >> 38].bits |= bit(entry);
    Index before = 0;
    for (Word& word : words_) {
      word.before = before;
      before += static_cast<Index>(std::popcount(word.bits));
    }
    for (const std::uint64_t entry : order_) {
      const Word& word = words_[entry >> 38];
      const int inWord = std::popcount(word.bits & (bit(entry) - 1));
      arcs[word.before + static_cast<Index>(inWord)] = unsorted_[static_cast<Index>(entry)];
    }
  }
  /// Of the place in an entry of order_.
  [[nodiscard]] static std::uint64_t bit(std::uint64_t entry) noexcept {
    return std::uint64_t{1} << ((entry >> 32) % 64);
  }
  void sortByComparison(std::span<ArcPlace> arcs) {
    std::sort(order_.begin(), order_.end());
    for (std::size_t i = 0; i < arcs.size(); ++i) {
      arcs[i] = unsorted_[static_cast<Index>(order_[i])];
    }
  }

  /// The midpoints in the box of a tet of edges along an axis.
  struct Grid {
    std::array<std::uint8_t, 3> axes{};   ///< of the sweep
    std::array<std::int32_t, 3> first{};  ///< by sweep axis
    std::array<std::uint64_t, 3> size{};
    std::uint64_t begin = 0;  ///< its points among those of all axes
  };
  std::array<Grid, 3> grids_;
  std::uint64_t size_ = 0;  ///< points of all boxes; kMost if there are more
  std::vector<ArcPlace> unsorted_;
  std::vector<std::uint64_t> order_;  ///< a place, and whose it is
  struct Word {
    std::uint64_t bits = 0;  ///< of 64 places
    Index before = 0;        ///< how many are set in the words before
  };
  std::vector<Word> words_;
};

}  // namespace hexhex
