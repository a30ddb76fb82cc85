#include <algorithm>

#include <base/parallel.hpp>
#include <base/vector3.hpp>
#include <base/workspaces.hpp>
#include <improve/colours.hpp>
#include <improve/sweeps.hpp>
#include <improve/untangling.hpp>
#include <mesh/cell_measures.hpp>

namespace hexhex {

namespace {

constexpr std::size_t kGrain = 1024;
/// Vertices: a block takes some tenths of a millisecond.
constexpr std::size_t kVertexGrain = 64;

/// Rounds for the worst cells; the power of the energy meanwhile.
constexpr int kWorstRounds = 40;
constexpr int kWorstPower = 8;
/// A step smaller than this share of the cells' size does not wake the neighbours.
constexpr double kStill = 1e-3;

/// So far may boundary quads be from the surface, in diagonals: less than the 1e-3 that are
/// promised for all of the surface, since only centres are looked at.
constexpr double kChord = 3e-4;

IdealBox boxOf(const HexMesh& mesh, std::size_t cell) {
  Vec3 sums{};
  for (std::size_t e = 0; e < kHexEdges.size(); ++e) {
    const auto [a, b] = kHexEdges[e];
    const std::size_t axis = e >= 8 ? 2 : e % 2;  // in VTK's order
    sums[axis] +=
        length(minus(mesh.points[mesh.cells[cell][a]], mesh.points[mesh.cells[cell][b]])) / 4;
  }
  return idealBox(sums);
}

/// The cells, of n that `cellAt` lists, for which isWanted(scaled Jacobian, certified) holds.
template <class CellAt, class Wanted>
std::vector<Index> cellsThat(const HexMesh& mesh, std::size_t n, const CellAt& cellAt,
                             const Wanted& isWanted, Stage& stage) {
  const MeasureCells measure = measuresOfCells().back();
  return collectFromBlocks<Index>(
      stage, n, kGrain, [&](std::size_t begin, std::size_t end, std::vector<Index>& found) {
        CellMeasures measures;
        std::array<Hex, CellMeasures::kMost> cells;
        for (std::size_t c = begin; c < end; c += CellMeasures::kMost) {
          const std::size_t count = std::min(CellMeasures::kMost, end - c);
          for (std::size_t i = 0; i < count; ++i) cells[i] = mesh.cells[cellAt(c + i)];
          measure(mesh.points.data(), std::span(cells).first(count), measures);
          for (std::size_t i = 0; i < count; ++i) {
            const bool certified =
                measures.inRange[i] != 0 && measures.least[i] > measures.errorOf(i);
            if (isWanted(measures.scaled[i], certified)) found.push_back(cellAt(c + i));
          }
        }
      });
}

constexpr auto kAllCells = [](std::size_t c) { return static_cast<Index>(c); };
constexpr auto kIsBad = [](double /*scaled*/, bool certified) { return !certified; };

}  // namespace

Sweeps::Sweeps(HexMesh& mesh, VertexPlaces& places, double diagonal, Stage& stage)
    : mesh_(mesh),
      places_(places),
      stage_(stage),
      around_(cellsAroundVertices(mesh, stage)),
      boxes_(mesh.cells.size()),
      boundary_(findFaces(mesh, around_, stage).boundary),
      chord_(kChord * diagonal) {
  parallelFor(stage, boxes_.size(), kGrain, [&](std::size_t c) { boxes_[c] = boxOf(mesh, c); });
}

template <class Move>
void Sweeps::sweep(std::span<const Index> vertices, double slack, const Move& move) {
  const Colours colours(cellPoints(), vertices);
  const MovingMesh all{mesh_, places_, around_, boxes_, boundary_, chord_};
  for (std::size_t colour = 0; colour < colours.count(); ++colour) {
    const std::span<const Index> group = colours.of(colour);
    parallelForWith(
        stage_, group.size(), kVertexGrain, [&] { return VertexMover(all, slack); },
        [&](std::size_t i, VertexMover& mover) { move(mover, group[i]); });
  }
}

CellPoints Sweeps::cellPoints() const {
  static_assert(sizeof(Hex) == 8 * sizeof(Index));
  return {{reinterpret_cast<const Index*>(mesh_.cells.data()), 8 * mesh_.cells.size()},
          8,
          around_,
          mesh_.points.size()};
}

void Sweeps::untangle(double slack) {
  std::vector<Index> bad = cellsThat(mesh_, mesh_.cells.size(), kAllCells, kIsBad, stage_);
  if (bad.empty()) return;
  const Array<Vec3> points = mesh_.points;
  const Array<Index> simplices = places_.simplex;
  const UntanglingMoves moves = {
      [&](std::span<const Index> vertices, double used) {
        sweep(vertices, used, [](VertexMover& mover, Index v) { mover.untangle(v); });
      },
      [&](std::span<const Index> cells) {
        return cellsThat(
            mesh_, cells.size(), [&](std::size_t c) { return cells[c]; }, kIsBad, stage_);
      }};
  bad = untangleCells(cellPoints(), places_, moves, slack, std::move(bad));
  if (!bad.empty()) putBack(cellPoints(), bad, points, simplices, mesh_.points, places_);
}

void Sweeps::raiseWorst(double target) {
  const auto isLow = [target](double scaled, bool certified) {
    return certified && scaled < target;
  };
  std::vector<Index> low = cellsThat(mesh_, mesh_.cells.size(), kAllCells, isLow, stage_);
  // The last round in which a vertex moved: only where something moved is there something to do.
  std::vector<std::uint8_t> lastMove(low.empty() ? 0 : mesh_.points.size(), 0);
  for (int round = 1; round <= kWorstRounds && !low.empty(); ++round) {
    std::vector<Index> cells = low;
    std::vector<Index> vertices = pointsOf(cellPoints(), 1, cells);
    std::erase_if(vertices, [&](Index v) {
      if (places_.freedom[v] == Freedom::Fixed) return true;
      bool isAwake = false;
      for (const Index cell : around_(v)) {
        for (const Index other : mesh_.cells[cell]) isAwake |= lastMove[other] + 1 == round;
      }
      return !isAwake;
    });
    if (vertices.empty()) break;
    sweep(vertices, 0, [&](VertexMover& mover, Index v) {
      if (mover.smooth(v, kWorstPower, target) > kStill) {
        lastMove[v] = static_cast<std::uint8_t>(round);
      }
    });
    low = cellsThat(
        mesh_, cells.size(), [&](std::size_t c) { return cells[c]; }, isLow, stage_);
  }
}

void Sweeps::smooth(int passes, double floor) {
  if (passes == 0) return;
  std::vector<Index> vertices;
  for (Index v = 0; v < mesh_.points.size(); ++v) {
    if (places_.freedom[v] != Freedom::Fixed && !around_(v).empty()) vertices.push_back(v);
  }
  for (int pass = 0; pass < passes; ++pass) {
    sweep(vertices, 0, [&](VertexMover& mover, Index v) { mover.smooth(v, 1, floor); });
  }
}

}  // namespace hexhex
