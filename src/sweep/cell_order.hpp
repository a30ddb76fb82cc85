// The canonical numbers of hex cells: by the tet that owns the cell's centre (the smallest that
// contains it), then in the order of that tet's sweep over centres. The corners of a cell are in
// VTK order with respect to the axes of the owner's chart.
#pragma once

#include <array>
#include <cassert>
#include <cstdint>
#include <optional>

#include <hexhex/types.hpp>

#include <igm/igm.hpp>
#include <lattice/cell_corners.hpp>
#include <sweep/tet_lines.hpp>

namespace hexhex::sweep {

/// Decides which centres a tet owns.
class CenterOwner {
 public:
  CenterOwner(const adjacency::TetTopology& topology, Index tet) noexcept
      : topology_(topology), tet_(tet) {}

  struct Range {
    std::uint32_t first;
    std::uint32_t count;
  };
  /// The owned centres of one of the tet's lines. They are consecutive, because a tet that owns a
  /// face of one of its simplices also owns the simplex.
  [[nodiscard]] Range owned(const lattice::SweptLine& line) {
    if (line.allInside()) return {0, line.count};
    const bool left = owns(line.left);
    const bool right = owns(line.right);
    if (line.count == 1) return {0, left ? 1U : 0U};
    if (line.count > 2 && !owns(line.inner())) return {0, 0};
    if (line.count == 2 && !left) return {1, right ? 1U : 0U};
    // Otherwise the owned centres would not be consecutive.
    assert(!left || line.count == 2 || owns(line.inner()));
    const std::uint32_t first = left ? 0 : 1;
    return {first, line.count - first - (right ? 0U : 1U)};
  }

 private:
  [[nodiscard]] bool owns(lattice::CornerMask simplex) {
    if (simplex == lattice::kWholeTet) return true;
    const auto bit = 1U << simplex;
    if ((known_ & bit) == 0) {
      known_ |= bit;
      if (adjacency::ownsSimplex(topology_, tet_, simplex)) owned_ |= bit;
    }
    return (owned_ & bit) != 0;
  }

  const adjacency::TetTopology& topology_;
  Index tet_;
  unsigned known_ = 0;
  unsigned owned_ = 0;
};

/// Calls visit(SweptLine, i) for each centre that a tet owns, point i of one of its lines, in the
/// order of the cells.
template <class Visit>
void forEachOwnedCenter(const adjacency::TetTopology& topology, Index tet,
                        std::span<const lattice::SweptLine> lines, const Visit& visit) {
  CenterOwner owner(topology, tet);
  for (const lattice::SweptLine& line : lines) {
    const auto [first, count] = owner.owned(line);
    for (std::uint32_t i = first; i < first + count; ++i) visit(line, i);
  }
}

/// Number of centres that a tet owns.
[[nodiscard]] std::uint64_t countOwned(const adjacency::TetTopology& topology, Index tet,
                                       std::span<const lattice::SweptLine> lines);

/// The cells of each tet.
struct CellCenters {
  Array<std::uint64_t> begin;     ///< per tet (+1): the first cell that it owns
  std::optional<TetLines> lines;  ///< of centres; if absent, they are swept again when needed

  CellCenters(std::size_t tets, bool keepLines) : begin(tets + 1) {
    begin[tets] = 0;
    if (keepLines) lines.emplace(tets);
  }
  [[nodiscard]] std::uint64_t count() const noexcept { return begin.back(); }

  /// The tet's lines; uses `scratch` if they are not stored.
  [[nodiscard]] std::span<const lattice::SweptLine> linesOf(
      const igm::ExactMap& map, Index tet, std::vector<lattice::SweptLine>& scratch) const;
};

/// Sweeps the centres of all tets, and keeps their lines.
[[nodiscard]] CellCenters findCells(const igm::PreparedMap& map, Stage& stage);

}  // namespace hexhex::sweep
