// Finds the hex vertices of every closed tet by grid point.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <hexhex/types.hpp>

#include <igm/igm.hpp>
#include <sweep/vertex_numbers.hpp>

namespace hexhex::sweep {

/// Where vertices are described, by number.
struct VertexDescriptions {
  std::span<Vec3> points;
  std::span<Index> tets;
  std::span<CornerSet> corners;  ///< in terms of the caller's tets
};

/// Of the lines of a tet's sweep, each with a SweptLine `swept`: the one through a grid point,
/// which may end before the point; nullptr if there is none.
/// @param hint  the line to try first: searches in the order of a sweep repeat the one before
template <class Line>
[[nodiscard]] const Line* findLine(std::span<const Line> lines, const lattice::GridPoint& z,
                                   std::size_t hint = 0) {
  if (lines.empty()) return nullptr;
  const std::array<std::uint8_t, 3>& axes = lines.front().swept.axes();
  const auto key = [](std::int64_t level, std::int64_t row) { return (level << 32) + row; };
  const auto keyOf = [&](const Line& line) { return key(line.swept.level, line.swept.row); };
  const std::int64_t wanted = key(z[axes[0]], z[axes[1]]);
  if (hint < lines.size() && keyOf(lines[hint]) == wanted) return &lines[hint];
  // std::lower_bound() has branches that cannot be predicted: with it, arcs and patches of
  // s17c_sphere_r10 take 6 % longer.
  const Line* found = lines.data();
  for (std::size_t size = lines.size(); size > 1;) {
    const std::size_t half = size / 2;
    found += keyOf(found[half - 1]) < wanted ? half : 0;
    size -= half;
  }
  return keyOf(*found) == wanted ? found : nullptr;
}

/// Numbers are those of extract() at the map's scale.
///
/// A tet has a table of its sweep's lines, by level and row, unless hardly any of them hold
/// vertices: then its lines are searched. (Without tables, arcs and an extraction together take 7 %
/// more time with tets of the size of cells, and up to 70 % with many cells per tet.)
class VertexTables {
 public:
  static constexpr std::uint64_t kRoomPerLine = 24;

  /// @param room  how many entries a tet's table may have per line: those of thin tets across the
  ///              axes would be mostly empty
  /// @throws Error TooLarge for more vertices than an Index can number
  VertexTables(const igm::PreparedMap& map, SweptVertices swept, Stage& stage,
               std::uint64_t room = kRoomPerLine);
  /// Sweeps the map.
  VertexTables(const igm::PreparedMap& map, Stage& stage, std::uint64_t room = kRoomPerLine)
      : VertexTables(map, sweepVertices(map, stage), stage, room) {}

  [[nodiscard]] const VertexNumbers& numbers() const noexcept { return numbers_; }
  [[nodiscard]] std::uint64_t count() const noexcept { return numbers_.count(); }

  /// Writes the position and generator of every vertex.
  void describe(const VertexDescriptions& to, Stage& stage) const;

  /// Whether a closed tet contains any vertices.
  [[nodiscard]] bool hasVertices(Index tet) const noexcept {
    return ((occupied_[tet / 64] >> (tet % 64)) & 1U) != 0;
  }
  /// The simplices of a tet with vertices in their interior: a bit per corner mask.
  [[nodiscard]] unsigned occupiedSimplices(Index tet) const noexcept;

  struct Found {
    Index vertex = kNone;  ///< kNone if the closed tet does not contain the point
    lattice::CornerMask simplex = lattice::kNoSimplex;  ///< of the tet, in whose interior it lies
  };
  /// The vertex at a grid point in the chart of a tet.
  [[nodiscard]] Found find(Index tet, const lattice::GridPoint& z) const {
    if (!hasVertices(tet)) return {};
    const Box& box = boxes_[boxOf_[tet]];
    const std::array<std::uint8_t, 3>& axes = box.axes();
    std::size_t place = 0;
    for (std::size_t k = 0; k < 2; ++k) {
      const auto at =
          static_cast<std::uint32_t>(z[axes[k]]) - static_cast<std::uint32_t>(box.first[k]);
      if (at >= box.size[k]) return {};
      place = place * box.size[k] + at;
    }
    if (box.begin == kNoTable) return foundOn(tet, findLine(linesOf(tet), z), z);
    const Index line = tables_[box.begin + place];
    return foundOn(tet, line == kNone ? nullptr : &lines_[lineBegin_[tet] + line], z);
  }

  /// Calls visit(z, Found) for every vertex of a closed tet, in the order of its sweep.
  template <class Visit>
  void forEach(Index tet, const Visit& visit) const {
    for (const Line& line : linesOf(tet)) {
      lattice::GridPoint z = line.swept.point(0);
      for (std::uint32_t i = 0; i < line.swept.count; ++i) {
        visit(std::as_const(z), foundOn(tet, line, z, i));
        ++z[line.swept.axes()[2]];
      }
    }
  }

 private:
  /// A swept line with the numbers of its points.
  struct Line {
    lattice::SweptLine swept;
    Index left = kNone;  ///< kNone in faces that another tet owns
    Index right = kNone;
    Index inner = kNone;    ///< of the second point
    std::int32_t step = 0;  ///< from one inner point to the next

    void enter(const VertexRun& run);
  };
  /// The levels and rows of a tet's lines.
  struct Box {
    std::uint64_t begin = 0;  ///< in the tables, or kNoTable
    std::array<std::int32_t, 2> first{};
    std::array<std::uint32_t, 2> size{};
    lattice::SweepAxes axes;

    [[nodiscard]] std::uint64_t places() const noexcept { return std::uint64_t{size[0]} * size[1]; }
  };
  static constexpr std::uint64_t kNoTable = ~std::uint64_t{0};

  [[nodiscard]] std::span<const Line> linesOf(Index tet) const noexcept {
    const std::size_t begin = lineBegin_[tet];
    return std::span(lines_).subspan(begin, lineBegin_[std::size_t{tet} + 1] - begin);
  }
  void countLines(const TetLines& lines, Stage& stage);
  void enterLines(TetLines& lines, Stage& stage);
  void numberLines(Index tet, std::span<const lattice::SweptLine> swept);
  void makeTables(std::uint64_t room, Stage& stage);
  [[nodiscard]] Box measureBox(Index tet, std::uint64_t room) const;
  void fillTable(Index tet, const Box& box);
  /// The vertex at grid point z of a line, if that line exists.
  [[nodiscard]] Found foundOn(Index tet, const Line* line, const lattice::GridPoint& z) const {
    if (line == nullptr) return {};
    const std::uint32_t i = line->swept.indexOf(z);
    return i < line->swept.count ? foundOn(tet, *line, z, i) : Found{};
  }
  [[nodiscard]] Found foundOn(Index tet, const Line& line, const lattice::GridPoint& z,
                              std::uint32_t i) const;

  const igm::PreparedMap& map_;
  VertexNumbers numbers_;
  Array<std::uint64_t> lineBegin_;  ///< per tet (+1)
  Array<Line> lines_;
  Array<std::uint64_t> occupied_;  ///< a bit per tet: few enough to stay in caches
  Array<Index> boxOf_;             ///< per tet with vertices
  Array<Box> boxes_;
  Array<Index> tables_;  ///< which of its tet's lines; or kNone
};

}  // namespace hexhex::sweep
