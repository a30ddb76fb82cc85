#include <string>

#include <curved/element_numbers.hpp>

namespace hexhex {

void requireNumbers(std::uint64_t elements) {
  if (elements < kNone) return;
  throw Error(ErrorCode::TooLarge, "The mesh would have " + std::to_string(elements) +
                                       " edges or faces, more than "
                                       "32-bit indices can number. Lower the scale.");
}

ElementNumbers::ElementNumbers(const PreparedMap& map, ElementKind kind)
    : map_(map.exact), topology_(map.topology), kind_(kind) {
  const std::size_t tets = map.topology.tetCount();
  begin_.resize(tets + 1);
  begin_[tets] = 0;
  axes_.resize(3 * tets);
  blocks_.resize(blockCount(tets, kSweepBlock));
  lineBegin_.resize(3 * tets + 1);
  lineBegin_[3 * tets] = 0;
}

ElementNumbers::ElementNumbers(const PreparedMap& map, ElementKind kind, Stage& stage)
    : ElementNumbers(map, kind) {
  Sweep sweep(*this);
  const HalfGridSearch search(gridsOf(kind));
  parallelBlocks(stage, topology_.tetCount(), kSweepBlock,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   for (std::size_t t = begin; t < end; ++t) {
                     HalfGrids grids(map_.corners[t], map_.unit, search);
                     sweep.add(block, static_cast<Index>(t), grids);
                   }
                 });
  sweep.finish(stage);
}

void ElementNumbers::Sweep::finish(Stage& stage) {
  ElementNumbers& n = numbers_;
  exclusiveScan(std::span(n.begin_));
  requireNumbers(n.count());
  exclusiveScan(std::span(n.lineBegin_));
  parallelFor(stage, n.blocks_.size(), 1, [&](std::size_t block) {
    auto number = static_cast<Index>(n.begin_[block * kSweepBlock]);
    for (Line& line : n.blocks_[block]) {
      line.number = number;
      number += line.ownedCount;
    }
  });
}

/// Appends the lines with elements that a tet owns, and counts both.
void ElementNumbers::sweep(Index tet, const HalfGrids& grids, Array<Line>& lines) {
  CenterOwner owner(topology_, tet);
  std::uint64_t elements = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t before = lines.size();
    axes_[gridOf(tet, axis)] = grids.sweep(midpointsOf(kind_, axis), [&](const SweptLine& line) {
      const auto [first, count] = owner.owned(line);
      if (count == 0) return;
      lines.push_back({line, first, count, kNone});
      elements += count;
    });
    lineBegin_[gridOf(tet, axis)] = static_cast<Index>(lines.size() - before);
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

GridNumbers numberVerticesAndEdges(const PreparedMap& map, Stage& stage) {
  GridNumbers numbers{LatticeNumbers(map), ElementNumbers(map, ElementKind::Edges)};
  LatticeNumbers::Sweep vertices(numbers.vertices);
  ElementNumbers::Sweep edges(numbers.edges);
  const HalfGridSearch search(static_cast<HalfGridSet>(
      LatticeNumbers::kGrids | ElementNumbers::gridsOf(ElementKind::Edges)));
  parallelBlocks(stage, map.topology.tetCount(), kSweepBlock,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   for (std::size_t t = begin; t < end; ++t) {
                     HalfGrids grids(map.exact.corners[t], map.exact.unit, search);
                     vertices.add(block, static_cast<Index>(t), grids);
                     edges.add(block, static_cast<Index>(t), grids);
                   }
                 });
  vertices.finish(stage);
  edges.finish(stage);
  return numbers;
}

}  // namespace hexhex
