// The canonical numbers of hex edges and hex faces: by the tet that owns the midpoint (the smallest
// of those that contain it), there by axis (along an edge, across a face), then in the order of the
// tet's sweep over midpoints. No mesh topology is needed, and two edges of the same two vertices
// are told apart.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <hexhex/types.hpp>

#include <curved/lattice_numbers.hpp>
#include <igm/prepare.hpp>
#include <lattice/half_grids.hpp>
#include <sweep/cell_seeds.hpp>

namespace hexhex {

enum class ElementKind : std::uint8_t { Edges, Faces };

/// One element as seen from the owner of its midpoint.
struct Element {
  std::uint64_t number;
  int axis;            ///< of the owner's chart: along an edge, across a face
  GridPoint z;         ///< smallest corner
  CornerMask simplex;  ///< of the owner, that holds the midpoint
};

class ElementNumbers {
 private:
  struct Line {
    SweptLine swept;
    std::uint32_t ownedFirst;
    std::uint32_t ownedCount;
    Index number;  ///< of the first that is owned
  };

 public:
  /// @throws Error TooLarge for more elements than an Index can number
  ElementNumbers(const PreparedMap& map, ElementKind kind, Stage& stage);
  /// Without numbers until a Sweep is finished.
  ElementNumbers(const PreparedMap& map, ElementKind kind);

  /// The grid of midpoints of edges along an axis, or of faces across it.
  [[nodiscard]] static constexpr HalfGrid midpointsOf(ElementKind kind, int axis) noexcept {
    const int along = 1 << axis;
    return static_cast<HalfGrid>(kind == ElementKind::Edges ? along : 7 ^ along);
  }
  /// All three.
  [[nodiscard]] static constexpr HalfGridSet gridsOf(ElementKind kind) noexcept {
    unsigned set = 0;
    for (int axis = 0; axis < 3; ++axis) set |= halfGridBit(midpointsOf(kind, axis));
    return static_cast<HalfGridSet>(set);
  }

  /// Gives numbers while others sweep the same tets.
  class Sweep {
   public:
    explicit Sweep(ElementNumbers& numbers) : numbers_(numbers) {}
    /// Tets of a block in order, blocks in any order and in parallel.
    /// @param grids  of the tet; with gridsOf() wanted
    void add(std::size_t block, Index tet, const HalfGrids& grids) {
      if ((grids.occupied() & gridsOf(numbers_.kind_)) == 0) {
        numbers_.addNothing(tet);
      } else {
        numbers_.sweep(tet, grids, numbers_.blocks_[block]);
      }
      // Lines stay where they are, so what was reserved too much would stay as well.
      const bool isLast = (tet + 1) % kSweepBlock == 0;
      if (isLast) numbers_.blocks_[block].shrink_to_fit();
    }
    /// @throws Error TooLarge for more elements than an Index can number
    void finish(Stage& stage);

   private:
    ElementNumbers& numbers_;
  };

  [[nodiscard]] std::uint64_t count() const noexcept { return begin_.back(); }
  /// The first element that a tet owns; also of the tet behind the last.
  [[nodiscard]] std::uint64_t begin(std::size_t tet) const noexcept { return begin_[tet]; }

  /// Elements next to each other along an axis that a tet owns.
  class Row {
   public:
    Row(const SweptLine& swept, std::uint32_t first, std::uint32_t count, const Element& element,
        std::size_t along) noexcept
        : swept_(swept), first_(first), count_(count), element_(element), along_(along) {}

    [[nodiscard]] const Element& front() const noexcept { return element_; }
    [[nodiscard]] std::size_t along() const noexcept { return along_; }

    template <class Visit>
    void forEach(const Visit& visit) const {
      Element element = element_;
      for (std::uint32_t i = first_; i < first_ + count_; ++i) {
        element.simplex = swept_.simplex(i);
        visit(std::as_const(element));
        ++element.number;
        ++element.z[along_];
      }
    }

   private:
    const SweptLine& swept_;
    std::uint32_t first_;
    std::uint32_t count_;
    Element element_;
    std::size_t along_;
  };

  /// Visits all elements that a tet owns, row by row, in order.
  template <class Visit>
  void forEachRow(Index tet, const Visit& visit) const {
    std::uint64_t number = begin_[tet];
    if (number == begin_[std::size_t{tet} + 1]) return;
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t along = axes_[gridOf(tet, axis)]()[2];
      for (const Line& line : linesOf(tet, axis)) {
        const Element front{number, axis, point(tet, axis, line, line.ownedFirst), kNoSimplex};
        visit(Row(line.swept, line.ownedFirst, line.ownedCount, front, along));
        number += line.ownedCount;
      }
    }
  }
  /// The same element by element.
  template <class Visit>
  void forEach(Index tet, const Visit& visit) const {
    forEachRow(tet, [&](const Row& row) { row.forEach(visit); });
  }

  /// The number of an element, by its owner.
  /// @throws Error Internal if the tet does not own it
  [[nodiscard]] Index find(Index owner, int axis, const GridPoint& z, LineHint& hint) const;

 private:
  [[nodiscard]] static std::size_t gridOf(Index tet, int axis) noexcept {
    return 3 * std::size_t{tet} + static_cast<std::size_t>(axis);
  }
  [[nodiscard]] std::span<const Line> linesOf(Index tet, int axis) const noexcept {
    const std::size_t grid = gridOf(tet, axis);
    const std::size_t block = tet / kSweepBlock;
    const Index blockBegin = lineBegin_[3 * kSweepBlock * block];
    return std::span(blocks_[block])
        .subspan(lineBegin_[grid] - blockBegin, lineBegin_[grid + 1] - lineBegin_[grid]);
  }
  [[nodiscard]] GridPoint point(Index tet, int axis, const Line& line,
                                std::uint32_t i) const noexcept;
  void addNothing(Index tet) noexcept {
    begin_[tet] = 0;
    for (int axis = 0; axis < 3; ++axis) {
      axes_[gridOf(tet, axis)] = {};
      lineBegin_[gridOf(tet, axis)] = 0;
    }
  }
  void sweep(Index tet, const HalfGrids& grids, Array<Line>& lines);

  const ExactMap& map_;
  const TetTopology& topology_;
  ElementKind kind_;
  Array<std::uint64_t> begin_;       ///< per tet (+1)
  Array<SweepAxes> axes_;            ///< per grid: tet and axis
  Array<Index> lineBegin_;           ///< per grid (+1); there are no more lines than elements
  std::vector<Array<Line>> blocks_;  ///< by block of tets: lines with owned elements
};

/// @throws Error TooLarge for more elements than an Index can number
void requireNumbers(std::uint64_t elements);

/// What vertices and edges take to be numbered, in one sweep of the tets.
struct GridNumbers {
  LatticeNumbers vertices;
  ElementNumbers edges;
};
/// @throws Error TooLarge for more than an Index can number
[[nodiscard]] GridNumbers numberVerticesAndEdges(const PreparedMap& map, Stage& stage);

}  // namespace hexhex
