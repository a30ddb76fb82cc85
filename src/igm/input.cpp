#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include <base/branchless.hpp>
#include <base/pair.hpp>
#include <base/prefetch.hpp>
#include <igm/input.hpp>

namespace hexhex {

namespace {

constexpr std::size_t kGrain = 1024;

/// Tets between asking for points and looking at them: the memory's delay.
constexpr std::size_t kPointsAhead = 8;

/// Which determinants of the edge vectors from corner 0 are positive and negative, as far as their
/// signs are to be trusted, and sums of magnitudes, which are finite only if all coordinates are.
struct Signs {
  PairMask positive;
  PairMask negative;
  Pair magnitude;
};

/// The first of each pair is in space, the second in the map.
Signs signsOf(const std::array<const Vec3*, 4>& points, const TetParameters& u) {
  std::array<std::array<Pair, 3>, 3> edges{};
  for (std::size_t k = 0; k < 3; ++k) {
    const Pair origin = {(*points[0])[k], u[0][k]};
    for (std::size_t e = 0; e < 3; ++e) {
      edges[e][k] = Pair{(*points[e + 1])[k], u[e + 1][k]} - origin;
    }
  }
  Pair determinant = {0, 0};
  Pair magnitude = {0, 0};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3;
    const std::size_t j = (k + 2) % 3;
    const Pair product = (edges[0][i] * edges[1][j] - edges[0][j] * edges[1][i]) * edges[2][k];
    determinant += product;
    magnitude += magnitudeOf(product);
  }
  // Far above rounding, far below any tet that matters for a majority.
  const Pair enough = 1e-12 * magnitude;
  return {determinant > enough, -determinant > enough, magnitude};
}

void checkSizes(const TetMapView& map) {
  if (map.parameters.size() != map.tets.size()) {
    throw Error(ErrorCode::InvalidArgument, "The map has " + std::to_string(map.parameters.size()) +
                                                " parameter quadruples for " +
                                                std::to_string(map.tets.size()) +
                                                " tets. Give one quadruple per tet.");
  }
  if (!map.rotations.empty() && map.rotations.size() != map.tets.size()) {
    throw Error(ErrorCode::InvalidArgument,
                "The map has rotations for " + std::to_string(map.rotations.size()) + " of " +
                    std::to_string(map.tets.size()) + " tets. Give four per tet, or none.");
  }
  for (const EdgeValence& edge : map.edgeValences) {
    if (edge.vertex0 >= map.points.size() || edge.vertex1 >= map.points.size()) {
      throw Error(ErrorCode::InvalidArgument,
                  "A given edge valence names a vertex that does not exist.",
                  {PlaceKind::Edge, edge.vertex0, edge.vertex1});
    }
  }
}

/// 0 for finite coordinates, otherwise not a number.
double finiteness(const Vec3& p) { return p[0] * 0 + p[1] * 0 + p[2] * 0; }

bool isFinite(const TetParameters& u) {
  double sum = 0;
  for (const Vec3& corner : u) sum += (corner[0] + corner[1]) + corner[2];
  // A finite sum has finite terms; an infinite one may have overflowed.
  if (sum - sum == 0) return true;
  return finiteness(u[0]) + finiteness(u[1]) + (finiteness(u[2]) + finiteness(u[3])) == 0;
}

// Without branches, as nearly all tets pass all tests.
bool hasIndexBeyond(const Tet& tet, std::size_t count) {
  return anyOf(tet[0] >= count, tet[1] >= count, tet[2] >= count, tet[3] >= count);
}

bool hasRepeatedVertex(const Tet& tet) {
  return anyOf(tet[0] == tet[1], tet[0] == tet[2], tet[0] == tet[3], tet[1] == tet[2],
               tet[1] == tet[3], tet[2] == tet[3]);
}

/// Whether any of some tets has an index out of range, or a vertex twice.
bool haveBadIndices(std::span<const Tet> tets, std::size_t count) {
  using Indices = std::uint32_t __attribute__((vector_size(16)));
  static_assert(sizeof(Tet) == sizeof(Indices));
  const auto limit = static_cast<std::uint32_t>(count);
  auto isBad = Indices{} != Indices{};
  for (const Tet& tet : tets) {
    Indices indices;
    std::memcpy(&indices, &tet, sizeof indices);
    const Indices next = __builtin_shufflevector(indices, indices, 1, 2, 3, 0);
    const Indices opposite = __builtin_shufflevector(indices, indices, 2, 3, 0, 1);
    isBad |= (indices >= limit) | (indices == next) | (indices == opposite);
  }
  return anyOf(isBad[0] != 0, isBad[1] != 0, isBad[2] != 0, isBad[3] != 0);
}

/// What a pass over all tets finds out: how many are positive and negative, in space and in the
/// map, and how large they are.
struct Measures {
  PairMask positive = {0, 0};  ///< numbers: in space, in the map
  PairMask negative = {0, 0};
  Pair magnitude = {0, 0};  ///< in space, in the map: of all tets, finite only if all of them are
  Pair largestCoordinate = {0, 0};  ///< the larger one counts
  Pair largestExtent = {0, 0};

  void add(const Measures& other) {
    positive += other.positive;
    negative += other.negative;
    largestCoordinate = larger(largestCoordinate, other.largestCoordinate);
    largestExtent = larger(largestExtent, other.largestExtent);
  }

  void addTet(const TetMapView& map, std::size_t t) {
    const Tet& tet = map.tets[t];
    const TetParameters& u = map.parameters[t];
    const Signs signs = signsOf(
        {&map.points[tet[0]], &map.points[tet[1]], &map.points[tet[2]], &map.points[tet[3]]}, u);
    positive -= signs.positive;
    negative -= signs.negative;
    magnitude += signs.magnitude;
    addBox(u);
  }

  /// Both coordinates of x and y at once, and z both ways.
  void addBox(const TetParameters& u) {
    const std::array<Pair, 4> xy = {loadPair(&u[0][0]), loadPair(&u[1][0]), loadPair(&u[2][0]),
                                    loadPair(&u[3][0])};
    const Pair lowXy = smaller(smaller(xy[0], xy[1]), smaller(xy[2], xy[3]));
    const Pair highXy = larger(larger(xy[0], xy[1]), larger(xy[2], xy[3]));
    const auto bothWays = [&](std::size_t corner) { return Pair{-u[corner][2], u[corner][2]}; };
    const Pair aroundZ = larger(larger(bothWays(0), bothWays(1)), larger(bothWays(2), bothWays(3)));
    largestCoordinate = larger(largestCoordinate, larger(larger(-lowXy, highXy), aroundZ));
    const double extentZ = aroundZ[0] + aroundZ[1];
    largestExtent = larger(largestExtent, larger(highXy - lowXy, Pair{extentZ, extentZ}));
  }
};

/// Measures tets whose indices are good.
Measures measureAll(const TetMapView& map, std::size_t begin, std::size_t end) {
  Measures measures;
  for (std::size_t t = begin; t < end; ++t) {
    const std::size_t ahead = std::min(t + kPointsAhead, end - 1);
    for (const Index v : map.tets[ahead]) prefetch(&map.points[v]);
    measures.addTet(map, t);
  }
  return measures;
}

/// Measures those tets that can be measured; others are defects.
Measures measureGood(const TetMapView& map, std::size_t begin, std::size_t end,
                     DefectCollector& defects) {
  Measures measures;
  for (std::size_t t = begin; t < end; ++t) {
    const Tet& tet = map.tets[t];
    const Place place{PlaceKind::Tet, t};
    if (hasIndexBeyond(tet, map.points.size())) {
      defects.add(ErrorCode::IndexOutOfRange, place, 0);
    } else if (!isFinite(map.parameters[t])) {
      defects.add(ErrorCode::NotFinite, place, 0);
    } else if (hasRepeatedVertex(tet)) {
      defects.add(ErrorCode::RepeatedVertex, place, 0);
    } else {
      measures.addTet(map, t);
    }
  }
  return measures;
}

/// The same, all tets of a block at once if nothing is wrong with any of them.
Measures measureBlock(const TetMapView& map, std::size_t begin, std::size_t end,
                      DefectCollector& defects) {
  if (!haveBadIndices(map.tets.subspan(begin, end - begin), map.points.size())) {
    const Measures measures = measureAll(map, begin, end);
    if (std::isfinite(measures.magnitude[1])) return measures;
  }
  return measureGood(map, begin, end, defects);
}

Measures measureTets(const TetMapView& map, Stage& stage, DefectCollector& defects) {
  std::vector<Measures> blocks(blockCount(map.tets.size(), kGrain));
  parallelBlocks(stage, map.tets.size(), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   blocks[block] = measureBlock(map, begin, end, defects);
                 });
  Measures total;
  for (const Measures& measures : blocks) total.add(measures);
  return total;
}

/// Reverses the corners of all tets, and mirrors all charts, as far as `oriented` says so.
void reorient(OrientedMap& oriented, const TetMapView& map, Stage& stage) {
  oriented.tets.resize(map.tets.size());
  oriented.parameters.resize(map.tets.size());
  parallelFor(stage, map.tets.size(), kGrain, [&](std::size_t t) {
    Tet& tet = oriented.tets[t];
    TetParameters& parameters = oriented.parameters[t];
    tet = map.tets[t];
    parameters = map.parameters[t];
    if (oriented.cornersReversed) {
      std::swap(tet[2], tet[3]);
      std::swap(parameters[2], parameters[3]);
    }
    if (oriented.mirrored) {
      for (Vec3& u : parameters) u[0] = -u[0];
    }
  });
  oriented.view.tets = oriented.tets;
  oriented.view.parameters = oriented.parameters;
  oriented.view.rotations = {};  // redundant, and given for the charts as they were
}

}  // namespace

OrientedMap readInput(const TetMapView& map, Stage& stage, DefectCollector& defects) {
  OrientedMap oriented;
  checkSizes(map);
  if (map.tets.empty()) defects.add(ErrorCode::EmptyMesh, {}, 0);
  if (map.tets.size() > kMaxTets || map.points.size() >= kNone) {
    defects.add(ErrorCode::TooLarge, {}, 0);
    return oriented;
  }
  parallelFor(stage, map.points.size(), kGrain, [&](std::size_t v) {
    if (finiteness(map.points[v]) != 0) {
      defects.add(ErrorCode::NotFinite, {PlaceKind::Vertex, v}, 0);
    }
  });
  const Measures measures = measureTets(map, stage, defects);
  const bool spaceReversed = measures.negative[0] > measures.positive[0];
  const bool mapReversed = measures.negative[1] > measures.positive[1];
  oriented.view = map;
  oriented.cornersReversed = spaceReversed;
  oriented.mirrored = spaceReversed != mapReversed;
  const auto tets = static_cast<std::int64_t>(map.tets.size());
  oriented.flippedTets = std::max<std::int64_t>(measures.positive[1], measures.negative[1]) < tets;
  oriented.tetsInvertedInSpace = static_cast<std::uint64_t>(
      std::min<std::int64_t>(measures.negative[0], measures.positive[0]));
  oriented.largestCoordinate =
      std::max(measures.largestCoordinate[0], measures.largestCoordinate[1]);
  oriented.largestExtent = std::max(measures.largestExtent[0], measures.largestExtent[1]);
  if (defects.empty() && (oriented.cornersReversed || oriented.mirrored)) {
    reorient(oriented, map, stage);
  }
  return oriented;
}

}  // namespace hexhex
