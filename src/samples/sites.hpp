// The vertices of a grid that may move, and what moves with them.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <samples/block_complex.hpp>
#include <samples/tet_grid.hpp>

namespace hexhex::samples {

/// One vertex: where its parameters are, and which sub-blocks it shapes.
struct Site {
  struct Copy {
    Int3* parameter = nullptr;
    Rotation fromFirst;
  };
  Index vertex = 0;
  std::vector<Copy> copies;
  std::vector<std::size_t> subBlocks;
  std::array<bool, 3> free{};  ///< axes of the first copy
  bool inside = false;         ///< may move in space
  bool singular = false;       ///< inside a singular coarse edge
};

/// Adds the sub-blocks of a block that touch a grid point.
inline void addSubBlocksAround(const TetGrid& grid, std::size_t block, const Int3& at,
                               std::vector<std::size_t>& subBlocks) {
  for (std::size_t corner = 0; corner < 8; ++corner) {
    Int3 low = at;
    bool exists = true;
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] -= static_cast<std::int64_t>(corner >> a & 1);
      exists = exists && low[a] >= 0 && low[a] < grid.refine();
    }
    if (exists) subBlocks.push_back(grid.subBlock(block, low));
  }
}

/// Calls f(site) for every vertex with anything to move, in a fixed order.
template <class F>
void forEachSite(TetGrid& grid, const BlockComplex& complex, const F& f) {
  Site site;
  Index vertex = 0;
  for (const CoarseCell& cell : complex.cells()) {
    site.free = cell.free;
    site.inside = !cell.boundary;
    site.singular = cell.dimension == 1 && cell.singular();
    for (std::size_t point = 0; point < grid.innerPointCount(cell.dimension); ++point) {
      site.vertex = vertex++;
      site.copies.clear();
      site.subBlocks.clear();
      for (const Occurrence& occurrence : cell.occurrences) {
        const Int3 at = grid.gridPoint(occurrence, cell.dimension, point);
        site.copies.push_back(
            {&grid.parameters[grid.slot(occurrence.block, at)], occurrence.fromFirst});
        addSubBlocksAround(grid, occurrence.block, at, site.subBlocks);
      }
      f(site);
    }
  }
  site.free = {true, true, true};
  site.inside = true;
  site.singular = false;
  for (std::size_t sub = 0; sub < grid.subBlockCount(); ++sub) {
    site.vertex = grid.centreVertex(sub);
    site.copies.assign(1, {&grid.centreParameters[sub], {}});
    site.subBlocks.assign(1, sub);
    f(site);
  }
}

}  // namespace hexhex::samples
