#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <map/input.hpp>

namespace hexhex {

namespace {

constexpr std::size_t kGrain = 4096;

/// Determinant of the edge vectors from corner 0, or 0 if it is too small for its sign to be
/// trusted.
double safeDeterminant(const Vec3& p0, const Vec3& p1, const Vec3& p2, const Vec3& p3) {
  double determinant = 0;
  double magnitude = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3;
    const std::size_t j = (k + 2) % 3;
    const double minor = (p1[i] - p0[i]) * (p2[j] - p0[j]) - (p1[j] - p0[j]) * (p2[i] - p0[i]);
    determinant += minor * (p3[k] - p0[k]);
    magnitude += std::abs(minor * (p3[k] - p0[k]));
  }
  // Far above rounding, far below any tet that matters for a majority.
  return std::abs(determinant) > 1e-12 * magnitude ? determinant : 0;
}

/// How many tets are positive and negative, in space and in the map.
struct SignCounts {
  std::uint64_t spacePositive = 0;
  std::uint64_t spaceNegative = 0;
  std::uint64_t mapPositive = 0;
  std::uint64_t mapNegative = 0;
};

SignCounts countSigns(const TetMapView& map, Stage& stage) {
  std::vector<SignCounts> blocks(blockCount(map.tets.size(), kGrain));
  parallelBlocks(stage, map.tets.size(), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   SignCounts counts;
                   for (std::size_t t = begin; t < end; ++t) {
                     const Tet& tet = map.tets[t];
                     const TetParameters& u = map.parameters[t];
                     const double space = safeDeterminant(map.points[tet[0]], map.points[tet[1]],
                                                          map.points[tet[2]], map.points[tet[3]]);
                     const double parametric = safeDeterminant(u[0], u[1], u[2], u[3]);
                     counts.spacePositive += space > 0 ? 1 : 0;
                     counts.spaceNegative += space < 0 ? 1 : 0;
                     counts.mapPositive += parametric > 0 ? 1 : 0;
                     counts.mapNegative += parametric < 0 ? 1 : 0;
                   }
                   blocks[block] = counts;
                 });
  SignCounts total;
  for (const SignCounts& counts : blocks) {
    total.spacePositive += counts.spacePositive;
    total.spaceNegative += counts.spaceNegative;
    total.mapPositive += counts.mapPositive;
    total.mapNegative += counts.mapNegative;
  }
  return total;
}

}  // namespace

void checkInput(const TetMapView& map, Stage& stage, DefectCollector& defects) {
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
  if (map.tets.empty()) defects.add(ErrorCode::EmptyMesh, {}, 0);
  if (map.tets.size() > kMaxTets || map.points.size() >= kNone) {
    defects.add(ErrorCode::TooLarge, {}, 0);
    return;
  }
  const auto finite = [](const Vec3& p) {
    return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
  };
  parallelFor(stage, map.points.size(), kGrain, [&](std::size_t v) {
    if (!finite(map.points[v])) defects.add(ErrorCode::NotFinite, {PlaceKind::Vertex, v}, 0);
  });
  parallelFor(stage, map.tets.size(), kGrain, [&](std::size_t t) {
    const Tet& tet = map.tets[t];
    const Place place{PlaceKind::Tet, t};
    for (std::size_t i = 0; i < 4; ++i) {
      if (tet[i] >= map.points.size()) {
        defects.add(ErrorCode::IndexOutOfRange, place, 0);
        return;
      }
      if (!finite(map.parameters[t][i])) {
        defects.add(ErrorCode::NotFinite, place, 0);
        return;
      }
    }
    if (tet[0] == tet[1] || tet[0] == tet[2] || tet[0] == tet[3] || tet[1] == tet[2] ||
        tet[1] == tet[3] || tet[2] == tet[3]) {
      defects.add(ErrorCode::RepeatedVertex, place, 0);
    }
  });
}

OrientedMap orientMap(const TetMapView& map, Stage& stage) {
  const SignCounts counts = countSigns(map, stage);
  const bool spaceReversed = counts.spaceNegative > counts.spacePositive;
  const bool mapReversed = counts.mapNegative > counts.mapPositive;
  OrientedMap oriented;
  oriented.view = map;
  oriented.cornersReversed = spaceReversed;
  oriented.mirrored = spaceReversed != mapReversed;
  oriented.flippedTets = std::max(counts.mapPositive, counts.mapNegative) < map.tets.size();
  oriented.tetsInvertedInSpace = std::min(counts.spaceNegative, counts.spacePositive);
  if (!oriented.cornersReversed && !oriented.mirrored) return oriented;

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
  return oriented;
}

}  // namespace hexhex
