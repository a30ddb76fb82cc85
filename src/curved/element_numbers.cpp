#include <string>

#include <curved/element_numbers.hpp>

namespace hexhex {

namespace {

/// The grid of midpoints of edges along an axis, or of faces across it.
MovedAxes midpoints(ElementKind kind, int axis) noexcept {
  const bool edges = kind == ElementKind::Edges;
  MovedAxes moved = {!edges, !edges, !edges};
  moved[static_cast<std::size_t>(axis)] = edges;
  return moved;
}

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
                     HalfGrids grids(map_.corners[t], map_.unit);
                     sweep(static_cast<Index>(t), grids, blocks[block]);
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
void ElementNumbers::sweep(Index tet, HalfGrids& grids, std::vector<Line>& lines) {
  CenterOwner owner(topology_, tet);
  std::uint64_t elements = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t before = lines.size();
    axes_[gridOf(tet, axis)] = grids.sweep(midpoints(kind_, axis), [&](const SweptLine& line) {
      const auto [first, count] = owner.owned(line);
      if (count == 0) return;
      lines.push_back({line, first, count, kNone});
      elements += count;
    });
    lineBegin_[gridOf(tet, axis)] = lines.size() - before;
  }
  begin_[tet] = elements;
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
