#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

#include <base/parallel.hpp>
#include <base/sorted.hpp>
#include <base/vector3.hpp>
#include <base/workspaces.hpp>
#include <improve/all_at_once.hpp>
#include <improve/sweeps.hpp>

namespace hexhex::improvement {

Colours::Colours(const CellPoints& mesh) : colourOf_(mesh.pointCount) {
  // Greedy colouring: each vertex gets the first colour that no earlier neighbour has.
  std::vector<Index> takenBy;  // per colour: the last vertex that has a neighbour of this colour
  for (Index v = 0; v < mesh.pointCount; ++v) {
    for (const Index cell : mesh.around(v)) {
      for (const Index other : mesh.of(cell)) {
        if (other < v) takenBy[colourOf_[other]] = v;
      }
    }
    const auto colour = static_cast<std::size_t>(
        std::find_if(takenBy.begin(), takenBy.end(), [v](Index by) { return by != v; }) -
        takenBy.begin());
    if (colour == takenBy.size()) takenBy.push_back(kNone);
    colourOf_[v] = static_cast<std::uint16_t>(colour);
  }
  count_ = takenBy.size();
  assert(count_ <= std::numeric_limits<std::uint16_t>::max());
  assert(separates(mesh));
}

/// Whether all points of each cell differ in colour.
bool Colours::separates(const CellPoints& mesh) const {
  std::vector<std::size_t> seenIn(count_, mesh.cellCount());
  for (std::size_t cell = 0; cell < mesh.cellCount(); ++cell) {
    for (const Index point : mesh.of(cell)) {
      if (std::exchange(seenIn[colourOf_[point]], cell) == cell) return false;
    }
  }
  return true;
}

Colours::Groups Colours::groupsOf(std::vector<Index> vertices) const {
  Groups groups;
  groups.ends.resize(count_);
  for (const Index v : vertices) ++groups.ends[colourOf_[v]];
  std::vector<std::size_t> next(count_);
  for (std::size_t c = 1; c < count_; ++c) {
    next[c] = groups.ends[c - 1];
    groups.ends[c] += groups.ends[c - 1];
  }
  groups.vertices.resize(vertices.size());
  for (const Index v : vertices) groups.vertices[next[colourOf_[v]]++] = v;
  return groups;
}

LooseVertices::LooseVertices(VertexPlaces& places, std::span<const Index> vertices,
                             const Array<Vec3>& points)
    : places_(places) {
  for (const Index v : vertices) {
    const Held held{v, places.freedom[v], places.simplex[v], points[v]};
    if (!places.surface.isCrease(held.freedom, held.simplex)) continue;
    assert(!places.isLoose[v]);
    held_.push_back(held);
    places.simplex[v] = places.surface.triangleAt(held.freedom, held.simplex, held.point);
    places.freedom[v] = Freedom::OnPatch;
    places.isLoose[v] = true;
  }
}

std::vector<Index> LooseVertices::holdUnmoved(const Array<Vec3>& points) {
  std::vector<Index> moved;
  for (const Held& held : held_) {
    const Index v = held.vertex;
    if (points[v] != held.point) {
      moved.push_back(v);
      continue;
    }
    places_.freedom[v] = held.freedom;
    places_.simplex[v] = held.simplex;
    places_.isLoose[v] = false;
  }
  return moved;
}

namespace {

constexpr std::size_t kSweepsGrain = 1024;
/// Cells to measure, and vertices to move, per block: both take some milliseconds if cells are
/// curved, and tens of microseconds if they are straight.
constexpr std::size_t kMeasureGrain = 128;
constexpr std::size_t kVertexGrain = 16;

/// Untangling: rounds without progress before another ring of vertices takes part, and maximum
/// number of rings. The slack starts at a fraction of what is allowed, and grows by a factor.
constexpr int kPatience = 10;
constexpr int kMostRings = 4;
constexpr double kFirstSlack = 0.1;
constexpr double kSlackGrowth = 2.16;

/// Powers of the energy for the worst cells: low ones make fast progress while many cells are bad,
/// the high one improves the last. Rounds per power at most: with ten, vertices come to rest at low
/// powers; that takes twice as long with curved cells, and minima are lower in the end.
constexpr std::array<int, 3> kWorstPowers = {1, 2, 8};
constexpr int kWorstRounds = 4;

/// With powers above 1, cells above the target may lose at most this many times what those below
/// gain. Without a limit, cells that can hardly get better degrade all cells around them: the mean
/// of a mesh with a corner that cannot be improved fell from 0.73 to 0.41. With 10, some cells stay
/// below the target that could reach it.
constexpr double kPrice = 30;

/// If more cells than this are below the target, no cell that meets it may fall below it
/// temporarily: many would stay there, and all vertices that moved with them would be restored and
/// moved again. The same holds for curved cells: 1,749 of order 2 would take 5.0 s instead of 2.9
/// s, for the same minimum.
constexpr std::size_t kMostFalling = 5'000;

/// If more than this part of all cells may be below the target, they are searched for among all:
/// their list, kept while vertices move, would be part of the peak of memory.
constexpr std::size_t kManyLow = 16;

/// Steps below this fraction of the size of cells do not reactivate neighbours.
constexpr double kStill = 1e-3;

/// Rings of cells around those below the target that move at once: enough for whole models of
/// thousands of cells; fewer where there would be more than kMostCellsAtOnce, which take some
/// seconds.
constexpr int kMostRingsAtOnce = 20;
constexpr int kLeastRingsAtOnce = 3;
constexpr std::size_t kMostCellsAtOnce = 20'000;
/// Maximum number of rounds; one that reduces the sum of 1 - quality by less than kStallAtOnce
/// counts as stalled.
constexpr int kMostRoundsAtOnce = 10;
/// Maximum of rounds times cells, each of which takes a tenth of a millisecond: if cells are only
/// below the target, and if most are inverted, since nothing else repairs these.
constexpr std::size_t kMostWorkAtOnce = 100'000;
constexpr std::size_t kMostWorkFolded = 300'000;
constexpr double kStallAtOnce = 0.01;
/// Maximum number of stalled rounds, in all. A single one may be due to folds that arise on the way
/// back to the surface.
constexpr std::size_t kStallsAtOnce = 3;

/// Maximum distance of boundary quads from the surface, in diagonals: less than the 1e-3 promised
/// for the entire surface, since only centres and midpoints of edges on curves are sampled.
constexpr double kChord = 3e-4;
/// A vertex is on the surface if it is nearer than this fraction of the chord error.
constexpr double kNearEnough = 1e-6;

IdealBox boxOf(const Array<Vec3>& points, const Hex& cell) {
  Vec3 sums{};
  for (std::size_t e = 0; e < adjacency::kHexEdges.size(); ++e) {
    const auto [a, b] = adjacency::kHexEdges[e];
    const std::size_t axis = e >= 8 ? 2 : e % 2;  // in VTK's order
    sums[axis] += length(minus(points[cell[a]], points[cell[b]])) / 4;
  }
  return idealBox(sums);
}

constexpr auto kIsBad = [](double quality) { return !isCertified(quality); };

}  // namespace

Sweeps::Sweeps(const Subject& subject, VertexPlaces& places, const Positions& initial,
               double diagonal, Stage& stage)
    : mesh_(subject.mesh),
      places_(places),
      initial_(initial),
      stage_(stage),
      meshAround_(adjacency::cellsAroundVertices(mesh_, stage)),
      cells_(subject.cells(meshAround_, stage)),
      boundary_(adjacency::findFaces(mesh_, meshAround_, stage).boundary),
      chord_(kChord * diagonal) {
  boxes_.resize(cellPoints().cellCount());
  takeBoxes();
  qualities_.resize(boxes_.size());
  measureAll();
}

void Sweeps::takeBoxes() {
  parallelFor(stage_, boxes_.size(), kSweepsGrain,
              [&](std::size_t c) { boxes_[c] = boxOf(mesh_.points, cells_->cornersOf(c)); });
}

template <class CellAt>
void Sweeps::measure(std::size_t n, const CellAt& cellAt) {
  parallelBlocks(
      stage_, n, kMeasureGrain, [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
        ImprovedCells::Scratch scratch;
        std::array<Index, kMeasureGrain> list;
        std::array<double, kMeasureGrain> qualities;
        for (std::size_t c = begin; c < end; ++c) list[c - begin] = cellAt(c);
        cells_->measure(mesh_.points, std::span(list).first(end - begin), scratch, qualities);
        for (std::size_t c = begin; c < end; ++c)
          qualities_[list[c - begin]] = qualities[c - begin];
      });
}

void Sweeps::measureAll() {
  measure(boxes_.size(), [](std::size_t c) { return static_cast<Index>(c); });
}

template <class Wanted>
std::vector<Index> Sweeps::cellsThat(const Wanted& isWanted) const {
  std::vector<Index> list;
  list.reserve(
      static_cast<std::size_t>(std::count_if(qualities_.begin(), qualities_.end(), isWanted)));
  for (Index cell = 0; cell < qualities_.size(); ++cell) {
    if (isWanted(qualities_[cell])) list.push_back(cell);
  }
  return list;
}

template <class Wanted>
std::vector<Index> Sweeps::movable(std::vector<Index> list, const Wanted& isWanted) const {
  const CellPoints all = cellPoints();
  std::erase_if(list, [&](Index cell) {
    return !isWanted(qualities_[cell]) || places_.areHeld(all.of(cell));
  });
  return list;
}

template <class Wanted>
std::vector<Index> Sweeps::movableCells(const Wanted& isWanted) const {
  return movable(cellsThat(isWanted), isWanted);
}

template <class Wanted>
std::vector<Index> Sweeps::verticesThat(const Wanted& isWanted) const {
  std::vector<Index> list;
  for (Index v = 0; v < mesh_.points.size(); ++v) {
    if (isWanted(v)) list.push_back(v);
  }
  return list;
}

template <class Move>
void Sweeps::sweep(std::vector<Index> vertices, double slack, const Move& move) {
  const CellPoints cells = cellPoints();
  if (!colours_) colours_.emplace(cells);
  const Colours::Groups groups = colours_->groupsOf(std::move(vertices));
  const ChordError chordError{mesh_, places_, meshAround_, boundary_, std::max(chord_, slack)};
  const MovingMesh all{mesh_, *cells_, boxes_, places_, chordError, qualities_};
  std::size_t begin = 0;
  for (const std::size_t end : groups.ends) {
    const auto group = std::span(groups.vertices).subspan(begin, end - begin);
    begin = end;
    parallelForWith(
        stage_, group.size(), kVertexGrain, [&] { return VertexMover(all, slack); },
        [&](std::size_t i, VertexMover& mover) { move(mover, group[i]); });
  }
}

std::vector<Index> Sweeps::untangleCells(Neighbourhoods& near, double slack,
                                         std::vector<Index> bad) {
  std::size_t fewest = bad.size();
  int since = 0;
  for (int rings = 0; rings <= kMostRings && !bad.empty();) {
    std::vector<Index> cells = bad;
    std::vector<Index> vertices = near.pointsOf(rings, cells);
    std::erase_if(vertices, [&](Index v) { return places_.freedom[v] == Freedom::Fixed; });
    sweep(std::move(vertices), slack, [](VertexMover& mover, Index v) { mover.untangle(v); });
    measure(cells.size(), [&](std::size_t c) { return cells[c]; });
    bad = movable(std::move(cells), kIsBad);
    ++since;
    if (bad.size() < fewest) {
      fewest = bad.size();
      since = 0;
    } else if (since > kPatience) {
      since = 0;
      ++rings;
    }
  }
  return bad;
}

void Sweeps::untangle(double slack) {
  std::vector<Index> bad = movableCells(kIsBad);
  if (bad.empty()) return;
  // Most often these are the initial positions, and a copy would be the peak of memory.
  const bool isFirst = initial_.arePresent(mesh_.points, places_);
  const std::optional<Positions> copy = isFirst ? std::nullopt : std::optional(positions());
  const Positions& before = isFirst ? initial_ : *copy;
  Neighbourhoods near(cellPoints());
  bad = untangleCells(near, 0, std::move(bad));
  for (double used = kFirstSlack * slack; slack > 0 && used < 1.01 * slack && !bad.empty();
       used *= kSlackGrowth) {
    bad = untangleCells(near, used, std::move(bad));
  }
  if (bad.empty()) return;
  putBack(cellPoints(), bad, before, mesh_.points, places_);
  measureAll();
}

Sweeps::Standing Sweeps::standing(double target) const {
  Standing standing;
  for (const double quality : qualities_) {
    if (!isCertified(quality)) ++standing.bad;
    if (isCertified(quality) && quality < target) ++standing.below;
    standing.depth = std::max(standing.depth, 1 - quality);
  }
  return standing;
}

std::vector<Index> Sweeps::fallenSince(std::span<const Index> below, double target) const {
  std::vector<Index> fallen = cellsBelow(target);
  std::erase_if(
      fallen, [below](Index cell) { return std::binary_search(below.begin(), below.end(), cell); });
  return fallen;
}

double Sweeps::deficitOf(std::span<const Index> cells) const {
  double sum = 0;
  for (const Index cell : cells) sum += 1 - qualities_[cell];
  return sum;
}

std::vector<Index> Sweeps::cellsBelow(double target) const {
  return cellsThat([&](double quality) { return quality < target; });
}

std::vector<Index> Sweeps::verticesNear(std::vector<Index> cells, int rings) const {
  return Neighbourhoods(cellPoints()).pointsOf(rings, cells);
}

void Sweeps::putBackAll(const Positions& before) {
  before.restoreAll(mesh_.points, places_);
  measureAll();
}

void Sweeps::moveAtOnce(double target, double slack, bool isFolded,
                        const std::function<Array<Quad>()>& farQuads) {
  const auto isAny = [](double /*quality*/) { return true; };
  const std::vector<Index> low = movableCells([&](double quality) { return quality < target; });
  Neighbourhoods near(cellPoints());
  std::vector<Index> cells = low;
  std::vector<Index> vertices = near.pointsOf(kLeastRingsAtOnce, cells);
  for (int rings = kLeastRingsAtOnce + 1; rings <= kMostRingsAtOnce; ++rings) {
    std::vector<Index> more = low;
    std::vector<Index> around = near.pointsOf(rings, more);
    if (more.size() > kMostCellsAtOnce) break;
    const bool isAll = more.size() == cells.size();
    cells = std::move(more);
    vertices = std::move(around);
    if (isAll) break;
  }
  if (cells.empty()) return;
  const std::size_t rounds = std::min<std::size_t>(
      kMostRoundsAtOnce, (isFolded ? kMostWorkFolded : kMostWorkAtOnce) / cells.size());
  if (rounds <= kStallsAtOnce) return;  // too few to converge
  cells = movable(std::move(cells), isAny);
  std::vector<std::uint8_t> isHeld(mesh_.points.size(), 0);
  for (const Quad& quad : places_.innerQuads) {  // nothing checks their distance
    for (const Index v : quad) isHeld[v] = 1;
  }
  if (isFolded) {
    spreadAtOnce(mesh_, places_, {vertices, cells, boxes_}, stage_);
    measureAll();
  }
  double least = deficitOf(cells);
  Positions best = positions();
  std::size_t stalls = 0;
  for (std::size_t round = 0; round < rounds && stalls < kStallsAtOnce; ++round) {
    const Positions before = positions();
    takeBoxes();
    improvement::moveAtOnce(mesh_, places_, {vertices, cells, boxes_}, isFolded && round == 0,
                            isHeld, stage_);
    for (const Quad& quad : farQuads()) {
      for (const Index v : quad) {
        isHeld[v] = 1;
        before.restore(v, mesh_.points, places_);
      }
    }
    measureAll();
    untangle(slack);
    raiseWorst(target, 0);  // barely positive cells would block further steps
    const double now = deficitOf(cells);
    if (now > (1 - kStallAtOnce) * least) ++stalls;
    if (now >= least) continue;
    least = now;
    best = positions();
  }
  putBackAll(best);
}

void Sweeps::raiseWorst(double target, double slack) {
  const Standing now = standing(target);
  const std::size_t count = now.bad + now.below;
  if (count == 0) return;
  if (count > kMostFalling || cellPoints().perCell > 8) {
    raise({target, false, kPrice}, slack);
    return;
  }
  const Positions before = positions();
  const std::vector<Index> low = cellsBelow(target);
  raise({target, true, kPrice}, slack);
  const std::vector<Index> fallen = fallenSince(low, target);
  if (fallen.empty()) return;
  putBack(cellPoints(), fallen, before, mesh_.points, places_);
  measureAll();
  raise({target, false, kPrice}, slack);
}

void Sweeps::raise(const Exchange& exchange, double slack) {
  const double target = exchange.floor;
  const auto isLow = [target](double quality) { return isCertified(quality) && quality < target; };
  std::vector<Index> low = movableCells(isLow);
  if (low.empty()) return;
  const CellPoints all = cellPoints();
  Neighbourhoods near(all);
  // Per cell: the last round in which it moved. Only vertices of such cells are visited again.
  std::vector<std::uint8_t> lastMove(qualities_.size(), 0);
  std::uint8_t round = 0;
  const auto isAwake = [&](Index cell) { return lastMove[cell] == round; };
  for (const int power : kWorstPowers) {
    for (int i = 0; i < kWorstRounds; ++i) {
      low = low.empty() ? movableCells(isLow) : movable(std::move(low), isLow);
      std::vector<Index> vertices = near.pointsOf(1, low);
      if (kManyLow * low.size() > qualities_.size()) std::vector<Index>().swap(low);
      std::erase_if(vertices, [&](Index v) {
        const auto cells = all.around(v);
        return places_.freedom[v] == Freedom::Fixed ||
               (i > 0 && std::none_of(cells.begin(), cells.end(), isAwake));
      });
      if (vertices.empty()) break;
      ++round;
      const Exchange now = power > 1 ? exchange : Exchange{target, exchange.belowFloor};
      sweep(std::move(vertices), slack, [&](VertexMover& mover, Index v) {
        if (mover.smooth(v, TermKind::Corners, power, now) <= kStill) return;
        for (const Index cell : all.around(v)) lastMove[cell] = round;
      });
    }
  }
}

void Sweeps::smooth(int passes, double floor) {
  const CellPoints all = cellPoints();
  const auto canMove = [&](Index v) {
    return places_.freedom[v] != Freedom::Fixed && !all.around(v).empty();
  };
  for (int pass = 0; pass < passes; ++pass) {
    sweep(verticesThat(canMove), 0,
          [&](VertexMover& mover, Index v) { mover.smooth(v, TermKind::OwnCorners, 1, {floor}); });
  }
}

void Sweeps::moveBack(std::span<const Quad> quads, const Positions& before, double floor) {
  std::vector<Index> vertices;
  for (const Quad& quad : quads) {
    for (const Index v : quad) {
      if (mesh_.points[v] != before.points[v]) vertices.push_back(v);
    }
  }
  sortUnique(vertices);
  sweep(std::move(vertices), 0,
        [&](VertexMover& mover, Index v) { mover.moveTo(v, before.placeOf(v), false, floor); });
}

void Sweeps::pullOntoSurface(double floor) {
  for (int i = 0; i < kReturns; ++i) {
    std::vector<Index> vertices = verticesThat([&](Index v) {
      const Vec3& point = mesh_.points[v];
      return length(minus(places_.home(v, point).point, point)) > kNearEnough * chord_;
    });
    if (vertices.empty()) return;
    sweep(std::move(vertices), 0, [&](VertexMover& mover, Index v) {
      mover.moveTo(v, places_.home(v, mesh_.points[v]), true, floor);
    });
    smooth(1, floor);  // makes room
  }
}

void Sweeps::smoothInside(double floor) {
  takeBoxes();
  const auto isInner = [&](Index v) {
    return places_.freedom[v] == Freedom::Free && !meshAround_(v).empty();
  };
  sweep(verticesThat(isInner), 0,
        [&](VertexMover& mover, Index v) { mover.smooth(v, TermKind::OwnCorners, 1, {floor}); });
}

void Sweeps::spread(std::span<const Quad> quads, std::span<const double> errors, double even,
                    double floor) {
  std::vector<Vec3> sums(mesh_.points.size());
  std::vector<double> weights(mesh_.points.size(), 0);
  for (std::size_t q = 0; q < quads.size(); ++q) {
    const double weight = std::max(errors[q], even);
    for (const Index v : quads[q]) {
      for (const Index corner : quads[q]) {
        sums[v] = plus(sums[v], times(weight / 4, mesh_.points[corner]));
      }
      weights[v] += weight;
    }
  }
  const auto isOuter = [&](Index v) {
    return weights[v] > 0 && places_.freedom[v] != Freedom::Fixed;
  };
  sweep(verticesThat(isOuter), 0, [&](VertexMover& mover, Index v) {
    mover.moveTo(v, places_.nearest(v, times(1 / weights[v], sums[v])), false, floor,
                 mover.farthestAt(v));
  });
  smoothInside(floor);
}

void Sweeps::shift(const Array<Vec3>& moves, double floor) {
  sweep(verticesThat([&](Index v) { return moves[v] != Vec3{}; }), 0,
        [&](VertexMover& mover, Index v) {
          const Vec3 to = plus(mesh_.points[v], moves[v]);
          mover.moveTo(v, {to, places_.nearest(v, to).simplex}, true, floor);
        });
  smoothInside(floor);
}

}  // namespace hexhex::improvement
