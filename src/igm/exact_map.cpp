#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include <base/workspaces.hpp>
#include <igm/exact_map.hpp>
#include <igm/map_conditions.hpp>
#include <igm/map_volume.hpp>
#include <igm/tet_rounder.hpp>
#include <igm/vertex_sanitizer.hpp>

namespace hexhex {

namespace {

constexpr std::size_t kGrain = 1024;

/// Unscaled lattice coordinates stay below 2^52 and scaled ones below 2^60, which the predicates
/// rely on (tet_geometry.hpp).
constexpr int kLatticeBits = 52;
constexpr int kScaledLatticeBits = 60;
/// Grid coordinates and translations between charts stay below 2^30 after scaling: they are 32-bit.
constexpr int kGridBits = 29;
/// Fewer fractional bits than this would move parameters noticeably.
constexpr int kMinFractionBits = 16;

/// Number of fractional bits of the lattice: as many as the largest coordinate allows.
int fractionBits(double largest, int maxScale, DefectCollector& defects) {
  const int wholeBits = std::ilogb(largest + 1) + 1;  // largest + rounding < 2^wholeBits
  const int scaleBits = static_cast<int>(std::bit_width(static_cast<unsigned>(maxScale)));
  const int bits = std::min(kLatticeBits - wholeBits, kScaledLatticeBits - wholeBits - scaleBits);
  if (wholeBits + scaleBits > kGridBits || bits < kMinFractionBits) {
    defects.add(ErrorCode::TooLarge, {}, largest * maxScale);
    return 0;
  }
  return bits;
}

/// Makes corners what the stars of their vertices demand.
void sanitizeStars(const TetTopology& topology, const LocalParameters& parameters,
                   std::span<const StarBlock> stars, const Singularities& singularities,
                   double tolerance, Stage& stage, DefectCollector& defects, ExactMap& map) {
  std::vector<double> displacements(stars.size());
  struct Workspace {
    VertexSanitizer sanitizer;
    CornerRounder rounder;
  };
  const auto makeWorkspace = [&] {
    return Workspace{VertexSanitizer(parameters, singularities, tolerance, defects, map),
                     CornerRounder(topology, tolerance, defects, map)};
  };
  const auto runBlock = [&](std::size_t block, Workspace& workspace) {
    auto& [sanitizer, rounder] = workspace;
    for (std::size_t i = 0; i < stars[block].vertices.size(); ++i) {
      sanitizer.run(stars[block].vertices[i], stars[block].star(i), stars[block].planes[i]);
    }
    for (const auto& [corner, rounding] : stars[block].planeCorners) {
      rounder.run(corner, parameters(tetOf(corner), localOf(corner)), rounding);
    }
    // Of all blocks so far that had this workspace.
    displacements[block] = std::max(sanitizer.maxDisplacement(), rounder.maxDisplacement());
  };
  parallelForWith(stage, stars.size(), 1, makeWorkspace, runBlock);
  for (const double displacement : displacements) {
    map.maxDisplacement = std::max(map.maxDisplacement, displacement);
  }
}

}  // namespace

ExactMap sanitize(const TetTopology& topology, const LocalParameters& parameters,
                  Transitions transitions, const RegularVertices& survey,
                  const VertexKinds& vertices, const Singularities& singularities, double tolerance,
                  int maxScale, Stage& stage, DefectCollector& defects) {
  ExactMap map;
  map.transitions = std::move(transitions);
  checkBoundary(survey, parameters, tolerance, stage, defects);
  checkSingularities(singularities, parameters, tolerance, defects);
  map.unit = std::int64_t{1} << fractionBits(parameters.largest(), maxScale, defects);
  if (defects.has(ErrorCode::TooLarge)) return map;
  map.corners.resize(topology.tetCount());
  // Of two sums that give the volume, the shorter one: tet by tet, or along the boundary and the
  // cuts.
  const bool byTets = map.transitions.nonTrivial > topology.tetCount();
  const RoundedTets rounded =
      roundTets(topology, parameters, vertices.rounding, tolerance, byTets, stage, defects, map);
  sanitizeStars(topology, parameters, vertices.blocks, singularities, tolerance, stage, defects,
                map);
  checkOrientations(rounded.unfinished, parameters, stage, defects, map);
  if (byTets) {
    addVolume(rounded, stage, map);
  } else {
    addVolume(survey, stage, map);
  }
  return map;
}

void scaleMap(ExactMap& map, int scale, Stage& stage) {
  if (scale == 1) return;
  parallelFor(stage, map.corners.size(), kGrain, [&](std::size_t t) {
    for (LatticePoint& corner : map.corners[t]) {
      for (std::int64_t& coordinate : corner) coordinate *= scale;
    }
  });
  for (Transition& transition : map.transitions.table) {
    for (std::int32_t& component : transition.translation) component *= scale;
  }
  map.scale *= scale;
}

}  // namespace hexhex
