#include <optional>
#include <string>

#include <curved/element_numbers.hpp>

namespace hexhex {

namespace {

/// The midpoints of edges along an axis, or of faces across it: the grid, moved by one half along
/// some axes.
struct ShiftedGrid {
  std::array<bool, 3> moved{};

  ShiftedGrid(ElementKind kind, std::size_t axis) noexcept {
    for (std::size_t k = 0; k < 3; ++k) moved[k] = (k == axis) == (kind == ElementKind::Edges);
  }

  [[nodiscard]] GridBox box(const GridBoxes& boxes) const noexcept {
    GridBox box;
    for (std::size_t k = 0; k < 3; ++k) {
      box.range[k] = (moved[k] ? boxes.centers : boxes.vertices).range[k];
    }
    return box;
  }
  [[nodiscard]] std::array<double, 3> shift() const noexcept {
    return {moved[0] ? 0.5 : 0, moved[1] ? 0.5 : 0, moved[2] ? 0.5 : 0};
  }
  /// The tet, moved so that the midpoints become grid points.
  [[nodiscard]] LatticeTet movedBack(const LatticeTet& corners, std::int64_t unit) const noexcept {
    LatticeTet result = corners;
    for (LatticePoint& corner : result) {
      for (std::size_t k = 0; k < 3; ++k) corner[k] -= moved[k] ? unit / 2 : 0;
    }
    return result;
  }
};

}  // namespace

ElementNumbers::ElementNumbers(const PreparedMap& map, ElementKind kind, Stage& stage)
    : map_(map.exact), topology_(map.topology), kind_(kind) {
  const std::size_t tets = map.topology.tetCount();
  begin_.resize(tets + 1);
  begin_[tets] = 0;
  axes_.resize(3 * tets);
  lineBegin_.resize(3 * tets + 1);
  lineBegin_[3 * tets] = 0;
  std::vector<std::vector<Line>> blocks(blockCount(tets, kSweepBlock));
  parallelBlocks(stage, tets, kSweepBlock,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   for (std::size_t t = begin; t < end; ++t) {
                     sweep(static_cast<Index>(t), blocks[block]);
                   }
                 });
  exclusiveScan(std::span(begin_));
  if (count() >= kNone) {
    throw Error(ErrorCode::TooLarge, "The mesh would have " + std::to_string(count()) +
                                         " edges or faces, more than "
                                         "32-bit indices can number. Lower the scale.");
  }
  exclusiveScan(std::span(lineBegin_));
  lines_.resize(lineBegin_.back());
  parallelFor(stage, blocks.size(), 1, [&](std::size_t block) {
    const std::size_t firstTet = block * kSweepBlock;
    std::size_t at = lineBegin_[3 * firstTet];
    auto number = static_cast<Index>(begin_[firstTet]);
    for (const Line& line : blocks[block]) {
      lines_[at] = line;
      lines_[at++].number = number;
      number += line.ownedCount;
    }
    blocks[block] = {};
  });
}

/// Appends the lines with elements that a tet owns, and counts both.
void ElementNumbers::sweep(Index tet, std::vector<Line>& lines) {
  const LatticeTet& corners = map_.corners[tet];
  const GridBoxes boxes = gridBoxes(corners, map_.unit);
  std::optional<EmptinessTest> test;
  CenterOwner owner(topology_, tet);
  begin_[tet] = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const ShiftedGrid grid(kind_, static_cast<std::size_t>(axis));
    const GridBox box = grid.box(boxes);
    const SweepAxes axes = chooseSweepAxes(box);
    axes_[gridOf(tet, axis)] = axes;
    lineBegin_[gridOf(tet, axis)] = 0;
    if (box.empty()) continue;
    if (!test) test.emplace(corners, map_.unit);
    if (test->certainlyMisses(box, grid.shift())) continue;
    const std::size_t before = lines.size();
    const LatticeTet moved = grid.movedBack(corners, map_.unit);
    LineRasterizer(moved, map_.unit, box, axes).run([&](const SweptLine& line) {
      const auto [first, count] = owner.owned(line);
      if (count == 0) return;
      lines.push_back({line, first, count, kNone});
      begin_[tet] += count;
    });
    lineBegin_[gridOf(tet, axis)] = lines.size() - before;
  }
}

GridPoint ElementNumbers::point(Index tet, int axis, const Line& line,
                                std::uint32_t i) const noexcept {
  const std::array<std::uint8_t, 3>& a = axes_[gridOf(tet, axis)]();
  GridPoint z{};
  z[a[0]] = line.swept.level;
  z[a[1]] = line.swept.row;
  z[a[2]] = line.swept.first + static_cast<std::int32_t>(i);
  return z;
}

Index ElementNumbers::find(Index owner, int axis, const GridPoint& z, LineHint& hint) const {
  const std::array<std::uint8_t, 3>& a = axes_[gridOf(owner, axis)]();
  const Line* const line = findLine(
      linesOf(owner, axis), z[a[0]], z[a[1]],
      [](const Line& l) -> const SweptLine& { return l.swept; }, hint);
  if (line != nullptr) {
    const auto i = static_cast<std::uint32_t>(z[a[2]] - line->swept.first) - line->ownedFirst;
    if (i < line->ownedCount) return line->number + i;
  }
  throw Error(ErrorCode::Internal,
              "An edge or face was not found in the tet that owns its midpoint. The map passed all "
              "checks, so this is a bug; please report it with the map.",
              {PlaceKind::Tet, owner});
}

}  // namespace hexhex
