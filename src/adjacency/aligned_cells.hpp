// Cells beside each other that number their corners alike, as most neighbours do in most meshes:
// one look-up finds each, wherever it stands in the mesh.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <hexhex/types.hpp>

#include <base/prefetch.hpp>
#include <base/stage.hpp>

namespace hexhex {

/// The corners of the faces 0, 2 and 4 of a cell, each with the corner of the cell before it that
/// is the same vertex if both number their corners alike: face 1, 3 or 5 of that cell.
inline constexpr std::array<std::array<std::array<std::uint8_t, 2>, 4>, 3> kAlignedCorners = {
    {{{{0, 1}, {3, 2}, {7, 6}, {4, 5}}},
     {{{0, 3}, {1, 2}, {5, 6}, {4, 7}}},
     {{{0, 4}, {1, 5}, {2, 6}, {3, 7}}}}};

/// Knows of each vertex the last cell that has it at corner 0.
class AlignedCells {
 public:
  /// @param cells  with corners below vertexCount; must outlive this object
  AlignedCells(std::size_t vertexCount, std::span<const Hex> cells, Stage& stage);

  /// The last cell that has a vertex at corner 0, or kNone.
  [[nodiscard]] Index at(Index vertex) const noexcept { return cellAt_[vertex]; }

  /// A cell with face 2 * axis where this cell has face 2 * axis + 1, whose four corners there are
  /// what its neighbour along the axis is in this cell; or kNone. Cells that share a vertex at
  /// corner 0 with a later cell are not found.
  [[nodiscard]] Index behind(std::size_t cell, std::size_t axis) const noexcept {
    const Hex& here = cells_[cell];
    const Index candidate = cellAt_[here[kAlignedCorners[axis][0][1]]];
    if (candidate == kNone) return kNone;
    const Hex& there = cells_[candidate];
    Index different = 0;
    for (const auto& [behind, before] : kAlignedCorners[axis]) {
      different |= there[behind] ^ here[before];
    }
    return different == 0 ? candidate : kNone;
  }

  /// Calls f(cell, {behind(cell, 0), behind(cell, 1), behind(cell, 2)}) for the cells of
  /// [begin, end). Quicker than asking for one after the other, as neighbours may be far from each
  /// other in memory: they are fetched ahead.
  template <class F>
  void forEach(std::size_t begin, std::size_t end, const F& f) const {
    constexpr std::size_t kAhead = 16;
    for (std::size_t c = begin; c < end; ++c) {
      if (c + kAhead < end) fetch(c + kAhead);
      f(c, std::array<Index, 3>{behind(c, 0), behind(c, 1), behind(c, 2)});
    }
  }

 private:
  void fetch(std::size_t cell) const noexcept {
    for (const auto& corners : kAlignedCorners) {
      const Index candidate = cellAt_[cells_[cell][corners[0][1]]];
      if (candidate != kNone) prefetch(&cells_[candidate]);
    }
  }

  std::span<const Hex> cells_;
  Array<Index> cellAt_;  ///< per vertex: the last cell that has it at corner 0, or kNone
};

}  // namespace hexhex
