#include <algorithm>
#include <limits>

#include <base/vector3.hpp>
#include <map/transitions.hpp>

namespace hexhex {

namespace {

constexpr std::size_t kGrain = 4096;

/// The smallest step by which charts are moved: maps whose coordinates stay below half of it,
/// nearly all, are not moved at all. It costs ten of the 52 bits of a coordinate.
constexpr double kMinChartGrid = 1024;

/// Beyond, a double has no fractional bits worth the name.
constexpr double kMaxParameter = 0x1p48;

/// Translations between charts are 32-bit integers: with coordinates below this they, and twice
/// them, fit. (Sanitization, which knows the scale, allows no more either.)
constexpr double kMaxLocalParameter = 0x1p28;

/// Largest coordinate, and largest extent of a tet along an axis.
struct Sizes {
  double coordinate = 0;
  double extent = 0;
};

Sizes measure(std::span<const TetParameters> parameters, Stage& stage) {
  std::vector<Sizes> blocks(blockCount(parameters.size(), kGrain));
  parallelBlocks(stage, parameters.size(), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   Sizes sizes;
                   for (std::size_t t = begin; t < end; ++t) {
                     const TetParameters& u = parameters[t];
                     for (std::size_t k = 0; k < 3; ++k) {
                       const auto [low, high] = std::minmax({u[0][k], u[1][k], u[2][k], u[3][k]});
                       sizes.coordinate = std::max({sizes.coordinate, -low, high});
                       sizes.extent = std::max(sizes.extent, high - low);
                     }
                   }
                   blocks[block] = sizes;
                 });
  Sizes total;
  for (const Sizes& sizes : blocks) {
    total.coordinate = std::max(total.coordinate, sizes.coordinate);
    total.extent = std::max(total.extent, sizes.extent);
  }
  return total;
}

double distance(const Vec3& a, const Vec3& b) {
  return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

double squaredNorm(const Vec3& a) { return dot(a, a); }

/// The three corners of a triangle in the charts of both its tets.
struct SharedTriangle {
  std::array<Vec3, 3> here;
  std::array<Vec3, 3> there;
};

SharedTriangle sharedTriangle(const TetTopology& topology, const LocalParameters& parameters,
                              HalfFace here, HalfFace there) {
  SharedTriangle triangle;
  const Tet& tet = topology.tets[tetOf(here)];
  for (std::size_t k = 0; k < 3; ++k) {
    const int corner = kFaceCorners[here % 4][k];
    triangle.here[k] = parameters(tetOf(here), corner);
    triangle.there[k] = parameters(
        tetOf(there), topology.localCorner(tetOf(there), tet[static_cast<std::size_t>(corner)]));
  }
  return triangle;
}

/// argmin over the 24 rotations of how badly they carry the triangle's edges over.
Rotation bestRotation(const SharedTriangle& triangle) {
  const Vec3 a = minus(triangle.here[1], triangle.here[0]);
  const Vec3 b = minus(triangle.here[2], triangle.here[0]);
  const Vec3 imageA = minus(triangle.there[1], triangle.there[0]);
  const Vec3 imageB = minus(triangle.there[2], triangle.there[0]);
  Rotation best;
  double bestResidual = std::numeric_limits<double>::infinity();
  for (int index = 0; index < Rotation::kCount; ++index) {
    const Rotation rotation(index);
    const double residual =
        squaredNorm(minus(imageA, rotation(a))) + squaredNorm(minus(imageB, rotation(b)));
    if (residual < bestResidual) {
      bestResidual = residual;
      best = rotation;
    }
  }
  return best;
}

/// The integer translation that fits best, and what remains.
Transition fitTranslation(const SharedTriangle& triangle, Rotation rotation, double& residual) {
  Transition transition{rotation, {}};
  Vec3 mean{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 difference = minus(triangle.there[i], rotation(triangle.here[i]));
    for (std::size_t k = 0; k < 3; ++k) mean[k] += difference[k] / 3;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    transition.translation[k] = static_cast<std::int32_t>(std::nearbyint(mean[k]));
  }
  residual = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    residual = std::max(residual, distance(triangle.there[i], transition(triangle.here[i], 1.0)));
  }
  return transition;
}

/// A non-identity transition, found from the side of the smaller tet.
struct FoundJump {
  HalfFace halfFace;
  Transition transition;
};

struct BlockResult {
  std::vector<FoundJump> jumps;
  double maxResidual = 0;
  std::uint64_t innerFaces = 0;
};

}  // namespace

LocalParameters::LocalParameters(const TetMapView& map, Stage& stage, DefectCollector& defects)
    : parameters_(map.parameters) {
  const Sizes sizes = measure(map.parameters, stage);
  if (sizes.coordinate > kMaxParameter) {
    defects.add(ErrorCode::TooLarge, {}, sizes.coordinate);
    return;
  }
  grid_ = kMinChartGrid;
  while (grid_ < 4 * sizes.extent) grid_ *= 2;
  moved_ = sizes.coordinate > grid_ / 2;
  largest_ = moved_ ? grid_ / 2 + sizes.extent : sizes.coordinate;
  if (largest_ > kMaxLocalParameter) defects.add(ErrorCode::TooLarge, {}, largest_);
}

Transitions computeTransitions(const TetTopology& topology, const LocalParameters& parameters,
                               std::span<const std::array<std::int8_t, 4>> rotations,
                               double tolerance, Stage& stage, DefectCollector& defects) {
  Transitions result;
  result.jump.resize(4 * topology.tetCount());
  result.table.push_back({});
  const auto across = [&](HalfFace here, HalfFace there, BlockResult& block) {
    const SharedTriangle triangle = sharedTriangle(topology, parameters, here, there);
    if (triangle.here == triangle.there) return;
    const int known = rotations.empty() ? -1 : rotations[tetOf(here)][here % 4];
    const Rotation rotation = known >= 0 && known < Rotation::kCount ? rotationFromAlgoHex(known)
                                                                     : bestRotation(triangle);
    double residual = 0;
    const Transition transition = fitTranslation(triangle, rotation, residual);
    block.maxResidual = std::max(block.maxResidual, residual);
    if (residual > tolerance) {
      defects.add(ErrorCode::TransitionResidual, {PlaceKind::Face, tetOf(here), here % 4},
                  residual);
    }
    if (!transition.isIdentity()) block.jumps.push_back({here, transition});
  };
  std::vector<BlockResult> blocks(blockCount(topology.tetCount(), kGrain));
  parallelBlocks(stage, topology.tetCount(), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   for (std::size_t h = 4 * begin; h < 4 * end; ++h) {
                     const auto here = static_cast<HalfFace>(h);
                     const HalfFace there = topology.mate[here];
                     result.jump[here] = 0;
                     if (there == kNone || there < here) continue;
                     ++blocks[block].innerFaces;
                     across(here, there, blocks[block]);
                   }
                 });
  for (const BlockResult& block : blocks) {
    result.maxResidual = std::max(result.maxResidual, block.maxResidual);
    result.innerFaces += block.innerFaces;
    result.jumps += block.jumps.size();
  }
  result.table.reserve(1 + 2 * result.jumps);
  for (const BlockResult& block : blocks) {
    for (const FoundJump& found : block.jumps) {
      result.jump[found.halfFace] = static_cast<Index>(result.table.size());
      result.table.push_back(found.transition);
      result.jump[topology.mate[found.halfFace]] = static_cast<Index>(result.table.size());
      result.table.push_back(found.transition.inverse());
    }
  }
  return result;
}

}  // namespace hexhex
