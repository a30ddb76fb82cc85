#include <string>

#include <curved/element_numbers.hpp>

namespace hexhex {

namespace {

/// A tet, moved so that the midpoints of elements become grid points.
struct ShiftedTet {
  LatticeTet corners;
  GridBox box;
  SweepAxes axes;

  ShiftedTet(const ExactMap& map, Index tet, ElementKind kind, std::size_t axis) noexcept
      : corners(map.corners[tet]) {
    for (LatticePoint& corner : corners) {
      for (std::size_t k = 0; k < 3; ++k) {
        if ((k == axis) == (kind == ElementKind::Edges)) corner[k] -= map.unit / 2;
      }
    }
    box = gridBox(corners, map.unit);
    axes = chooseSweepAxes(box);
  }

  void run(std::int64_t unit, std::vector<SweptLine>& lines) const {
    if (box.empty() || EmptinessTest(corners, unit).certainlyMisses(box, 0)) return;
    LineRasterizer(corners, unit, box, axes).run([&](const SweptLine& line) {
      lines.push_back(line);
    });
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
                   std::vector<SweptLine> swept;
                   for (std::size_t t = begin; t < end; ++t) {
                     sweep(static_cast<Index>(t), swept, blocks[block]);
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
void ElementNumbers::sweep(Index tet, std::vector<SweptLine>& swept, std::vector<Line>& lines) {
  CenterOwner owner(topology_, tet);
  begin_[tet] = 0;
  for (int axis = 0; axis < 3; ++axis) {
    swept.clear();
    const ShiftedTet shifted(map_, tet, kind_, static_cast<std::size_t>(axis));
    shifted.run(map_.unit, swept);
    axes_[gridOf(tet, axis)] = shifted.axes;
    const std::size_t before = lines.size();
    for (const SweptLine& line : swept) {
      const auto [first, count] = owner.owned(line);
      if (count == 0) continue;
      lines.push_back({line, first, count, kNone});
      begin_[tet] += count;
    }
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

Index ElementNumbers::find(Index owner, int axis, const GridPoint& z) const {
  const std::array<std::uint8_t, 3>& a = axes_[gridOf(owner, axis)]();
  const Line* const line = findLine(linesOf(owner, axis), z[a[0]], z[a[1]],
                                    [](const Line& l) -> const SweptLine& { return l.swept; });
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
