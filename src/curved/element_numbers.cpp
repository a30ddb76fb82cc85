#include <algorithm>
#include <cassert>
#include <string>

#include <curved/element_numbers.hpp>
#include <sweep/cell_order.hpp>

namespace hexhex::curved {

void requireNumbers(std::uint64_t elements) {
  if (elements < kNone) return;
  throw Error(ErrorCode::TooLarge, "The mesh would have " + std::to_string(elements) +
                                       " edges or faces, more than "
                                       "32-bit indices can number. Lower the scale.");
}

ElementNumbers::ElementNumbers(const igm::PreparedMap& map, ElementKind kind)
    : topology_(map.topology), kind_(kind) {
  const std::size_t tets = map.topology.tetCount();
  begin_.resize(tets + 1);
  begin_[tets] = 0;
  blocks_.resize(blockCount(tets, sweep::kSweepBlock));
  lineBegin_.resize(3 * tets + 1);
  lineBegin_[3 * tets] = 0;
}

ElementNumbers::ElementNumbers(const igm::PreparedMap& map, ElementKind kind, Stage& stage)
    : ElementNumbers(map, kind) {
  parallelBlocks(stage, topology_.tetCount(), sweep::kSweepBlock,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   for (std::size_t t = begin; t < end; ++t) {
                     lattice::TetRasterizer rasterizer(map.exact.corners[t], map.exact.unit);
                     add(block, static_cast<Index>(t), rasterizer);
                   }
                 });
  finish(stage);
}

/// Appends the lines with elements owned by a tet, and counts both.
void ElementNumbers::add(std::size_t block, Index tet, lattice::TetRasterizer& rasterizer) {
  assert(block == tet / sweep::kSweepBlock);
  begin_[tet] = 0;
  Array<Line>& lines = blocks_[block];
  sweep::CenterOwner owner(topology_, tet);
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t before = lines.size();
    rasterizer.sweep(midpointsOf(kind_, axis), [&](const lattice::SweptLine& line) {
      const auto [first, count] = owner.owned(line);
      if (count == 0) return;
      lines.push_back({line, first, count, kNone});
      begin_[tet] += count;
    });
    lineBegin_[gridOf(tet, axis)] = static_cast<Index>(lines.size() - before);
  }
  // Lines are not copied later, so memory reserved in excess would stay allocated.
  const bool isLast = (tet + 1) % sweep::kSweepBlock == 0;
  if (isLast) lines.shrink_to_fit();
}

void ElementNumbers::finish(Stage& stage) {
  exclusiveScan(std::span(begin_));
  requireNumbers(count());
  exclusiveScan(std::span(lineBegin_));
  parallelFor(stage, blocks_.size(), 1, [&](std::size_t block) {
    auto number = static_cast<Index>(begin_[block * sweep::kSweepBlock]);
    for (Line& line : blocks_[block]) {
      line.number = number;
      number += line.ownedCount;
    }
    assert(number == begin_[std::min((block + 1) * sweep::kSweepBlock, begin_.size() - 1)]);
  });
}

Index ElementNumbers::find(Index owner, int axis, const lattice::GridPoint& z,
                           std::size_t& hint) const {
  const std::span<const Line> lines = linesOf(owner, axis);
  const Line* const line = sweep::findLine(lines, z, hint);
  if (line != nullptr) {
    hint = static_cast<std::size_t>(line - lines.data());
    const std::uint32_t i = line->swept.indexOf(z) - line->ownedFirst;
    if (i < line->ownedCount) return line->number + i;
  }
  throw Error(ErrorCode::Internal,
              "An edge or face was not found in the tet that owns its midpoint. The map passed all "
              "checks, so this is a bug; please report it with the map.",
              {PlaceKind::Tet, owner});
}

GridNumbers EdgeObserver::finish(Stage& stage) {
  edges_.finish(stage);
  return {sweep::VertexTables(map_, std::move(*vertices_), stage), std::move(edges_)};
}

GridNumbers numberVerticesAndEdges(const igm::PreparedMap& map, Stage& stage) {
  EdgeObserver observer(map);
  observer.take(sweep::sweepVertices(map, stage, &observer));
  return observer.finish(stage);
}

}  // namespace hexhex::curved
