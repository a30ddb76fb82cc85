#include <algorithm>
#include <cmath>
#include <limits>

#include <base/vector3.hpp>
#include <improve/cell_states.hpp>
#include <improve/vertex_mover.hpp>
#include <mesh/cell_measures.hpp>

namespace hexhex::improvement {

void VertexMover::collect(Index vertex, bool bezier) {
  terms_.clear();
  straight_.clear();
  scratch_.found.clear();
  Index previous = kNone;
  for (const Index cell : all_.cells.around(vertex)) {
    if (cell == previous) continue;
    previous = cell;
    if (all_.curved == nullptr) {
      straight_.push_back(straightCell(vertex, cell));
    } else {
      all_.curved->addTerms(all_.mesh.points, cell, vertex, all_.boxes[cell], bezier, scratch_,
                            scratch_.found);
    }
  }
  if (bezier) {
    terms_.addBezier(straight_);
  } else {
    terms_.addCorners(straight_);
  }
  for (const EnergyTerm& term : scratch_.found) terms_.add(term);
}

MovingCell VertexMover::straightCell(Index vertex, Index cell) const {
  std::array<const Vec3*, 8> corners;
  std::size_t moving = 0;
  for (std::size_t place = 0; place < 8; ++place) {
    const Index corner = all_.mesh.cells[cell][mesh::kVtkCorner[place]];
    corners[place] = &all_.mesh.points[corner];
    if (corner == vertex) moving = place;
  }
  return movingCell(corners, moving, all_.boxes[cell]);
}

double VertexMover::sizeAt(Index vertex) const {
  double size = std::numeric_limits<double>::infinity();
  for (const Index cell : all_.cells.around(vertex)) {
    for (const float edge : all_.boxes[cell]) size = std::min<double>(size, edge);
  }
  return size;
}

bool VertexMover::isGoodAround(Index vertex, double least, const Exchange& exchange) {
  measured_.clear();
  forStates(all_.mesh, all_.curved, all_.cells.around(vertex), scratch_,
            [&](Index cell, const CellState& state) {
              measured_.emplace_back(cell, certifiedQuality(state));
            });
  const double floor = exchange.floor;
  const double lowest = std::min(least, floor);
  double gained = 0;
  double lost = 0;
  for (const auto& [cell, quality] : measured_) {
    const double old = all_.qualities[cell];
    if (quality < (old < floor || exchange.belowFloor ? lowest : floor)) return false;
    gained += std::min(quality, floor) - std::min(old, floor);
    lost += std::max(old, floor) - std::max(quality, floor);
  }
  return exchange.price == 0 || lost <= 0 || lost <= exchange.price * gained;
}

double VertexMover::untangle(Index vertex) {
  if (!mover_.canMove(vertex)) return 0;
  collect(vertex, true);
  return mover_.descend(vertex, terms_, PointMover::untangling(terms_), [] { return true; }) /
         sizeAt(vertex);
}

double VertexMover::leastQualityAt(Index vertex) const {
  double least = 1;
  for (const Index cell : all_.cells.around(vertex)) {
    least = std::min(least, all_.qualities[cell]);
  }
  return least;
}

void VertexMover::keepMeasured() {
  for (const auto& [cell, quality] : measured_) all_.qualities[cell] = quality;
}

double VertexMover::smooth(Index vertex, int power, const Exchange& exchange) {
  if (!mover_.canMove(vertex)) return 0;
  const double before = leastQualityAt(vertex);
  if (!isCertified(before)) return 0;
  collect(vertex, false);
  const bool bounded = all_.places.freedom[vertex] != Freedom::Free;
  const double farthest = bounded ? std::max(all_.chordError.chord, all_.chordError.at(vertex)) : 0;
  const double moved = mover_.descend(vertex, terms_, EnergyKind{power, 0, 0}, [&] {
    return isGoodAround(vertex, before, exchange) &&
           (!bounded || all_.chordError.at(vertex) <= farthest);
  });
  if (moved == 0) return 0;
  keepMeasured();
  return moved / sizeAt(vertex);
}

void VertexMover::moveBack(Index vertex, const SurfacePlace& place, double floor) {
  const double least = leastQualityAt(vertex);
  if (!isCertified(least)) return;
  const auto isGood = [&] { return isGoodAround(vertex, least, {floor}); };
  if (mover_.moveBack(vertex, place, isGood)) keepMeasured();
}

}  // namespace hexhex::improvement
