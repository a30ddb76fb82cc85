#include <algorithm>

#include <base/branchless.hpp>
#include <base/vector3.hpp>
#include <map/best_rotation.hpp>
#include <map/plain_vertices.hpp>
#include <map/transitions.hpp>
#include <map/turn.hpp>

namespace hexhex {

namespace {

/// Triangles between asking for a tet and looking at it: the memory's delay, in steps of a loop.
constexpr std::size_t kFacesAhead = 4;

double distance(const Vec3& a, const Vec3& b) {
  return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

/// The three corners of a triangle in the charts of both its tets.
struct SharedTriangle {
  std::array<Vec3, 3> here;
  std::array<Vec3, 3> there;
};

SharedTriangle sharedTriangle(const TetTopology& topology, const LocalParameters& parameters,
                              HalfFace here, HalfFace there) {
  const SharedFace face(topology, here, there);
  SharedTriangle triangle;
  for (std::size_t k = 0; k < 3; ++k) {
    triangle.here[k] = parameters.at(tetOf(here), face.here(k));
    triangle.there[k] = parameters.at(tetOf(there), face.there(k));
  }
  return triangle;
}

Rotation rotationOf(const SharedTriangle& triangle) {
  return bestRotation(
      {minus(triangle.here[1], triangle.here[0]), minus(triangle.here[2], triangle.here[0])},
      {minus(triangle.there[1], triangle.there[0]), minus(triangle.there[2], triangle.there[0])});
}

/// What remains when a transition carries corners over.
double residualOf(const SharedTriangle& triangle, const std::array<Vec3, 3>& images,
                  const Vec3& translation) {
  double residual = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    residual = std::max(residual, distance(triangle.there[i], plus(images[i], translation)));
  }
  return residual;
}

/// The integers nearest to the mean of what is left of the corners after the rotation.
Vec3 meanTranslation(const SharedTriangle& triangle, const std::array<Vec3, 3>& images) {
  Vec3 mean{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 difference = minus(triangle.there[i], images[i]);
    for (std::size_t k = 0; k < 3; ++k) mean[k] += difference[k] / 3;
  }
  for (double& component : mean) component = nearestInteger(component);
  return mean;
}

/// Whether nothing is rounded when corners are moved by a translation that leaves no residual. If
/// a + b is not its rounded sum c, then c - a, with a the larger of the two, is a number other than
/// b, and exact (Dekker).
bool isExact(const SharedTriangle& triangle, const std::array<Vec3, 3>& images,
             const Vec3& translation) {
  double rest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double sum = triangle.there[i][k];
      rest += std::abs((sum - images[i][k]) - translation[k]) +
              std::abs((sum - translation[k]) - images[i][k]);
    }
  }
  return rest == 0;
}

/// The transition with a given rotation, and how well it does.
struct FittedTransition {
  Transition transition;
  double residual = 0;
  bool isExact = false;
};

FittedTransition fitTranslation(const SharedTriangle& triangle, Rotation rotation) {
  std::array<Vec3, 3> images{};
  for (std::size_t i = 0; i < 3; ++i) images[i] = turned(rotation, triangle.here[i]);
  Vec3 translation = minus(triangle.there[0], images[0]);
  for (double& component : translation) component = nearestInteger(component);
  FittedTransition fitted;
  fitted.residual = residualOf(triangle, images, translation);
  // If it fits each corner to within a quarter, it is what the mean is nearest to.
  if (fitted.residual > 0.25) {
    translation = meanTranslation(triangle, images);
    fitted.residual = residualOf(triangle, images, translation);
  }
  fitted.isExact = fitted.residual == 0 && isExact(triangle, images, translation);
  fitted.transition.rotation = rotation;
  for (std::size_t k = 0; k < 3; ++k) {
    fitted.transition.translation[k] = static_cast<std::int32_t>(translation[k]);
  }
  return fitted;
}

Transition inverse(const Transition& transition) {
  Transition back{inverseOf(transition.rotation), {}};
  back.translation = turned(back.rotation, transition.translation);
  for (std::int32_t& component : back.translation) component = -component;
  return back;
}

/// What a block of triangles tells besides its transitions.
struct BlockResult {
  std::vector<Transitions::Misfit> misfits;
  double maxResidual = 0;
  Index beginJump = 0;  ///< place in the table of the first transition
  Index endJump = 0;    ///< behind the last one
};

/// Fits transitions to the triangles on which tets do not agree.
class TransitionFitter {
 public:
  /// @param result  receives transitions
  TransitionFitter(const TetTopology& topology, const LocalParameters& parameters,
                   std::span<const std::array<std::int8_t, 4>> rotations, double tolerance,
                   PlainVertices& plain, Transitions& result)
      : topology_(topology),
        parameters_(parameters),
        rotations_(rotations),
        tolerance_(tolerance),
        plain_(plain),
        result_(result) {}

  /// @param index  in the table, of the first transition
  [[nodiscard]] BlockResult run(std::span<const HalfFace> halfFaces, Index index) const {
    BlockResult block;
    block.beginJump = index;
    for (std::size_t i = 0; i < halfFaces.size(); ++i) {
      const HalfFace there = halfFaces[i];
      const HalfFace here = topology_.mate[there];  // the smaller one
      const std::size_t ahead = std::min(i + kFacesAhead, halfFaces.size() - 1);
      parameters_.prefetch(tetOf(topology_.mate[halfFaces[ahead]]));
      const SharedTriangle triangle = sharedTriangle(topology_, parameters_, here, there);
      const FittedTransition fitted = fitTranslation(triangle, rotation(here, triangle));
      block.maxResidual = std::max(block.maxResidual, fitted.residual);
      if (fitted.residual > tolerance_) block.misfits.push_back({here, fitted.residual});
      if (fitted.transition.isIdentity()) continue;  // rough, as it does not fit exactly
      enter(index, here, fitted.transition, fitted.isExact);
      enter(index + 1, there, inverse(fitted.transition), fitted.isExact);
      for (const auto& [halfFace, jump] : {std::pair(here, index), std::pair(there, index + 1)}) {
        const bool isSure = plain_.sides[tetOf(halfFace)] != kUncertainSides;
        plain_.passages[halfFace] =
            Passage::across(result_.table[jump].rotation, allOf(isSure, fitted.isExact));
        result_.jump[halfFace] = jump;
      }
      index += 2;
    }
    block.endJump = index;
    return block;
  }

 private:
  [[nodiscard]] Rotation rotation(HalfFace here, const SharedTriangle& triangle) const {
    const int known = rotations_.empty() ? -1 : rotations_[tetOf(here)][here % 4];
    return known >= 0 && known < Rotation::kCount ? rotationFromAlgoHex(known)
                                                  : rotationOf(triangle);
  }
  void enter(Index index, HalfFace halfFace, const Transition& transition, bool isExact) const {
    result_.table[index] = transition;
    result_.halfFaces[index] = halfFace;
    result_.isExact[index] = isExact ? 1 : 0;
  }

  const TetTopology& topology_;
  const LocalParameters& parameters_;
  std::span<const std::array<std::int8_t, 4>> rotations_;
  double tolerance_;
  PlainVertices& plain_;
  Transitions& result_;
};

/// Makes room for as many transitions and their inverses. The first entry is the identity.
void makeRoom(Transitions& transitions, std::uint64_t jumps) {
  transitions.table.resize(1 + 2 * jumps);
  transitions.halfFaces.resize(1 + 2 * jumps);
  transitions.isExact.resize(1 + 2 * jumps);
  transitions.table.front() = {};
  transitions.halfFaces.front() = kNone;
  transitions.isExact.front() = 0;
}

/// Closes the gaps that triangles have left whose transitions are identities.
void closeGaps(std::span<const BlockResult> blocks, Transitions& transitions) {
  Index place = 1;
  for (const BlockResult& block : blocks) {
    for (Index from = block.beginJump; from < block.endJump; ++from, ++place) {
      transitions.table[place] = transitions.table[from];
      transitions.isExact[place] = transitions.isExact[from];
      const HalfFace halfFace = transitions.halfFaces[from];
      transitions.halfFaces[place] = halfFace;
      transitions.jump[halfFace] = place;
    }
  }
  makeRoom(transitions, place / 2);
}

}  // namespace

Transitions computeTransitions(const TetTopology& topology, const LocalParameters& parameters,
                               PlainVertices& plain,
                               std::span<const std::array<std::int8_t, 4>> rotations,
                               double tolerance, Stage& stage) {
  Transitions result;
  result.innerFaces = plain.innerFaces;
  result.jump.resize(4 * topology.tetCount());
  parallelBlocks(stage, topology.tetCount(), PlainVertices::kBlock,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   std::fill(&result.jump[4 * begin], &result.jump[4 * begin] + 4 * (end - begin),
                             Index{0});
                 });
  std::vector<std::uint64_t> first(plain.unequalFaces.size() + 1);
  for (std::size_t block = 0; block + 1 < first.size(); ++block) {
    first[block] = plain.unequalFaces[block].size();
  }
  const std::uint64_t unequal = exclusiveScan(std::span(first));
  makeRoom(result, unequal);
  const TransitionFitter fitter(topology, parameters, rotations, tolerance, plain, result);
  std::vector<BlockResult> blocks(plain.unequalFaces.size());
  parallelFor(stage, blocks.size(), 1, [&](std::size_t block) {
    blocks[block] = fitter.run(plain.unequalFaces[block], static_cast<Index>(1 + 2 * first[block]));
  });
  for (const BlockResult& block : blocks) {
    result.maxResidual = std::max(result.maxResidual, block.maxResidual);
    result.misfits.insert(result.misfits.end(), block.misfits.begin(), block.misfits.end());
    result.jumps += (block.endJump - block.beginJump) / 2;
  }
  if (result.jumps < unequal) closeGaps(blocks, result);
  return result;
}

void collectMisfits(const Transitions& transitions, DefectCollector& defects) {
  for (const Transitions::Misfit& misfit : transitions.misfits) {
    defects.add(ErrorCode::TransitionResidual,
                {PlaceKind::Face, tetOf(misfit.halfFace), misfit.halfFace % 4}, misfit.residual);
  }
}

}  // namespace hexhex
