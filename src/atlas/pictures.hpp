// The pictures in which the way from the centre of a cell to one of its corners may end.
#pragma once

#include <array>
#include <cstddef>

#include <atlas/brick_grid.hpp>
#include <atlas/jumps.hpp>

namespace hexhex {

/// Follows all cuts that the way may meet, whichever of them it does meet.
template <class Id>
class Pictures {
 public:
  Pictures(const Jumps& jumps, BrickCache<Id>& cache) : jumps_(jumps), cache_(cache) {}

  /// @param chart, cell  the cell's smallest corner, in the chart of its centre
  /// @param corner       in terms of that chart
  /// @return the only vertex that is shown at the corner in any of the pictures; kContested if
  /// there
  ///         are several or none, or if it is not known where a cut leads
  [[nodiscard]] Id vertexAt(Index chart, const ChartPoint& cell, std::size_t corner) {
    count_ = 0;
    add(chart, cell, corner);
    Id found = Brick<Id>::kContested;
    for (std::size_t i = 0; i < count_; ++i) {
      const Picture& picture = pictures_[i];
      const Brick<Id>* const brick = cache_.find(picture.chart, picture.cell);
      if (brick == nullptr || brick->cuts == nullptr) return Brick<Id>::kContested;
      const Id shown = shownBy(picture);
      if (shown != Brick<Id>::kEmpty) {
        if (shown != found && found != Brick<Id>::kContested) return Brick<Id>::kContested;
        found = shown;
      }
      const CutCell& cut = brick->cuts->cells[placeInBrick(picture.cell)];
      for (const JumpId id : cut.jumps(picture.corner)) {
        if (id != kNoJump && !follow(id, picture)) return Brick<Id>::kContested;
      }
    }
    return found;
  }

 private:
  struct Picture {
    Index chart;
    ChartPoint cell;
    std::size_t corner;
  };

  void add(Index chart, const ChartPoint& cell, std::size_t corner) {
    pictures_[count_++] = {chart, cell, corner};
  }

  /// Adds the picture behind a cut, if it is new; false if that cannot be.
  [[nodiscard]] bool follow(JumpId id, Picture picture) {
    if (id == kManyJumps) return false;
    const Jump& jump = jumps_[id];
    const ChartPoint cell = jump.map.cell(picture.cell);
    const std::size_t corner = turnedCorner(jump.map.rotation, picture.corner);
    for (std::size_t i = 0; i < count_; ++i) {
      const Picture& known = pictures_[i];
      if (known.chart == jump.to && known.cell == cell && known.corner == corner) return true;
    }
    if (count_ == kMost) return false;
    add(jump.to, cell, corner);
    return true;
  }

  [[nodiscard]] Id shownBy(const Picture& picture) {
    const ChartPoint point = plus(picture.cell, kCellCorners[picture.corner]);
    const Brick<Id>* const brick = cache_.find(picture.chart, point);
    return brick == nullptr ? Brick<Id>::kEmpty : brick->ids[placeInBrick(point)];
  }

  /// Around a singular edge of valence n there are n pictures.
  static constexpr std::size_t kMost = 12;

  const Jumps& jumps_;
  BrickCache<Id>& cache_;
  std::array<Picture, kMost> pictures_;
  std::size_t count_ = 0;
};

}  // namespace hexhex
