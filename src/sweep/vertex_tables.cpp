// Tables of the lines of tets, by level and row, to look up hex vertices in.
#include <algorithm>
#include <bit>
#include <cassert>
#include <string>

#include <sweep/tet_positions.hpp>
#include <sweep/vertex_tables.hpp>

namespace hexhex::sweep {

VertexTables::VertexTables(const igm::PreparedMap& map, SweptVertices swept, Stage& stage,
                           std::uint64_t room)
    : map_(map), numbers_(std::move(swept.numbers)) {
  if (numbers_.count() >= kNone) {
    throw Error(ErrorCode::TooLarge,
                "The mesh would have " + std::to_string(numbers_.count()) +
                    " vertices, more than 32-bit indices can number. Lower the scale or the "
                    "order.");
  }
  countLines(swept.lines, stage);
  enterLines(swept.lines, stage);
  makeTables(room, stage);
}

void VertexTables::countLines(const TetLines& lines, Stage& stage) {
  const std::size_t tets = map_.topology.tetCount();
  lineBegin_.resize(tets + 1);
  lineBegin_[tets] = 0;
  occupied_.assign((tets + 63) / 64, 0);
  static_assert(kSweepBlock % 64 == 0);  // blocks share no words
  parallelFor(stage, tets, kSweepBlock, [&](std::size_t t) {
    lineBegin_[t] = lines.of(static_cast<Index>(t)).size();
    if (lineBegin_[t] != 0) occupied_[t / 64] |= std::uint64_t{1} << (t % 64);
  });
  lines_.resize(exclusiveScan(std::span(lineBegin_)));
}

/// Moves the lines in, block by block.
void VertexTables::enterLines(TetLines& lines, Stage& stage) {
  parallelBlocks(stage, map_.topology.tetCount(), kSweepBlock,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   const Array<lattice::SweptLine> swept = lines.takeBlock(block);
                   const std::size_t first = lineBegin_[begin];
                   for (std::size_t i = 0; i < swept.size(); ++i) lines_[first + i] = {swept[i]};
                   for (std::size_t t = begin; t < end; ++t) {
                     if (lineBegin_[t] == lineBegin_[t + 1]) continue;
                     numberLines(static_cast<Index>(t),
                                 std::span<const lattice::SweptLine>(swept).subspan(
                                     lineBegin_[t] - first, lineBegin_[t + 1] - lineBegin_[t]));
                   }
                 });
}

void VertexTables::numberLines(Index tet, std::span<const lattice::SweptLine> swept) {
  const std::size_t begin = lineBegin_[tet];
  TetNumbering(map_, numbers_, tet, swept.front().axes).run(swept, [&](const VertexRun& run) {
    lines_[begin + static_cast<std::size_t>(run.line - swept.data())].enter(run);
  });
}

void VertexTables::Line::enter(const VertexRun& run) {
  const auto first = static_cast<Index>(run.first);
  const std::uint32_t last = swept.count - 1;
  assert(run.count > 0 && run.offset + run.count <= swept.count);
  if (run.offset == 0) left = first;
  if (run.offset + run.count == swept.count) right = first + run.count - 1;
  if (run.offset <= 1 && run.offset + run.count > 1 && last > 1) {
    inner = first + (1 - run.offset);
    step = 1;
  } else if (run.offset == 2 && last > 2) {
    // One by one: the sweep visits the points of an edge in reverse order.
    step = static_cast<std::int32_t>(first) - static_cast<std::int32_t>(inner);
  }
}

/// Call when all lines have their numbers.
void VertexTables::makeTables(std::uint64_t room, Stage& stage) {
  const std::size_t tets = map_.topology.tetCount();
  boxOf_.resize(tets);
  Index boxes = 0;
  for (std::size_t t = 0; t < tets; ++t) {
    boxOf_[t] = boxes;
    if (hasVertices(static_cast<Index>(t))) ++boxes;
  }
  boxes_.resize(boxes);
  const auto forEachBox = [&](const auto& visit) {
    parallelFor(stage, tets, kSweepBlock, [&](std::size_t t) {
      const auto tet = static_cast<Index>(t);
      if (hasVertices(tet)) visit(tet, boxes_[boxOf_[t]]);
    });
  };
  forEachBox([&](Index tet, Box& box) { box = measureBox(tet, room); });
  std::uint64_t places = 0;
  for (Box& box : boxes_) {
    if (box.begin == kNoTable) continue;
    box.begin = places;
    places += box.places();
  }
  tables_.resize(places);
  forEachBox([&](Index tet, const Box& box) {
    if (box.begin != kNoTable) fillTable(tet, box);
  });
}

/// `begin` is kNoTable if the tet gets no table, and otherwise yet to be set.
VertexTables::Box VertexTables::measureBox(Index tet, std::uint64_t room) const {
  const std::span<const Line> lines = linesOf(tet);
  std::array<std::int32_t, 2> low = {lines.front().swept.level, lines.front().swept.row};
  std::array<std::int32_t, 2> high = low;
  for (const Line& line : lines) {
    const std::array<std::int32_t, 2> at = {line.swept.level, line.swept.row};
    for (std::size_t k = 0; k < 2; ++k) {
      low[k] = std::min(low[k], at[k]);
      high[k] = std::max(high[k], at[k]);
    }
  }
  Box box;
  box.axes = lines.front().swept.axes;
  box.first = low;
  for (std::size_t k = 0; k < 2; ++k) {
    box.size[k] = static_cast<std::uint32_t>(high[k] - low[k] + 1);
  }
  if (box.places() > room * lines.size()) box.begin = kNoTable;
  return box;
}

void VertexTables::fillTable(Index tet, const Box& box) {
  Index* const table = tables_.data() + box.begin;
  std::fill_n(table, box.places(), kNone);
  Index number = 0;
  for (const Line& line : linesOf(tet)) {
    const auto level = static_cast<std::uint64_t>(line.swept.level - box.first[0]);
    const auto row = static_cast<std::uint64_t>(line.swept.row - box.first[1]);
    assert(level < box.size[0] && row < box.size[1]);
    assert(table[level * box.size[1] + row] == kNone);  // one line per row
    table[level * box.size[1] + row] = number++;
  }
}

unsigned VertexTables::occupiedSimplices(Index tet) const noexcept {
  unsigned simplices = 0;
  for (const Line& line : linesOf(tet)) {
    simplices |= (1U << line.swept.left) | (1U << line.swept.right);
    if (line.swept.count > 2) simplices |= 1U << line.swept.inner();
  }
  return simplices;
}

/// The i-th vertex of a line, at grid point z.
VertexTables::Found VertexTables::foundOn(Index tet, const Line& line, const lattice::GridPoint& z,
                                          std::uint32_t i) const {
  assert(i < line.swept.count);
  const lattice::CornerMask simplex = line.swept.simplex(i);
  const bool isLast = i + 1 == line.swept.count;
  Index vertex = i == 0 ? line.left : (isLast ? line.right : line.inner);
  if (vertex != kNone) {
    if (i > 0 && !isLast) {
      vertex += static_cast<Index>(line.step * static_cast<std::int32_t>(i - 1));
    }
    return {vertex, simplex};
  }
  // The tet on the other side of a face owns it.
  assert(lattice::dimension(simplex) == 2);
  const adjacency::HalfFace halfFace = adjacency::halfFaceOf(tet, lattice::oppositeCorner(simplex));
  const Index owner = adjacency::tetOf(map_.topology.mate[halfFace]);
  assert(owner < tet);
  return {find(owner, map_.exact.transitions.across(halfFace)(z)).vertex, simplex};
}

void VertexTables::describe(const VertexDescriptions& to, Stage& stage) const {
  assert(to.points.size() == count() && to.tets.size() == count() && to.corners.size() == count());
  parallelBlocks(
      stage, map_.topology.tetCount(), kSweepBlock,
      [&](std::size_t begin, std::size_t end, std::size_t) {
        std::vector<lattice::SweptLine> swept;
        for (std::size_t t = begin; t < end; ++t) {
          const auto tet = static_cast<Index>(t);
          if (!hasVertices(tet)) continue;
          swept.clear();
          for (const Line& line : linesOf(tet)) swept.push_back(line.swept);
          const lattice::SweepAxes axes = swept.front().axes;
          const TetPositions positions(map_, tet, axes);
          TetNumbering(map_, numbers_, tet, axes)
              .run(std::span<const lattice::SweptLine>(swept), [&](const VertexRun& run) {
                if (!run.owned) return;
                for (std::uint32_t i = 0; i < run.count; ++i) {
                  const std::uint64_t v = run.first + i;
                  to.points[v] = positions.at(run.simplex, run.line->point(run.offset + i));
                  to.tets[v] = tet;
                  to.corners[v] = map_.input.callersCorners(run.simplex);
                }
              });
        }
      });
}

}  // namespace hexhex::sweep
