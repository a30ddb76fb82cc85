// Checks and orients the input, and moves charts towards the origin (for Section 5.1).
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <base/vector3.hpp>
#include <igm/input.hpp>

namespace hexhex::igm {

namespace {

constexpr std::size_t kInputGrain = 1024;

/// The smallest step by which charts are moved. Maps whose coordinates stay below half of it,
/// nearly all, are not moved at all. It costs ten of the 52 bits of a coordinate.
constexpr double kMinChartGrid = 1024;

/// Keeps volumes in space finite: they are products of three coordinate differences.
constexpr double kMaxCoordinate = 0x1p300;

/// Beyond, doubles do not even represent all integers. (What a distant chart has rounded before
/// shows like any other inexactness.)
constexpr double kMaxParameter = 0x1p53;

/// Translations between charts are 32-bit integers: with coordinates below this, translations fit,
/// even doubled. (Sanitization, which knows the scale, allows no more either.)
constexpr double kMaxLocalParameter = 0x1p28;

/// @param corners  of a feature, the i-th of its kind
void checkFeature(const TetMapView& map, std::span<const Index> corners, const char* kind,
                  std::size_t i) {
  for (const Index vertex : corners) {
    if (vertex < map.points.size()) continue;
    throw Error(ErrorCode::InvalidArgument,
                std::string("Feature ") + kind + " " + std::to_string(i) + " names vertex " +
                    std::to_string(vertex) + ", but the map has " +
                    std::to_string(map.points.size()) + " vertices, numbered from 0.");
  }
}

void checkFeatures(const TetMapView& map) {
  const auto& [vertices, edges, faces, names] = map.features;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    checkFeature(map, {&vertices[i].vertex, 1}, "vertex", i);
  }
  for (std::size_t i = 0; i < edges.size(); ++i) checkFeature(map, edges[i].vertices, "edge", i);
  for (std::size_t i = 0; i < faces.size(); ++i) checkFeature(map, faces[i].vertices, "face", i);
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
  if (!map.regions.empty() && map.regions.size() != map.tets.size()) {
    throw Error(ErrorCode::InvalidArgument,
                "The map has " + std::to_string(map.tets.size()) + " tets, but regions for " +
                    std::to_string(map.regions.size()) + ". Give one for each tet, or none.");
  }
  for (const EdgeValence& edge : map.edgeValences) {
    if (edge.vertex0 >= map.points.size() || edge.vertex1 >= map.points.size()) {
      throw Error(ErrorCode::InvalidArgument,
                  "A given edge valence names a vertex that does not exist.",
                  {PlaceKind::Edge, edge.vertex0, edge.vertex1});
    }
  }
}

bool hasIndexBeyond(const Tet& tet, std::size_t count) {
  return std::any_of(tet.begin(), tet.end(), [count](Index v) { return v >= count; });
}

bool hasRepeatedVertex(const Tet& tet) {
  return tet[0] == tet[1] || tet[0] == tet[2] || tet[0] == tet[3] || tet[1] == tet[2] ||
         tet[1] == tet[3] || tet[2] == tet[3];
}

/// The result of a pass over all tets. Pairs count tets in space and tets in the map, whose volumes
/// are computed at once, as far as signs can be trusted.
struct Measures {
  PairMask positive = {0, 0};
  PairMask negative = {0, 0};
  double largestCoordinate = 0;
  double largestExtent = 0;

  void add(const Measures& other) {
    positive += other.positive;
    negative += other.negative;
    largestCoordinate = std::max(largestCoordinate, other.largestCoordinate);
    largestExtent = std::max(largestExtent, other.largestExtent);
  }

  void addTet(const TetMapView& map, std::size_t t) {
    const Tet& tet = map.tets[t];
    const TetParameters& u = map.parameters[t];
    addVolumes({&map.points[tet[0]], &map.points[tet[1]], &map.points[tet[2]], &map.points[tet[3]]},
               u);
    for (std::size_t k = 0; k < 3; ++k) {
      const double low = std::min(std::min(u[0][k], u[1][k]), std::min(u[2][k], u[3][k]));
      const double high = std::max(std::max(u[0][k], u[1][k]), std::max(u[2][k], u[3][k]));
      largestCoordinate = std::max(largestCoordinate, std::max(-low, high));
      largestExtent = std::max(largestExtent, high - low);
    }
  }

  void addVolumes(const std::array<const Vec3*, 4>& points, const TetParameters& u) {
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
    positive -= determinant > enough;
    negative -= -determinant > enough;
  }
};

/// Measures the tets that can be measured; the others are defects.
Measures measureBlock(const TetMapView& map, std::size_t begin, std::size_t end,
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

Measures measureTets(const TetMapView& map, Stage& stage, DefectCollector& defects) {
  std::vector<Measures> blocks(blockCount(map.tets.size(), kInputGrain));
  parallelBlocks(stage, map.tets.size(), kInputGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   blocks[block] = measureBlock(map, begin, end, defects);
                 });
  Measures total;
  for (const Measures& measures : blocks) total.add(measures);
  return total;
}

/// Reverses the corners of all tets and mirrors all charts, as `oriented` demands.
void reorient(OrientedMap& oriented, const TetMapView& map, Stage& stage) {
  oriented.tets.resize(map.tets.size());
  oriented.parameters.resize(map.tets.size());
  parallelFor(stage, map.tets.size(), kInputGrain, [&](std::size_t t) {
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
  oriented.view.rotations = {};  // redundant, and valid only for the charts as they were
}

}  // namespace

OrientedMap readInput(const TetMapView& map, Stage& stage, DefectCollector& defects) {
  OrientedMap oriented;
  checkSizes(map);
  checkFeatures(map);
  if (map.tets.empty()) defects.add(ErrorCode::EmptyMesh, {}, 0);
  if (map.tets.size() > kMaxTets || map.points.size() >= kNone) {
    defects.add(ErrorCode::TooLarge, {}, 0);
    return oriented;
  }
  parallelFor(stage, map.points.size(), kInputGrain, [&](std::size_t v) {
    const auto isSmall = [](double x) { return std::abs(x) <= kMaxCoordinate; };
    const Vec3& p = map.points[v];
    if (isSmall(p[0]) && isSmall(p[1]) && isSmall(p[2])) return;
    defects.add(isFinite(p) ? ErrorCode::TooLarge : ErrorCode::NotFinite, {PlaceKind::Vertex, v},
                0);
  });
  const Measures measures = measureTets(map, stage, defects);
  const PairMask& positive = measures.positive;
  const PairMask& negative = measures.negative;
  const bool spaceReversed = negative[0] > positive[0];
  const bool mapReversed = negative[1] > positive[1];
  oriented.view = map;
  oriented.cornersReversed = spaceReversed;
  oriented.mirrored = spaceReversed != mapReversed;
  oriented.flippedTets =
      std::max<std::int64_t>(positive[1], negative[1]) < static_cast<std::int64_t>(map.tets.size());
  oriented.tetsInvertedInSpace =
      static_cast<std::uint64_t>(std::min<std::int64_t>(positive[0], negative[0]));
  oriented.largestCoordinate = measures.largestCoordinate;
  oriented.largestExtent = measures.largestExtent;
  if (defects.empty() && (oriented.cornersReversed || oriented.mirrored)) {
    reorient(oriented, map, stage);
  }
  return oriented;
}

LocalParameters::LocalParameters(const OrientedMap& map) noexcept
    : parameters_(map.view.parameters),
      largest_(map.largestCoordinate),
      largestExtent_(map.largestExtent) {
  tooLarge_ = largest_ > kMaxParameter;
  if (tooLarge_) return;
  grid_ = kMinChartGrid;
  while (grid_ < 4 * map.largestExtent) grid_ *= 2;
  moved_ = largest_ > grid_ / 2;
  if (moved_) largest_ = grid_ / 2 + map.largestExtent;
  tooLarge_ = largest_ > kMaxLocalParameter;
}

const TetParameters& LocalParameters::copyTo(TetParameters& scratch, Index tet) const noexcept {
  scratch = (*this)(tet);
  return scratch;
}

}  // namespace hexhex::igm
