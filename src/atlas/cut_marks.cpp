#include <algorithm>
#include <cmath>

#include <atlas/cut_marks.hpp>
#include <sweep/cell_seeds.hpp>

#include <lattice/triangle_cells.hpp>

namespace hexhex {

namespace {

constexpr std::size_t kGrain = 1024;

using Triangle = std::array<LatticePoint, 3>;

Triangle triangleOf(const ExactMap& map, HalfFace halfFace) {
  const LatticeTet& corners = map.corners[tetOf(halfFace)];
  const std::array<int, 3>& face = kFaceCorners[halfFace % 4];
  return {corners[static_cast<std::size_t>(face[0])], corners[static_cast<std::size_t>(face[1])],
          corners[static_cast<std::size_t>(face[2])]};
}

/// A crossing on its way into the list.
template <class Id>
struct Found {
  Brick<Id>* brick;
  Crossing crossing;
};

template <class Id>
void markFace(const PreparedMap& map, const Charts& charts, HalfFace halfFace,
              BrickCache<Id>& cache, std::vector<Found<Id>>& found) {
  const Index tet = tetOf(halfFace);
  if (charts.chart[tet] == Charts::kNoChart) return;
  const Gauge& gauge = charts.gauge(tet);
  TriangleCells(triangleOf(map.exact, halfFace), map.exact.unit).run([&](const GridPoint& z) {
    const ChartPoint c = gauge.cell(z);
    Brick<Id>* const brick = cache.find(charts.chart[tet], c);
    if (brick == nullptr) return;
    const std::size_t place = placeInBrick(c);
    brick->mark(place);
    found.push_back({brick, {halfFace, static_cast<std::uint16_t>(place)}});
  });
}

/// Sorts crossings by brick and place.
template <class Id>
Array<Crossing> collect(std::vector<std::vector<Found<Id>>>& blocks, BrickGrid<Id>& grid,
                        Stage& stage) {
  std::size_t total = 0;
  for (const auto& block : blocks) total += block.size();
  if (total > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(ErrorCode::TooLarge,
                "More than 4,294,967,295 cells meet the cuts of the map. Lower the scale.");
  }
  std::vector<Brick<Id>*> marked;
  std::uint32_t begin = 0;
  grid.forEachBrick([&](Brick<Id>& brick) {
    if (brick.crossingEnd == 0) return;
    const std::uint32_t count = brick.crossingEnd;
    brick.crossingBegin = begin;
    brick.crossingEnd = begin;  // the place of the next one, until all are there
    begin += count;
    marked.push_back(&brick);
  });
  Array<Crossing> list(total);
  parallelFor(stage, blocks.size(), 1, [&](std::size_t b) {
    for (const Found<Id>& found : blocks[b]) {
      const std::uint32_t place =
          std::atomic_ref(found.brick->crossingEnd).fetch_add(1, std::memory_order_relaxed);
      list[place] = found.crossing;
    }
    blocks[b] = {};
  });
  parallelFor(stage, marked.size(), 16, [&](std::size_t i) {
    std::sort(list.begin() + marked[i]->crossingBegin, list.begin() + marked[i]->crossingEnd,
              [](const Crossing& a, const Crossing& b) {
                return a.place != b.place ? a.place < b.place : a.halfFace < b.halfFace;
              });
  });
  return list;
}

}  // namespace

template <class Id>
Crossings markCutCells(const PreparedMap& map, const Charts& charts, BrickGrid<Id>& grid,
                       Stage& stage) {
  const TetTopology& topology = map.topology;
  std::vector<std::vector<Found<Id>>> blocks(blockCount(topology.tetCount(), kGrain));
  std::atomic<std::uint64_t> cuts{0};
  parallelBlocks(stage, topology.tetCount(), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   BrickCache<Id> cache(grid);
                   std::uint64_t cutsHere = 0;
                   for (std::size_t h = 4 * begin; h < 4 * end; ++h) {
                     const auto halfFace = static_cast<HalfFace>(h);
                     const HalfFace mate = topology.mate[halfFace];
                     if (mate == kNone || mate < halfFace) continue;
                     if (charts.isGlued(topology, map.exact.transitions, halfFace)) continue;
                     ++cutsHere;
                     markFace(map, charts, halfFace, cache, blocks[block]);
                     markFace(map, charts, mate, cache, blocks[block]);
                   }
                   cuts.fetch_add(cutsHere, std::memory_order_relaxed);
                 });
  Crossings crossings;
  crossings.cutFaces = cuts.load();
  crossings.list = collect(blocks, grid, stage);
  return crossings;
}

template Crossings markCutCells(const PreparedMap&, const Charts&, BrickGrid<std::uint32_t>&,
                                Stage&);
template Crossings markCutCells(const PreparedMap&, const Charts&, BrickGrid<std::uint64_t>&,
                                Stage&);

namespace {

using Vector = std::array<double, 3>;

/// A vector with a bound of its components' errors.
struct Bounded {
  Vector v;
  double error;
};

/// Signs of the diagonals' components, by axis, then corner.
constexpr std::array<std::array<double, 8>, 3> makeDiagonals() {
  std::array<std::array<double, 8>, 3> diagonals{};
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t c = 0; c < 8; ++c) diagonals[k][c] = 2.0 * kCellCorners[c][k] - 1;
  }
  return diagonals;
}
constexpr std::array<std::array<double, 8>, 3> kDiagonals = makeDiagonals();

/// v . d for all eight diagonals d.
std::array<double, 8> alongDiagonals(const Vector& v) {
  std::array<double, 8> products;
  for (std::size_t c = 0; c < 8; ++c) {
    products[c] = v[0] * kDiagonals[0][c] + v[1] * kDiagonals[1][c] + v[2] * kDiagonals[2][c];
  }
  return products;
}

/// Which diagonals may cross a triangle: a line does only if it passes all three edges on one side,
/// the diagonal only if its ends are on different sides of the plane.
/// @param sides   cross products of neighbouring corners, which tell the side of the edges
/// @param center  the plane's value at the cell's centre
unsigned crossedBy(const std::array<Vector, 3>& sides, const Vector& normal, double error,
                   double center, double centerError) {
  const std::array<double, 8> a = alongDiagonals(sides[0]);
  const std::array<double, 8> b = alongDiagonals(sides[1]);
  const std::array<double, 8> e = alongDiagonals(sides[2]);
  const std::array<double, 8> n = alongDiagonals(normal);
  unsigned crossed = 0;
  for (std::size_t c = 0; c < 8; ++c) {
    const double most = std::max(std::max(a[c], b[c]), e[c]);
    const double least = std::min(std::min(a[c], b[c]), e[c]);
    const double corner = center + 0.5 * n[c];
    const bool beside = most > error && least < -error;
    const bool above = std::min(center, corner) > centerError;
    const bool below = std::max(center, corner) < -centerError;
    if (!beside && !above && !below) crossed |= 1U << c;
  }
  return crossed;
}

/// a x b for vectors with relative errors of 2^-52 in each component.
Bounded crossProduct(const Vector& a, const Vector& b) {
  Bounded result{};
  double magnitude = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = k == 2 ? 0 : k + 1;
    const std::size_t j = k == 0 ? 2 : k - 1;
    const double first = a[i] * b[j];
    const double second = a[j] * b[i];
    result.v[k] = first - second;
    magnitude += std::abs(first) + std::abs(second);
  }
  // Also covers the sums of components below.
  result.error = 0x1p-48 * magnitude;
  return result;
}

}  // namespace

unsigned crossedDiagonals(const PreparedMap& map, const Charts& charts, Index tet,
                          const ChartPoint& cell, std::span<const Crossing> crossings) noexcept {
  const double scale = 1.0 / static_cast<double>(map.exact.unit);
  unsigned crossed = 0;
  for (const Crossing& crossing : crossings) {
    const Gauge& gauge = charts.gauge(tetOf(crossing.halfFace));
    const GridPoint z = gauge.inverseCell(cell);
    const Triangle triangle = triangleOf(map.exact, crossing.halfFace);
    std::array<Vector, 3> p{};  // from the cell's centre
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        p[i][k] = static_cast<double>(triangle[i][k] - z[k] * map.exact.unit - map.exact.unit / 2) *
                  scale;
      }
    }
    const std::array<Bounded, 3> sides = {crossProduct(p[0], p[1]), crossProduct(p[1], p[2]),
                                          crossProduct(p[2], p[0])};
    const double error = sides[0].error + sides[1].error + sides[2].error;
    Vector normal{};
    double center = 0;  // the plane's value at the centre
    double centerError = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      normal[k] = sides[0].v[k] + sides[1].v[k] + sides[2].v[k];
      center -= normal[k] * p[0][k];
      centerError += error * std::abs(p[0][k]);
    }
    centerError += error;
    // All seen from the tet's chart.
    const Rotation rotation = (gauge.rotation.inverse() * charts.gauge(tet).rotation).inverse();
    crossed |= crossedBy({rotation(sides[0].v), rotation(sides[1].v), rotation(sides[2].v)},
                         rotation(normal), error, center, centerError);
  }
  return crossed;
}

}  // namespace hexhex
