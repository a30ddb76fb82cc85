// Which tets contain a point in space? A tree of bounding boxes over the tets, sorted along a
// space-filling curve. Unlike a grid, it takes linear memory whatever the sizes of the tets.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex {

/// An axis-parallel box.
struct Box {
  Vec3 lower;
  Vec3 upper;
  [[nodiscard]] bool contains(const Vec3& p) const noexcept {
    return lower[0] <= p[0] && p[0] <= upper[0] && lower[1] <= p[1] && p[1] <= upper[1] &&
           lower[2] <= p[2] && p[2] <= upper[2];
  }
};

/// Finds tets around points. 64 bytes per tet.
class TetLocator {
 public:
  /// How much larger than a tet its box is: these shares of its longest side and of its largest
  /// absolute coordinate.
  struct Margin {
    double ofSize = 0;
    double ofCoordinates = 0;
  };

  /// What rounding can do to the smallest numbers.
  static constexpr double kLeastMargin = 0x1p-1064;

  /// @param map  with indices in range and finite points
  TetLocator(const TetMapView& map, Margin margin, Stage& stage);

  /// Calls accept(tet) for the tets whose enlarged box contains p, until it returns true; returns
  /// whether it did. Thread-safe; the order of tets depends on the map alone.
  template <class Accept>
  [[nodiscard]] bool anyAround(const Vec3& p, const Accept& accept) const {
    return !order_.empty() && anyBelow(levelBegins_.size() - 2, 0, p, accept);
  }

 private:
  /// Children per box: keeps the tree shallow and its boxes few (a third of the number of tets).
  static constexpr std::size_t kFan = 4;

  void sortTets(const TetMapView& map, Stage& stage);
  void fillTetBoxes(const TetMapView& map, Margin margin, Stage& stage);
  void fillLevel(std::size_t level, Stage& stage);

  template <class Accept>
  bool anyBelow(std::size_t level, std::size_t node, const Vec3& p, const Accept& accept) const {
    if (!boxes_[levelBegins_[level] + node].contains(p)) return false;
    if (level == 0) return accept(order_[node]);
    const std::size_t childCount = levelBegins_[level] - levelBegins_[level - 1];
    const std::size_t end = std::min(childCount, (node + 1) * kFan);
    for (std::size_t child = node * kFan; child < end; ++child) {
      if (anyBelow(level - 1, child, p, accept)) return true;
    }
    return false;
  }

  Array<Index> order_;  ///< all tets, neighbours in space mostly near each other
  Array<Box> boxes_;    ///< level 0: one per entry of order_; higher levels: one per kFan below
  std::vector<std::size_t> levelBegins_;  ///< first box of each level, then the number of boxes
};

}  // namespace hexhex
