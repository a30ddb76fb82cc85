#include <limits>
#include <string>

#include <curved/lattice_numbers.hpp>
#include <sweep/tet_positions.hpp>

namespace hexhex {

LatticeNumbers::LatticeNumbers(const PreparedMap& map) : map_(map) {
  const std::size_t tets = map.topology.tetCount();
  axes_.resize(tets);
  lineBegin_.resize(tets + 1);
  lineBegin_[tets] = 0;
  occupied_.assign((tets + 63) / 64, 0);
}

LatticeNumbers::LatticeNumbers(const PreparedMap& map, Stage& stage) : LatticeNumbers(map) {
  Sweep sweep(*this);
  const HalfGridSearch search(kGrids);
  parallelBlocks(stage, map.topology.tetCount(), kSweepBlock,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   for (std::size_t t = begin; t < end; ++t) {
                     HalfGrids grids(map.exact.corners[t], map.exact.unit, search);
                     sweep.add(block, static_cast<Index>(t), grids);
                   }
                 });
  sweep.finish(stage);
}

LatticeNumbers::Sweep::Sweep(LatticeNumbers& numbers)
    : numbers_(numbers),
      counter_(numbers.map_, numbers.numbers_),
      blocks_(blockCount(numbers.map_.topology.tetCount(), kSweepBlock)) {}

void LatticeNumbers::Sweep::sweep(std::size_t block, Index tet, HalfGrids& grids) {
  std::vector<SweptLine>& lines = blocks_[block];
  const std::size_t before = lines.size();
  numbers_.axes_[tet] = grids.sweep(0, [&](const SweptLine& line) { lines.push_back(line); });
  numbers_.lineBegin_[tet] = lines.size() - before;
  // Blocks have words of their own.
  static_assert(kSweepBlock % 64 == 0);
  const std::uint64_t isOccupied = lines.size() != before ? 1 : 0;
  numbers_.occupied_[tet / 64] |= isOccupied << (tet % 64);
  counter_.count(block, tet, std::span(lines).subspan(before));
}

void LatticeNumbers::Sweep::finish(Stage& stage) {
  LatticeNumbers& n = numbers_;
  counter_.finish();
  if (n.count() >= kNone) {
    throw Error(ErrorCode::TooLarge,
                "The mesh would have " + std::to_string(n.count()) +
                    " vertices, more than 32-bit indices can number. Lower the scale or the "
                    "order.");
  }
  exclusiveScan(std::span(n.lineBegin_));
  n.lines_.resize(n.lineBegin_.back());
  parallelBlocks(stage, n.map_.topology.tetCount(), kSweepBlock,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   std::size_t at = n.lineBegin_[begin];
                   for (const SweptLine& line : blocks_[block]) n.lines_[at++] = {line};
                   blocks_[block] = {};
                   std::vector<SweptLine> scratch;
                   for (std::size_t t = begin; t < end; ++t) {
                     const auto tet = static_cast<Index>(t);
                     if (n.hasVertices(tet)) n.number(tet, scratch);
                   }
                 });
}

/// Enters the numbers of a tet's points.
void LatticeNumbers::number(Index tet, std::vector<SweptLine>& swept) {
  const std::size_t begin = lineBegin_[tet];
  const std::size_t end = lineBegin_[std::size_t{tet} + 1];
  swept.clear();
  for (std::size_t i = begin; i < end; ++i) swept.push_back(lines_[i].swept);
  TetNumbering(map_, numbers_, tet, axes_[tet])
      .run(std::span<const SweptLine>(swept), [&](const VertexRun& run) {
        enter(lines_[begin + static_cast<std::size_t>(run.line - swept.data())], run);
      });
}

void LatticeNumbers::enter(Line& line, const VertexRun& run) {
  const auto first = static_cast<Index>(run.first);
  const std::uint32_t last = line.swept.count - 1;
  if (run.offset == 0) line.left = first;
  if (run.offset + run.count == line.swept.count) line.right = first + run.count - 1;
  if (run.offset <= 1 && run.offset + run.count > 1 && last > 1) {
    line.inner = first + (1 - run.offset);
    line.step = 1;
  } else if (run.offset == 2 && last > 2) {
    // One by one: the sweep meets the points of an edge against their order.
    line.step = static_cast<std::int32_t>(first) - static_cast<std::int32_t>(line.inner);
  }
}

const LatticeNumbers::Line* LatticeNumbers::lineAt(Index tet, const GridPoint& z,
                                                   LineHint& hint) const {
  const std::array<std::uint8_t, 3>& axes = axes_[tet]();
  return findLine(
      linesOf(tet), z[axes[0]], z[axes[1]],
      [](const Line& l) -> const SweptLine& { return l.swept; }, hint);
}

LatticeNumbers::Found LatticeNumbers::find(Index tet, const GridPoint& z, LineHint& hint) const {
  const Line* const line = lineAt(tet, z, hint);
  return line == nullptr ? Found{} : foundOn(tet, *line, z, axes_[tet]()[2]);
}

/// At the end of a line, or in a face that another tet owns.
LatticeNumbers::Found LatticeNumbers::foundAtEnd(Index tet, const Line& line, const GridPoint& z,
                                                 std::uint32_t i) const {
  const CornerMask simplex = line.swept.simplex(i);
  Index vertex = kNone;
  if (i == 0) {
    vertex = line.left;
  } else if (i + 1 == line.swept.count) {
    vertex = line.right;
  }
  if (vertex != kNone) return {vertex, simplex};
  // The tet on the other side of a face owns it.
  const HalfFace halfFace = halfFaceOf(tet, oppositeCorner(simplex));
  const Index owner = tetOf(map_.topology.mate[halfFace]);
  LineHint there;
  return {find(owner, map_.exact.transitions.across(halfFace)(z), there).vertex, simplex};
}

LatticeNumbers::OnLine::OnLine(const LatticeNumbers& numbers, Index tet, const GridPoint& z,
                               std::size_t axis, LineHint& hint)
    : numbers_(numbers),
      tet_(tet),
      axis_(axis),
      hint_(hint),
      swept_(numbers.axes_[tet]()[2] == axis),
      line_(swept_ ? numbers.lineAt(tet, z, hint) : nullptr) {}

void LatticeNumbers::describe(const VertexDescriptions& to, Stage& stage) const {
  parallelBlocks(stage, map_.topology.tetCount(), kSweepBlock,
                 [&](std::size_t begin, std::size_t end, std::size_t) {
                   std::vector<SweptLine> swept;
                   for (std::size_t t = begin; t < end; ++t) {
                     const auto tet = static_cast<Index>(t);
                     if (linesOf(tet).empty()) continue;
                     swept.clear();
                     for (const Line& line : linesOf(tet)) swept.push_back(line.swept);
                     const TetSweep sweep(map_.exact, tet, SweptGrid::Vertices);
                     const TetPositions positions(map_, tet, sweep.box, sweep.axes);
                     TetNumbering(map_, numbers_, tet, sweep.axes)
                         .run(std::span<const SweptLine>(swept), [&](const VertexRun& run) {
                           if (!run.owned) return;
                           for (std::uint32_t i = 0; i < run.count; ++i) {
                             const std::uint64_t v = run.first + i;
                             to.points[v] =
                                 positions.at(run.simplex, run.line->point(run.offset + i));
                             to.tets[v] = tet;
                             to.corners[v] = map_.input.callersCorners(run.simplex);
                           }
                         });
                   }
                 });
}

}  // namespace hexhex
