// The numbers of hex vertices, found again by grid point and tet.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <hexhex/types.hpp>

#include <base/prefetch.hpp>
#include <igm/prepare.hpp>
#include <lattice/half_grids.hpp>
#include <propeller/lattice_lines.hpp>
#include <sweep/sweep_observer.hpp>
#include <sweep/tet_lines.hpp>
#include <sweep/vertex_numbers.hpp>

namespace hexhex {

/// Where vertices are described, by number; nothing if the spans are empty.
struct VertexDescriptions {
  std::span<Vec3> points;
  std::span<Index> tets;
  std::span<CornerSet> corners;  ///< in terms of the caller's tets
};

/// Where a line was found the last time: a guess where the next one is. One for each of several
/// searches that go side by side.
struct LineHint {
  std::size_t line = 0;
};

/// Sweeps a map for its grid points, or takes them over from an engine that has found them. Numbers
/// are those of extract() at the map's scale.
class LatticeNumbers {
 public:
  /// @throws Error TooLarge for more vertices than an Index can number
  LatticeNumbers(const PreparedMap& map, Stage& stage)
      : LatticeNumbers(map, kRoomPerVertex, stage) {}
  /// @param room  how many grid points the box around a tet's vertices may have for each of them if
  ///              it is to have a table; thin tets across the axes fill next to nothing of theirs
  LatticeNumbers(const PreparedMap& map, std::uint64_t room, Stage& stage);
  /// Takes over what an engine has swept and numbered.
  LatticeNumbers(const PreparedMap& map, SweptVertices swept, Stage& stage);
  /// Looks into tables in which an engine finds its way.
  /// @param lines  complete; they have to stay there
  /// @param count  of vertices
  LatticeNumbers(const PreparedMap& map, const LatticeLines& lines, std::uint64_t count,
                 Stage& stage);
  /// Without numbers until a Sweep is finished.
  explicit LatticeNumbers(const PreparedMap& map, std::uint64_t room = kRoomPerVertex);

  /// Tets fill a sixth of their bounding box if they have three edges along the axes.
  static constexpr std::uint64_t kRoomPerVertex = 24;

  /// The grid of vertices.
  static constexpr HalfGridSet kGrids = halfGridBit(0);

  /// Gives numbers while others sweep the same tets.
  class Sweep {
   public:
    explicit Sweep(LatticeNumbers& numbers);
    /// Tets of a block in order, blocks in any order and in parallel.
    /// @param grids  of the tet; with kGrids wanted
    void add(std::size_t block, Index tet, const HalfGrids& grids) {
      if ((grids.occupied() & kGrids) != 0) {
        sweep(block, tet, grids);
      } else {
        numbers_.axes_[tet] = {};
        numbers_.lineBegin_[tet] = 0;
        counter_.countNothing(tet);
      }
    }
    /// @throws Error TooLarge for more vertices than an Index can number
    void finish(Stage& stage);

   private:
    void sweep(std::size_t block, Index tet, const HalfGrids& grids);

    LatticeNumbers& numbers_;
    VertexCounter counter_;
    std::vector<std::vector<SweptLine>> blocks_;
  };

  [[nodiscard]] std::uint64_t count() const noexcept {
    return engineLines_ != nullptr ? engineCount_ : numbers_.count();
  }

  /// Writes position and generator of every vertex. Only of what was swept here.
  void describe(const VertexDescriptions& to, Stage& stage) const;

  /// Whether a closed tet contains any vertices.
  [[nodiscard]] bool hasVertices(Index tet) const noexcept {
    return ((occupied_[tet / 64] >> (tet % 64)) & 1U) != 0;
  }

  /// Tells memory that find() will be asked soon.
  void fetch(Index tet) const noexcept {
    if (engineLines_ != nullptr) {
      prefetch(&engineLines_->planeBegin[tet]);
      prefetch(&engineLines_->sweeps[tet]);
    } else {
      prefetch(&boxOf_[tet]);
    }
  }

  struct Found {
    Index vertex = kNone;             ///< kNone if the closed tet does not contain the point
    CornerMask simplex = kNoSimplex;  ///< of the tet, in whose interior it lies
  };
  /// The vertex at a grid point in the chart of a tet.
  [[nodiscard]] Found find(Index tet, const GridPoint& z) const {
    if (!hasVertices(tet)) return {};
    if (engineLines_ != nullptr) {
      const LatticeLines::Place place = engineLines_->locate(tet, z);
      if (place.line == kNone) return {};
      return {engineLines_->vertices[place.point], engineLines_->simplexAt(place)};
    }
    const Box& box = boxes_[boxOf_[tet]];
    std::size_t place = 0;
    bool isInside = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto at = static_cast<std::uint32_t>(z[k]) - static_cast<std::uint32_t>(box.first[k]);
      isInside &= at < box.size[k];
      place = place * box.size[k] + at;
    }
    if (!isInside) return {};
    if (box.begin >= kNoTable) {
      return box.begin == kLarge ? findOnLines(tet, z) : onlyVertex(box.begin);
    }
    return {boxVertices_[box.begin + place], boxSimplices_[box.begin + place]};
  }

 private:
  /// A swept line with the numbers of its points.
  struct Line {
    SweptLine swept;
    Index left = kNone;  ///< kNone in faces that another tet owns
    Index right = kNone;
    Index inner = kNone;    ///< of the second point
    std::int32_t step = 0;  ///< from one inner point to the next
  };

  [[nodiscard]] std::span<const Line> linesOf(Index tet) const noexcept {
    const std::size_t begin = lineBegin_[tet];
    return std::span(lines_).subspan(begin, lineBegin_[std::size_t{tet} + 1] - begin);
  }
  /// The smallest box with all vertices of a tet, in its chart. In a table of its grid points, a
  /// vertex is found at once.
  struct Box {
    std::uint64_t begin = 0;  ///< in the tables; kNoTable or more if it is not there
    GridPoint first{};
    std::array<std::uint32_t, 3> size{};  ///< points along each axis

    [[nodiscard]] std::uint64_t points() const noexcept {
      return std::uint64_t{size[0]} * size[1] * size[2];
    }
  };
  /// Plus the only vertex and its simplex.
  static constexpr std::uint64_t kNoTable = std::uint64_t{1} << 63;
  /// Too many points.
  static constexpr std::uint64_t kLarge = ~std::uint64_t{0};
  [[nodiscard]] static Found onlyVertex(std::uint64_t begin) noexcept {
    return {static_cast<Index>(begin), static_cast<CornerMask>((begin >> 32) & kWholeTet)};
  }
  [[nodiscard]] static std::uint64_t beginOfOnly(const Found& found) noexcept {
    return kNoTable | std::uint64_t{found.simplex} << 32 | found.vertex;
  }

  void noteLines(Index tet, std::span<const SweptLine> lines) noexcept;
  template <class TakeBlock>
  void numberLines(const TakeBlock& takeBlock, Stage& stage);
  [[nodiscard]] std::vector<std::size_t> countBoxes();
  [[nodiscard]] Box measureBox(Index tet) const;
  void fillBox(Index tet, std::uint64_t begin);
  void fillBoxes(std::vector<std::uint64_t>& points, Stage& stage);
  [[nodiscard]] Found findOnLines(Index tet, const GridPoint& z) const;
  /// The i-th vertex of a line, at grid point z.
  [[nodiscard]] Found foundOn(Index tet, const Line& line, const GridPoint& z,
                              std::uint32_t i) const {
    if (i > 0 && i + 1 < line.swept.count && line.inner != kNone) {
      return {line.inner + static_cast<Index>(line.step * static_cast<std::int32_t>(i - 1)),
              line.swept.inner()};
    }
    return foundAtEnd(tet, line, z, i);
  }
  [[nodiscard]] Found foundAtEnd(Index tet, const Line& line, const GridPoint& z,
                                 std::uint32_t i) const;
  void number(Index tet, std::span<const SweptLine> swept);
  static void enter(Line& line, const VertexRun& run);

  const PreparedMap& map_;
  std::uint64_t room_;
  const LatticeLines* engineLines_ = nullptr;  ///< if given, all else but `occupied_` is empty
  std::uint64_t engineCount_ = 0;
  VertexNumbers numbers_;
  Array<SweepAxes> axes_;           ///< per tet
  Array<std::uint64_t> lineBegin_;  ///< per tet (+1)
  Array<std::uint64_t> occupied_;   ///< a bit per tet: few enough to be at hand wherever arcs go
  Array<Line> lines_;
  // For find():
  Array<Index> boxOf_;  ///< per tet; only of tets with vertices
  Array<Box> boxes_;
  Array<Index> boxVertices_;  ///< per point of the boxes
  Array<CornerMask> boxSimplices_;
};

/// Lines in the order of a sweep: the one at a level and row, or nullptr.
/// @param sweptOf  the SweptLine of a line
/// @param hint     moves along
template <class Line, class SweptOf>
[[nodiscard]] const Line* findLine(std::span<const Line> lines, std::int32_t level,
                                   std::int32_t row, const SweptOf& sweptOf, LineHint& hint) {
  // Level and row in one number, in their order.
  const auto key = [](std::int64_t l, std::int32_t r) { return l * (std::int64_t{1} << 32) + r; };
  const std::int64_t wanted = key(level, row);
  const auto keyOf = [&](std::size_t i) {
    const SweptLine& line = sweptOf(lines[i]);
    return key(line.level, line.row);
  };
  // Elements come in the order of a sweep, so many searches repeat the one before.
  if (hint.line < lines.size() && keyOf(hint.line) == wanted) return &lines[hint.line];
  if (lines.empty()) return nullptr;
  // By arithmetic, as on which side it is would be as good as random.
  std::size_t low = 0;
  for (std::size_t left = lines.size(); left > 1;) {
    const std::size_t half = left / 2;
    low += half & (std::size_t{0} - static_cast<std::size_t>(keyOf(low + half) <= wanted));
    left -= half;
  }
  if (keyOf(low) != wanted) return nullptr;
  hint.line = low;
  return &lines[low];
}

}  // namespace hexhex
