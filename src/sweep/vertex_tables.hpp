// The hex vertices of every closed tet, found again by grid point.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <hexhex/types.hpp>

#include <igm/prepare.hpp>
#include <sweep/sweep_observer.hpp>

namespace hexhex {

/// Where vertices are described, by number.
struct VertexDescriptions {
  std::span<Vec3> points;
  std::span<Index> tets;
  std::span<CornerSet> corners;  ///< in terms of the caller's tets
};

/// Numbers are those of extract() at the map's scale.
///
/// A tet has a table of the grid points in the box around its vertices, unless hardly any of them
/// are vertices: then its lines are searched. Without tables, arcs and an extraction together take
/// 7 % (tets of the size of cells) to 70 % (many cells in a tet) more time.
class VertexTables {
 public:
  /// Tets fill a sixth of their bounding box if they have three edges along the axes.
  static constexpr std::uint64_t kRoomPerVertex = 24;

  /// @param room  how many grid points the box around a tet's vertices may have for each of them if
  ///              it is to have a table; thin tets across the axes fill next to nothing of theirs
  /// @throws Error TooLarge for more vertices than an Index can number
  VertexTables(const PreparedMap& map, SweptVertices swept, Stage& stage,
               std::uint64_t room = kRoomPerVertex);
  /// Sweeps the map.
  VertexTables(const PreparedMap& map, Stage& stage, std::uint64_t room = kRoomPerVertex)
      : VertexTables(map, sweepVertices(map, stage), stage, room) {}

  [[nodiscard]] const VertexNumbers& numbers() const noexcept { return numbers_; }
  [[nodiscard]] std::uint64_t count() const noexcept { return numbers_.count(); }

  /// Writes position and generator of every vertex.
  void describe(const VertexDescriptions& to, Stage& stage) const;

  /// Whether a closed tet contains any vertices.
  [[nodiscard]] bool hasVertices(Index tet) const noexcept {
    return ((occupied_[tet / 64] >> (tet % 64)) & 1U) != 0;
  }
  /// The simplices of a tet with vertices in their interior: a bit per corner mask.
  [[nodiscard]] unsigned occupiedSimplices(Index tet) const noexcept;

  struct Found {
    Index vertex = kNone;             ///< kNone if the closed tet does not contain the point
    CornerMask simplex = kNoSimplex;  ///< of the tet, in whose interior it lies
  };
  /// The vertex at a grid point in the chart of a tet.
  [[nodiscard]] Found find(Index tet, const GridPoint& z) const {
    if (!hasVertices(tet)) return {};
    const Box& box = boxes_[boxOf_[tet]];
    std::size_t place = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto at = static_cast<std::uint32_t>(z[k]) - static_cast<std::uint32_t>(box.first[k]);
      if (at >= box.size[k]) return {};
      place = place * box.size[k] + at;
    }
    if (box.begin == kNoTable) return findOnLines(tet, z);
    return {tableVertices_[box.begin + place], tableSimplices_[box.begin + place]};
  }

  /// Calls visit(z, Found) for every vertex of a closed tet, in the order of its sweep.
  template <class Visit>
  void forEach(Index tet, const Visit& visit) const {
    for (const Line& line : linesOf(tet)) {
      GridPoint z = line.swept.point(0);
      for (std::uint32_t i = 0; i < line.swept.count; ++i) {
        visit(std::as_const(z), foundOn(tet, line, z, i));
        ++z[line.swept.axes()[2]];
      }
    }
  }

 private:
  /// A swept line with the numbers of its points.
  struct Line {
    SweptLine swept;
    Index left = kNone;  ///< kNone in faces that another tet owns
    Index right = kNone;
    Index inner = kNone;    ///< of the second point
    std::int32_t step = 0;  ///< from one inner point to the next

    void enter(const VertexRun& run);
  };
  /// The smallest box with all vertices of a tet, in its chart.
  struct Box {
    std::uint64_t begin = 0;  ///< in the tables, or kNoTable
    GridPoint first{};
    std::array<std::uint32_t, 3> size{};  ///< points along each axis

    [[nodiscard]] std::uint64_t points() const noexcept {
      return std::uint64_t{size[0]} * size[1] * size[2];
    }
  };
  static constexpr std::uint64_t kNoTable = ~std::uint64_t{0};

  [[nodiscard]] std::span<const Line> linesOf(Index tet) const noexcept {
    const std::size_t begin = lineBegin_[tet];
    return std::span(lines_).subspan(begin, lineBegin_[std::size_t{tet} + 1] - begin);
  }
  void countLines(const TetLines& lines, Stage& stage);
  void enterLines(TetLines& lines, Stage& stage);
  void numberLines(Index tet, std::span<const SweptLine> swept);
  void makeTables(std::uint64_t room, Stage& stage);
  [[nodiscard]] Box measureBox(Index tet, std::uint64_t room) const;
  void fillTable(Index tet);
  [[nodiscard]] Found findOnLines(Index tet, const GridPoint& z) const;
  [[nodiscard]] Found foundOn(Index tet, const Line& line, const GridPoint& z,
                              std::uint32_t i) const;

  const PreparedMap& map_;
  VertexNumbers numbers_;
  Array<std::uint64_t> lineBegin_;  ///< per tet (+1)
  Array<Line> lines_;
  Array<std::uint64_t> occupied_;  ///< a bit per tet: few enough to stay in caches
  Array<Index> boxOf_;             ///< per tet with vertices
  Array<Box> boxes_;
  Array<Index> tableVertices_;  ///< per point of the boxes with tables
  Array<CornerMask> tableSimplices_;
};

/// Of the lines of a tet's sweep, each with a SweptLine `swept`: the one through a grid point,
/// which may end before it; or nullptr.
/// @param hint  which line may be the one: searches in the order of a sweep repeat the one before
template <class Line>
[[nodiscard]] const Line* findLine(std::span<const Line> lines, const GridPoint& z,
                                   std::size_t hint = 0) {
  if (lines.empty()) return nullptr;
  const std::array<std::uint8_t, 3>& axes = lines.front().swept.axes();
  const std::pair wanted(z[axes[0]], z[axes[1]]);
  const auto placeOf = [](const Line& line) { return std::pair(line.swept.level, line.swept.row); };
  if (hint < lines.size() && placeOf(lines[hint]) == wanted) return &lines[hint];
  const auto found = std::ranges::lower_bound(lines, wanted, {}, placeOf);
  return found != lines.end() && placeOf(*found) == wanted ? &*found : nullptr;
}

}  // namespace hexhex
