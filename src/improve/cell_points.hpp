// Cells as lists of points: of straight cells corners, of others all nodes.
#pragma once

#include <cstddef>
#include <span>

#include <adjacency/hex_topology.hpp>

#include <hexhex/types.hpp>

namespace hexhex::improvement {

struct CellPoints {
  std::span<const Index> all;  ///< those of cell 0, of cell 1, and so on
  std::size_t perCell = 8;
  const adjacency::VertexCells& around;  ///< the cells at each point
  std::size_t pointCount = 0;

  [[nodiscard]] std::size_t cellCount() const noexcept { return all.size() / perCell; }
  [[nodiscard]] std::span<const Index> of(std::size_t cell) const noexcept {
    return all.subspan(perCell * cell, perCell);
  }
};

}  // namespace hexhex::improvement
