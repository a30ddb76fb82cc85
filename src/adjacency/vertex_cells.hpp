// The cells around each vertex of a hex mesh: the one table from which faces and edges follow.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex {

/// Cells that have a vertex as a corner, in ascending order. A cell is listed once for each corner
/// that has the vertex, so a cell with repeated vertices is listed repeatedly. 32 bytes per cell
/// plus 8 per vertex.
class VertexCells {
 public:
  /// @throws Error InvalidArgument for a corner that is not a vertex of the mesh; TooLarge for
  ///         2^32 - 1 cells or more
  VertexCells(const HexMesh& mesh, Stage& stage);

  [[nodiscard]] std::size_t vertexCount() const noexcept { return ends_.size() - 1; }
  [[nodiscard]] std::span<const Index> around(std::size_t vertex) const noexcept {
    return {cells_.data() + ends_[vertex], cells_.data() + ends_[vertex + 1]};
  }

 private:
  Array<std::uint64_t> ends_;  ///< entry v + 1 is one past the cells of vertex v
  Array<Index> cells_;
};

/// The first cell with a corner that is not a vertex of the mesh, or the number of cells.
[[nodiscard]] std::size_t firstCellOutOfRange(const HexMesh& mesh, Stage& stage);

/// @throws Error InvalidArgument, with the first cell, if a corner is not a vertex of the mesh
void requireCornersInRange(const HexMesh& mesh, Stage& stage);

}  // namespace hexhex
