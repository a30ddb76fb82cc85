// Fits transitions to all inner faces (Section 5.1.1).
#include <algorithm>

#include <igm/transition_fit.hpp>
#include <igm/transitions.hpp>

namespace hexhex::igm {

namespace {

/// The result of fitting transitions to a block of triangles.
struct BlockResult {
  struct NonTrivial {
    adjacency::HalfFace here;  ///< the smaller half-face
    bool isExact;
    lattice::Transition transition;
  };
  std::vector<NonTrivial> nonTrivial;
  std::vector<Transitions::Misfit> misfits;
  double maxResidual = 0;
};

/// Fits transitions to the triangles on which tets disagree.
class TransitionFitter {
 public:
  TransitionFitter(const adjacency::TetTopology& topology, const LocalParameters& parameters,
                   std::span<const std::array<std::int8_t, 4>> rotations, double tolerance)
      : topology_(topology),
        parameters_(parameters),
        rotations_(rotations),
        tolerance_(tolerance) {}

  [[nodiscard]] BlockResult run(std::span<const adjacency::HalfFace> halfFaces) const {
    BlockResult block;
    for (const adjacency::HalfFace there : halfFaces) {
      const adjacency::HalfFace here = topology_.mate[there];
      const FittedTransition fitted = fit(here);
      block.maxResidual = std::max(block.maxResidual, fitted.residual);
      if (fitted.residual > tolerance_) block.misfits.push_back({here, fitted.residual});
      if (fitted.transition.isIdentity()) continue;
      block.nonTrivial.push_back({here, fitted.isExact, fitted.transition});
    }
    return block;
  }

 private:
  [[nodiscard]] FittedTransition fit(adjacency::HalfFace here) const {
    const SharedTriangle triangle(topology_, parameters_, here);
    const auto known = knownRotation(rotations_, here);
    return known ? fitTransition(triangle, *known) : fitTransition(triangle);
  }

  const adjacency::TetTopology& topology_;
  const LocalParameters& parameters_;
  std::span<const std::array<std::int8_t, 4>> rotations_;
  double tolerance_;
};

void enter(Index index, adjacency::HalfFace halfFace, const lattice::Transition& transition,
           bool isExact, Transitions& result) {
  result.ofFace[halfFace] = index;
  result.table[index] = transition;
  result.halfFaces[index] = halfFace;
  result.isExact[index] = isExact ? 1 : 0;
}

}  // namespace

Transitions computeTransitions(const adjacency::TetTopology& topology,
                               const LocalParameters& parameters, const RegularVertices& regular,
                               std::span<const std::array<std::int8_t, 4>> rotations,
                               double tolerance, Stage& stage) {
  const TransitionFitter fitter(topology, parameters, rotations, tolerance);
  std::vector<BlockResult> blocks(regular.unequalFaces.size());
  parallelFor(stage, blocks.size(), 1,
              [&](std::size_t block) { blocks[block] = fitter.run(regular.unequalFaces[block]); });
  Transitions result;
  result.innerFaces = regular.innerFaces;
  std::vector<std::uint64_t> first;
  for (const BlockResult& block : blocks) {
    first.push_back(result.nonTrivial);
    result.nonTrivial += block.nonTrivial.size();
    result.maxResidual = std::max(result.maxResidual, block.maxResidual);
    result.misfits.insert(result.misfits.end(), block.misfits.begin(), block.misfits.end());
  }
  result.ofFace.resize(4 * topology.tetCount());
  parallelBlocks(stage, result.ofFace.size(), 4 * RegularVertices::kBlock,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   std::fill(&result.ofFace[begin], &result.ofFace[begin] + (end - begin),
                             Index{0});
                 });
  result.table.resize(1 + 2 * result.nonTrivial);
  result.halfFaces.resize(result.table.size());
  result.isExact.resize(result.table.size());
  result.table.front() = {};
  result.halfFaces.front() = kNone;
  result.isExact.front() = 0;
  parallelFor(stage, blocks.size(), 1, [&](std::size_t block) {
    auto index = static_cast<Index>(1 + 2 * first[block]);
    for (const BlockResult::NonTrivial& face : blocks[block].nonTrivial) {
      enter(index++, face.here, face.transition, face.isExact, result);
      enter(index++, topology.mate[face.here], face.transition.inverse(), face.isExact, result);
    }
  });
  return result;
}

Array<HalfFaceTransition> findHalfFaceTransitions(const adjacency::TetTopology& topology,
                                                  const RegularVertices& regular,
                                                  const Transitions& transitions, Stage& stage) {
  Array<HalfFaceTransition> faceTransitions(topology.mate.size());
  const auto isCertain = [&](adjacency::HalfFace h) {
    return regular.sides[adjacency::tetOf(h)] != kUncertainSides;
  };
  parallelBlocks(stage, topology.tetCount(), RegularVertices::kBlock,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   std::fill(&faceTransitions[4 * begin],
                             &faceTransitions[4 * begin] + 4 * (end - begin), HalfFaceTransition());
                   for (auto t = static_cast<Index>(begin); t < end; ++t) {
                     if (regular.sides[t] != kUncertainSides) continue;
                     for (adjacency::HalfFace h = 4 * t; h < 4 * t + 4; ++h) {
                       faceTransitions[h] = HalfFaceTransition::inner(lattice::Rotation(), false);
                     }
                   }
                   for (const RegularVertices::BoundaryFace& face : regular.boundaryFaces[block]) {
                     const bool isConstant = face.constantAxes == 1U << face.axis;
                     faceTransitions[face.halfFace] = HalfFaceTransition::boundary(
                         face.axis, isConstant && isCertain(face.halfFace));
                   }
                 });
  parallelFor(stage, regular.unequalFaces.size(), 1, [&](std::size_t block) {
    for (const adjacency::HalfFace halfFace : regular.unequalFaces[block]) {
      for (const adjacency::HalfFace h : {halfFace, topology.mate[halfFace]}) {
        if (transitions.ofFace.empty()) {
          faceTransitions[h] = HalfFaceTransition::inner(lattice::Rotation(), false);
          continue;
        }
        const Index index = transitions.ofFace[h];
        faceTransitions[h] = HalfFaceTransition::inner(
            transitions.table[index].rotation, transitions.isExact[index] != 0 && isCertain(h));
      }
    }
  });
  return faceTransitions;
}

void collectMisfits(const Transitions& transitions, DefectCollector& defects) {
  for (const Transitions::Misfit& misfit : transitions.misfits) {
    defects.add(ErrorCode::TransitionResidual,
                {PlaceKind::Face, adjacency::tetOf(misfit.halfFace), misfit.halfFace % 4},
                misfit.residual);
  }
}

}  // namespace hexhex::igm
