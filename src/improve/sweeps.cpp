#include <algorithm>

#include <base/parallel.hpp>
#include <base/vector3.hpp>
#include <base/workspaces.hpp>
#include <improve/cell_states.hpp>
#include <improve/sweeps.hpp>
#include <improve/untangling.hpp>

namespace hexhex {

namespace {

constexpr std::size_t kGrain = 1024;
/// Vertices: a block takes some tenths of a millisecond.
constexpr std::size_t kVertexGrain = 64;
constexpr std::size_t kCurvedGrain = 8;

/// Powers of the energy for the worst cells, and rounds for each: the low ones get far soon where
/// many cells are bad, the high ones help the last.
constexpr std::array<int, 4> kWorstPowers = {1, 2, 4, 8};
constexpr int kWorstRounds = 10;
/// A step smaller than this share of the cells' size does not wake the neighbours.
constexpr double kStill = 1e-3;

/// So far may boundary quads be from the surface, in diagonals: less than the 1e-3 that are
/// promised for all of the surface, since only centres are looked at.
constexpr double kChord = 3e-4;

IdealBox boxOf(const Array<Vec3>& points, const Hex& cell) {
  Vec3 sums{};
  for (std::size_t e = 0; e < kHexEdges.size(); ++e) {
    const auto [a, b] = kHexEdges[e];
    const std::size_t axis = e >= 8 ? 2 : e % 2;  // in VTK's order
    sums[axis] += length(minus(points[cell[a]], points[cell[b]])) / 4;
  }
  return idealBox(sums);
}

constexpr auto kAllCells = [](std::size_t c) { return static_cast<Index>(c); };
constexpr auto kIsBad = [](const CellState& state) { return !state.certified; };

}  // namespace

Sweeps::Sweeps(HexMesh& mesh, const CurvedCells* curved, VertexPlaces& places, double diagonal,
               Stage& stage)
    : mesh_(mesh),
      curved_(curved),
      places_(places),
      stage_(stage),
      meshAround_(cellsAroundVertices(mesh, stage)),
      nodeAround_(curved != nullptr ? curved->cellsAroundNodes(stage) : VertexCells()),
      boundary_(findFaces(mesh, meshAround_, stage).boundary),
      chord_(kChord * diagonal) {
  boxes_.resize(cellPoints().cellCount());
  parallelFor(stage, boxes_.size(), kGrain, [&](std::size_t c) {
    boxes_[c] = boxOf(mesh.points, curved != nullptr ? curved->cornersOf(c) : mesh.cells[c]);
  });
}

CellPoints Sweeps::cellPoints() const {
  if (curved_ != nullptr) return curved_->points(nodeAround_);
  static_assert(sizeof(Hex) == 8 * sizeof(Index));
  return {{reinterpret_cast<const Index*>(mesh_.cells.data()), 8 * mesh_.cells.size()},
          8,
          meshAround_,
          mesh_.points.size()};
}

template <class CellAt, class Wanted>
std::vector<Index> Sweeps::cellsThat(std::size_t n, const CellAt& cellAt,
                                     const Wanted& isWanted) const {
  return collectFromBlocks<Index>(
      stage_, n, curved_ != nullptr ? kCurvedGrain : kGrain,
      [&](std::size_t begin, std::size_t end, std::vector<Index>& found) {
        CurvedCells::Scratch scratch;
        std::vector<Index> list;
        for (std::size_t c = begin; c < end; ++c) list.push_back(cellAt(c));
        forStates(mesh_, curved_, list, scratch, [&](Index cell, const CellState& state) {
          if (isWanted(state)) found.push_back(cell);
        });
      });
}

template <class Move>
void Sweeps::sweep(std::span<const Index> vertices, double slack, const Move& move) {
  const CellPoints cells = cellPoints();
  if (!colours_) colours_.emplace(cells);
  const Colours::Groups groups = colours_->groupsOf(vertices);
  const ChordError chordError{mesh_, places_, meshAround_, boundary_, chord_};
  const MovingMesh all{mesh_, curved_, cells, boxes_, places_, chordError};
  std::size_t begin = 0;
  for (const std::size_t end : groups.ends) {
    const auto group = std::span(groups.vertices).subspan(begin, end - begin);
    begin = end;
    parallelForWith(
        stage_, group.size(), curved_ != nullptr ? kCurvedGrain : kVertexGrain,
        [&] { return VertexMover(all, slack); },
        [&](std::size_t i, VertexMover& mover) { move(mover, group[i]); });
  }
}

void Sweeps::untangle(double slack) {
  std::vector<Index> bad = cellsThat(boxes_.size(), kAllCells, kIsBad);
  if (bad.empty()) return;
  const Array<Vec3> points = mesh_.points;
  const Array<Index> simplices = places_.simplex;
  const UntanglingMoves moves = {
      [&](std::span<const Index> vertices, double used) {
        sweep(vertices, used, [](VertexMover& mover, Index v) { mover.untangle(v); });
      },
      [&](std::span<const Index> cells) {
        return cellsThat(
            cells.size(), [&](std::size_t c) { return cells[c]; }, kIsBad);
      }};
  Neighbourhoods near(cellPoints());
  bad = untangleCells(near, places_, moves, slack, std::move(bad));
  if (!bad.empty()) putBack(cellPoints(), bad, points, simplices, mesh_.points, places_);
}

void Sweeps::raiseWorst(double target) {
  const auto isLow = [target](const CellState& state) {
    return state.certified && state.scaled < target;
  };
  std::vector<Index> low = cellsThat(boxes_.size(), kAllCells, isLow);
  if (low.empty()) return;
  const CellPoints all = cellPoints();
  Neighbourhoods near(all);
  // The last round in which a vertex moved: only where something moved is there something to do.
  std::vector<std::uint8_t> lastMove(mesh_.points.size(), 0);
  std::uint8_t round = 0;
  for (const int power : kWorstPowers) {
    for (int i = 0; i < kWorstRounds && !low.empty(); ++i) {
      std::vector<Index> cells = low;
      std::vector<Index> vertices = near.pointsOf(1, cells);
      std::erase_if(vertices, [&](Index v) {
        if (places_.freedom[v] == Freedom::Fixed) return true;
        bool isAwake = i == 0;
        for (const Index cell : all.around(v)) {
          for (const Index other : all.of(cell)) isAwake |= lastMove[other] == round;
        }
        return !isAwake;
      });
      if (vertices.empty()) break;
      ++round;
      sweep(vertices, 0, [&](VertexMover& mover, Index v) {
        if (mover.smooth(v, power, target) > kStill) lastMove[v] = round;
      });
      low = cellsThat(
          cells.size(), [&](std::size_t c) { return cells[c]; }, isLow);
    }
  }
}

void Sweeps::smooth(int passes, double floor) {
  if (passes == 0) return;
  const CellPoints all = cellPoints();
  std::vector<Index> vertices;
  for (Index v = 0; v < mesh_.points.size(); ++v) {
    if (places_.freedom[v] != Freedom::Fixed && !all.around(v).empty()) vertices.push_back(v);
  }
  for (int pass = 0; pass < passes; ++pass) {
    sweep(vertices, 0, [&](VertexMover& mover, Index v) { mover.smooth(v, 1, floor); });
  }
}

}  // namespace hexhex
