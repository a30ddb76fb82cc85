// Groups of vertices that move at the same time: no two of a group share a cell, so that the result
// does not depend on threads.
#pragma once

#include <span>
#include <vector>

#include <hexhex/types.hpp>

#include <improve/cell_points.hpp>

namespace hexhex {

class Colours {
 public:
  /// @param vertices  ascending
  Colours(const CellPoints& mesh, std::span<const Index> vertices);

  [[nodiscard]] std::size_t count() const noexcept { return ends_.size(); }
  /// Ascending.
  [[nodiscard]] std::span<const Index> of(std::size_t colour) const noexcept {
    const std::size_t begin = colour == 0 ? 0 : ends_[colour - 1];
    return std::span(vertices_).subspan(begin, ends_[colour] - begin);
  }

 private:
  std::vector<Index> vertices_;  ///< by colour
  std::vector<std::size_t> ends_;
};

}  // namespace hexhex
