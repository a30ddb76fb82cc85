#include <algorithm>
#include <bit>
#include <string>
#include <utility>

#include <curved/lattice_numbers.hpp>
#include <sweep/tet_positions.hpp>

namespace hexhex {

LatticeNumbers::LatticeNumbers(const PreparedMap& map, std::uint64_t room)
    : map_(map), room_(room) {
  const std::size_t tets = map.topology.tetCount();
  axes_.resize(tets);
  lineBegin_.resize(tets + 1);
  lineBegin_[tets] = 0;
  occupied_.assign((tets + 63) / 64, 0);
  boxOf_.resize(tets);
}

LatticeNumbers::LatticeNumbers(const PreparedMap& map, std::uint64_t room, Stage& stage)
    : LatticeNumbers(map, room) {
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

LatticeNumbers::LatticeNumbers(const PreparedMap& map, const LatticeLines& lines,
                               std::uint64_t count, Stage& stage)
    : map_(map),
      room_(0),
      engineLines_(&lines),
      engineCount_(count),
      occupied_((map.topology.tetCount() + 63) / 64) {
  const std::size_t tets = map.topology.tetCount();
  constexpr std::size_t kWords = 64;
  parallelFor(stage, occupied_.size(), kWords, [&](std::size_t word) {
    std::uint64_t bits = 0;
    for (std::size_t t = 64 * word; t < std::min(tets, 64 * (word + 1)); ++t) {
      bits |= std::uint64_t{lines.empty(static_cast<Index>(t)) ? 0U : 1U} << (t % 64);
    }
    occupied_[word] = bits;
  });
}

LatticeNumbers::Sweep::Sweep(LatticeNumbers& numbers)
    : numbers_(numbers),
      counter_(numbers.map_, numbers.numbers_),
      blocks_(blockCount(numbers.map_.topology.tetCount(), kSweepBlock)) {}

LatticeNumbers::LatticeNumbers(const PreparedMap& map, SweptVertices swept, Stage& stage)
    : LatticeNumbers(map) {
  numbers_ = std::move(swept.numbers);
  parallelBlocks(stage, map.topology.tetCount(), kSweepBlock,
                 [&](std::size_t begin, std::size_t end, std::size_t) {
                   for (std::size_t t = begin; t < end; ++t) {
                     const auto tet = static_cast<Index>(t);
                     noteLines(tet, swept.lines.of(tet));
                   }
                 });
  numberLines([&](std::size_t block) { return swept.lines.takeBlock(block); }, stage);
}

void LatticeNumbers::Sweep::sweep(std::size_t block, Index tet, const HalfGrids& grids) {
  std::vector<SweptLine>& lines = blocks_[block];
  const std::size_t before = lines.size();
  appendLines(grids, kVertexGrid, lines);
  const auto own = std::span(lines).subspan(before);
  numbers_.noteLines(tet, own);
  counter_.count(block, tet, own);
}

void LatticeNumbers::Sweep::finish(Stage& stage) {
  counter_.finish();
  if (numbers_.count() >= kNone) {
    throw Error(ErrorCode::TooLarge,
                "The mesh would have " + std::to_string(numbers_.count()) +
                    " vertices, more than 32-bit indices can number. Lower the scale or the "
                    "order.");
  }
  numbers_.numberLines([&](std::size_t block) { return std::exchange(blocks_[block], {}); }, stage);
}

/// Enters how many lines a tet has, and in which order it was swept.
void LatticeNumbers::noteLines(Index tet, std::span<const SweptLine> lines) noexcept {
  axes_[tet] = lines.empty() ? SweepAxes{} : lines.front().axes;
  lineBegin_[tet] = lines.size();
  // Blocks have words of their own.
  static_assert(kSweepBlock % 64 == 0);
  occupied_[tet / 64] |= std::uint64_t{lines.empty() ? 0U : 1U} << (tet % 64);
}

/// When the lines of all tets have been noted and the vertices have numbers.
/// @param takeBlock  gives the lines of a block of tets away
template <class TakeBlock>
void LatticeNumbers::numberLines(const TakeBlock& takeBlock, Stage& stage) {
  exclusiveScan(std::span(lineBegin_));
  lines_.resize(lineBegin_.back());
  const std::vector<std::size_t> boxes = countBoxes();
  std::vector<std::uint64_t> points(boxes.size());
  parallelBlocks(stage, map_.topology.tetCount(), kSweepBlock,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   const auto swept = takeBlock(block);
                   std::size_t at = lineBegin_[begin];
                   for (const SweptLine& line : swept) lines_[at++] = {line};
                   std::size_t box = boxes[block];
                   for (std::size_t t = begin; t < end; ++t) {
                     const auto tet = static_cast<Index>(t);
                     if (!hasVertices(tet)) continue;
                     const std::size_t own = lineBegin_[t] - lineBegin_[begin];
                     number(tet, std::span<const SweptLine>(swept).subspan(
                                     own, lineBegin_[t + 1] - lineBegin_[t]));
                     boxOf_[tet] = static_cast<Index>(box);
                     const Box& measured = boxes_[box++] = measureBox(tet);
                     if (measured.begin < kNoTable) points[block] += measured.points();
                   }
                 });
  fillBoxes(points, stage);
}

/// Makes room for the boxes.
/// @return the first one per block of tets
std::vector<std::size_t> LatticeNumbers::countBoxes() {
  std::vector<std::size_t> boxes(blockCount(map_.topology.tetCount(), kSweepBlock));
  for (std::size_t word = 0; word < occupied_.size(); ++word) {
    boxes[word / (kSweepBlock / 64)] += static_cast<std::size_t>(std::popcount(occupied_[word]));
  }
  boxes_.resize(exclusiveScan(std::span(boxes)));
  return boxes;
}

/// When all tets have the numbers of what they own.
/// @param points  of the tables, by block of tets
void LatticeNumbers::fillBoxes(std::vector<std::uint64_t>& points, Stage& stage) {
  const std::uint64_t count = exclusiveScan(std::span(points));
  boxVertices_.resize(count);
  boxSimplices_.resize(count);
  parallelBlocks(stage, map_.topology.tetCount(), kSweepBlock,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   for (std::size_t t = begin; t < end; ++t) {
                     const auto tet = static_cast<Index>(t);
                     if (!hasVertices(tet) || boxes_[boxOf_[tet]].begin >= kNoTable) continue;
                     fillBox(tet, points[block]);
                     points[block] += boxes_[boxOf_[tet]].points();
                   }
                 });
}

/// Enters the numbers of a tet's points.
void LatticeNumbers::number(Index tet, std::span<const SweptLine> swept) {
  const std::size_t begin = lineBegin_[tet];
  TetNumbering(map_, numbers_, tet, axes_[tet]).run(swept, [&](const VertexRun& run) {
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

/// Without its place in the tables, unless it is known to need none.
LatticeNumbers::Box LatticeNumbers::measureBox(Index tet) const {
  const std::span<const Line> lines = linesOf(tet);
  const std::array<std::uint8_t, 3>& axes = axes_[tet]();
  const SweptLine& front = lines.front().swept;
  std::array<std::int32_t, 3> low = {front.level, front.row, front.first};
  std::array<std::int32_t, 3> high = {lines.back().swept.level, front.row, front.first};
  std::uint64_t points = 0;
  for (const Line& line : lines) {
    const auto count = static_cast<std::int32_t>(line.swept.count);
    low[1] = std::min(low[1], line.swept.row);
    high[1] = std::max(high[1], line.swept.row);
    low[2] = std::min(low[2], line.swept.first);
    high[2] = std::max(high[2], line.swept.first + count - 1);
    points += line.swept.count;
  }
  Box box;
  for (std::size_t k = 0; k < 3; ++k) {
    box.first[axes[k]] = low[k];
    box.size[axes[k]] = static_cast<std::uint32_t>(high[k] - low[k] + 1);
  }
  if (box.points() > room_ * points) {
    box.begin = kLarge;
  } else if (points == 1 && lines.front().left != kNone) {
    box.begin = beginOfOnly({lines.front().left, front.left});
  }
  return box;
}

/// @param begin  of the box in the tables
void LatticeNumbers::fillBox(Index tet, std::uint64_t begin) {
  Box& box = boxes_[boxOf_[tet]];
  box.begin = begin;
  std::fill_n(boxVertices_.data() + begin, box.points(), kNone);
  std::fill_n(boxSimplices_.data() + begin, box.points(), kNoSimplex);
  const std::array<std::uint8_t, 3>& axes = axes_[tet]();
  const std::array<std::size_t, 3> strides = {std::size_t{box.size[1]} * box.size[2], box.size[2],
                                              1};
  for (const Line& line : linesOf(tet)) {
    GridPoint z = line.swept.point(0);
    std::size_t at = begin;
    for (std::size_t k = 0; k < 3; ++k) {
      at += strides[k] * static_cast<std::size_t>(z[k] - box.first[k]);
    }
    for (std::uint32_t i = 0; i < line.swept.count; ++i) {
      const Found found = foundOn(tet, line, z, i);
      boxVertices_[at] = found.vertex;
      boxSimplices_[at] = found.simplex;
      at += strides[axes[2]];
      ++z[axes[2]];
    }
  }
}

LatticeNumbers::Found LatticeNumbers::findOnLines(Index tet, const GridPoint& z) const {
  const std::array<std::uint8_t, 3>& axes = axes_[tet]();
  LineHint hint;
  const Line* const line = findLine(
      linesOf(tet), z[axes[0]], z[axes[1]],
      [](const Line& l) -> const SweptLine& { return l.swept; }, hint);
  if (line == nullptr) return {};
  const auto i = static_cast<std::uint32_t>(z[axes[2]] - line->swept.first);
  return i < line->swept.count ? foundOn(tet, *line, z, i) : Found{};
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
  return {findOnLines(owner, map_.exact.transitions.across(halfFace)(z)).vertex, simplex};
}

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
