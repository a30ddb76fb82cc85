// A box of a chart, copied out of its bricks: what one tet's cells need, in one small dense array.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

#include <atlas/brick_grid.hpp>

namespace hexhex {

template <class Id>
class BrickBlock {
 public:
  /// Copies the points from `low` on; bricks that do not exist count as empty and marked.
  /// @param size  number of points along each axis, at least 1
  void load(BrickCache<Id>& cache, Index chart, const ChartPoint& low,
            const std::array<std::uint32_t, 3>& size) {
    // Rows begin and end with those of bricks, so that they are copied eight points at a time.
    low_ = {low[0] / kBrickSide * kBrickSide, low[1], low[2]};
    bricksInRow_ = (low[0] % kBrickSide + size[0] - 1) / kBrickSide + 1;
    rows_ = size[1];
    const std::size_t rowBricks = std::size_t{bricksInRow_} * size[1] * size[2];
    if (marks_.size() < rowBricks) {
      marks_.resize(rowBricks);
      ids_.resize(rowBricks * kBrickSide);
    }
    anyMarked_ = false;
    for (std::uint32_t z = 0; z < size[2];) {
      const std::uint32_t depth = std::min(size[2] - z, roomInBrick(low[2] + z));
      for (std::uint32_t y = 0; y < size[1];) {
        const std::uint32_t height = std::min(size[1] - y, roomInBrick(low[1] + y));
        for (std::uint32_t x = 0; x < bricksInRow_; ++x) {
          copy(cache.find(chart, {low_[0] + x * kBrickSide, low[1] + y, low[2] + z}), x, y, height,
               z, depth);
        }
        y += height;
      }
      z += depth;
    }
  }

  /// Whether any cell with its smallest corner in the bricks of the box is marked.
  [[nodiscard]] bool anyMarked() const noexcept { return anyMarked_; }

  [[nodiscard]] std::size_t offset(const ChartPoint& c) const noexcept {
    const std::size_t row = std::size_t{c[2] - low_[2]} * rows_ + (c[1] - low_[1]);
    return row * bricksInRow_ * kBrickSide + (c[0] - low_[0]);
  }
  /// How far apart neighbours in a direction are.
  [[nodiscard]] std::ptrdiff_t stride(Direction d) const noexcept {
    const std::array<std::ptrdiff_t, 3> strides = {
        1, std::ptrdiff_t{bricksInRow_} * kBrickSide,
        std::ptrdiff_t{bricksInRow_} * kBrickSide * rows_};
    return signOf(d) * strides[static_cast<std::size_t>(axisOf(d))];
  }
  [[nodiscard]] const Id* ids() const noexcept { return ids_.data(); }
  [[nodiscard]] bool isMarked(std::size_t offset) const noexcept {
    return ((marks_[offset / kBrickSide] >> (offset % kBrickSide)) & 1U) != 0;
  }

 private:
  static std::uint32_t roomInBrick(std::uint32_t coordinate) noexcept {
    return kBrickSide - coordinate % kBrickSide;
  }
  void copy(const Brick<Id>* brick, std::uint32_t x, std::uint32_t y, std::uint32_t height,
            std::uint32_t z, std::uint32_t depth) noexcept {
    if (brick == nullptr || brick->hasMarks()) anyMarked_ = true;
    for (std::uint32_t k = z; k < z + depth; ++k) {
      std::size_t to = (std::size_t{k} * rows_ + y) * bricksInRow_ + x;
      std::size_t from =
          std::size_t{(low_[2] + k) % kBrickSide} * kBrickSide + (low_[1] + y) % kBrickSide;
      for (std::uint32_t j = 0; j < height; ++j, to += bricksInRow_, ++from) {
        if (brick == nullptr) {
          std::fill_n(ids_.data() + to * kBrickSide, kBrickSide, Brick<Id>::kEmpty);
          marks_[to] = 0xff;
        } else {
          std::memcpy(ids_.data() + to * kBrickSide, brick->ids.data() + from * kBrickSide,
                      kBrickSide * sizeof(Id));
          marks_[to] = brick->marksOfRow(from);
        }
      }
    }
  }

  ChartPoint low_{};
  std::uint32_t bricksInRow_ = 0;
  std::uint32_t rows_ = 0;
  bool anyMarked_ = false;
  std::vector<Id> ids_;
  std::vector<std::uint8_t> marks_;  ///< a bit per point, a byte per row of a brick
};

}  // namespace hexhex
