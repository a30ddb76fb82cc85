#include <algorithm>
#include <limits>

#include <base/vector3.hpp>
#include <map/plain_vertices.hpp>
#include <map/transitions.hpp>

namespace hexhex {

namespace {

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

/// How well each of the 24 rotations carries two vectors over: the sum of scalar products of their
/// images with the ones wanted. A sum of three of nine products, each with either sign.
std::array<double, Rotation::kCount> agreements(const std::array<Vec3, 2>& vectors,
                                                const std::array<Vec3, 2>& images) {
  // towards[d][axis]: what sending this axis to direction d contributes.
  std::array<Vec3, kDirections> towards{};
  for (std::size_t d = 0; d < kDirections; ++d) {
    const double sign = signOf(static_cast<Direction>(d));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      towards[d][axis] = sign * (images[0][d / 2] * vectors[0][axis] +  //
                                 images[1][d / 2] * vectors[1][axis]);
    }
  }
  std::array<double, Rotation::kCount> sums{};
  for (std::size_t r = 0; r < sums.size(); ++r) {
    const Rotation rotation(static_cast<int>(r));
    sums[r] = towards[rotation(Direction{0})][0] + towards[rotation(Direction{2})][1] +
              towards[rotation(Direction{4})][2];
  }
  return sums;
}

/// argmin over the 24 rotations of how badly they carry the triangle's edges over. The squared
/// error is a constant minus twice the agreement; as the agreement is rounded, it only tells which
/// rotations need a closer look.
Rotation bestRotation(const SharedTriangle& triangle) {
  const Vec3 a = minus(triangle.here[1], triangle.here[0]);
  const Vec3 b = minus(triangle.here[2], triangle.here[0]);
  const Vec3 imageA = minus(triangle.there[1], triangle.there[0]);
  const Vec3 imageB = minus(triangle.there[2], triangle.there[0]);
  const std::array<double, Rotation::kCount> agreement = agreements({a, b}, {imageA, imageB});
  const double size = squaredNorm(a) + squaredNorm(b) + squaredNorm(imageA) + squaredNorm(imageB);
  // Far above rounding (a few 2^-53), far below what tells rotations apart.
  const double enough = *std::max_element(agreement.begin(), agreement.end()) - 0x1p-40 * size;
  Rotation best;
  double bestResidual = std::numeric_limits<double>::infinity();
  for (std::size_t index = 0; index < agreement.size(); ++index) {
    if (agreement[index] < enough) continue;
    const Rotation rotation(static_cast<int>(index));
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

/// Whether a + b is c, without rounding.
bool isSum(double a, double b, double c) {
  const double sum = a + b;
  const double rounded = sum - a;
  // What rounding took away (Knuth).
  const double rest = (a - (sum - rounded)) + (b - rounded);
  return sum == c && rest == 0;
}

bool isExact(const SharedTriangle& triangle, const Transition& transition) {
  bool exact = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 turned = transition.rotation(triangle.here[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      exact = exact && isSum(turned[k], transition.translation[k], triangle.there[i][k]);
    }
  }
  return exact;
}

/// A non-identity transition, found from the side of the smaller tet.
struct FoundJump {
  HalfFace halfFace;
  Transition transition;
  bool isExact;
};

struct BlockResult {
  std::vector<FoundJump> jumps;
  std::vector<Transitions::Misfit> misfits;
  double maxResidual = 0;
  Index firstJump = 0;  ///< index of its first jump in the table
};

/// Fits transitions to the triangles on which tets do not agree.
class TransitionFitter {
 public:
  TransitionFitter(const TetTopology& topology, const LocalParameters& parameters,
                   std::span<const std::array<std::int8_t, 4>> rotations, double tolerance)
      : topology_(topology),
        parameters_(parameters),
        rotations_(rotations),
        tolerance_(tolerance) {}

  [[nodiscard]] BlockResult run(std::span<const HalfFace> halfFaces) const {
    BlockResult block;
    for (const HalfFace here : halfFaces) {
      const SharedTriangle triangle =
          sharedTriangle(topology_, parameters_, here, topology_.mate[here]);
      double residual = 0;
      const Transition transition = fitTranslation(triangle, rotation(here, triangle), residual);
      block.maxResidual = std::max(block.maxResidual, residual);
      if (residual > tolerance_) block.misfits.push_back({here, residual});
      if (transition.isIdentity()) continue;
      block.jumps.push_back({here, transition, isExact(triangle, transition)});
    }
    return block;
  }

 private:
  [[nodiscard]] Rotation rotation(HalfFace here, const SharedTriangle& triangle) const {
    const int known = rotations_.empty() ? -1 : rotations_[tetOf(here)][here % 4];
    return known >= 0 && known < Rotation::kCount ? rotationFromAlgoHex(known)
                                                  : bestRotation(triangle);
  }

  const TetTopology& topology_;
  const LocalParameters& parameters_;
  std::span<const std::array<std::int8_t, 4>> rotations_;
  double tolerance_;
};

}  // namespace

Transitions computeTransitions(const TetTopology& topology, const LocalParameters& parameters,
                               const PlainVertices& plain,
                               std::span<const std::array<std::int8_t, 4>> rotations,
                               double tolerance, Stage& stage) {
  Transitions result;
  result.jump.resize(4 * topology.tetCount());
  result.innerFaces = plain.innerFaces;
  const TransitionFitter fitter(topology, parameters, rotations, tolerance);
  std::vector<BlockResult> blocks(plain.unequalFaces.size());
  parallelBlocks(stage, topology.tetCount(), PlainVertices::kBlock,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   std::fill(&result.jump[4 * begin], &result.jump[4 * begin] + 4 * (end - begin),
                             Index{0});
                   blocks[block] = fitter.run(plain.unequalFaces[block]);
                 });
  for (BlockResult& block : blocks) {
    block.firstJump = static_cast<Index>(1 + 2 * result.jumps);
    result.maxResidual = std::max(result.maxResidual, block.maxResidual);
    result.jumps += block.jumps.size();
    result.misfits.insert(result.misfits.end(), block.misfits.begin(), block.misfits.end());
  }
  result.table.resize(1 + 2 * result.jumps);
  result.isExact.resize(result.table.size());
  parallelFor(stage, blocks.size(), 1, [&](std::size_t block) {
    Index index = blocks[block].firstJump;
    for (const FoundJump& found : blocks[block].jumps) {
      result.jump[found.halfFace] = index;
      result.jump[topology.mate[found.halfFace]] = index + 1;
      result.table[index] = found.transition;
      result.table[index + 1] = found.transition.inverse();
      result.isExact[index] = result.isExact[index + 1] = found.isExact ? 1 : 0;
      index += 2;
    }
  });
  return result;
}

void collectMisfits(const Transitions& transitions, DefectCollector& defects) {
  for (const Transitions::Misfit& misfit : transitions.misfits) {
    defects.add(ErrorCode::TransitionResidual,
                {PlaceKind::Face, tetOf(misfit.halfFace), misfit.halfFace % 4}, misfit.residual);
  }
}

}  // namespace hexhex
