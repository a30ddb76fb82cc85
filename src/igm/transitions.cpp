#include <algorithm>

#include <igm/transition_fit.hpp>
#include <igm/transitions.hpp>

namespace hexhex::igm {

namespace {

/// What fitting transitions to a block of triangles gives.
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

/// Fits transitions to the triangles on which tets do not agree.
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
                               const LocalParameters& parameters, const RegularVertices& survey,
                               std::span<const std::array<std::int8_t, 4>> rotations,
                               double tolerance, Stage& stage) {
  const TransitionFitter fitter(topology, parameters, rotations, tolerance);
  std::vector<BlockResult> blocks(survey.unequalFaces.size());
  parallelFor(stage, blocks.size(), 1,
              [&](std::size_t block) { blocks[block] = fitter.run(survey.unequalFaces[block]); });
  Transitions result;
  result.innerFaces = survey.innerFaces;
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

Array<HalfFaceCrossing> findCrossings(const adjacency::TetTopology& topology,
                                      const RegularVertices& survey, const Transitions& transitions,
                                      Stage& stage) {
  Array<HalfFaceCrossing> crossings(topology.mate.size());
  const auto isCertain = [&](adjacency::HalfFace h) {
    return survey.sides[adjacency::tetOf(h)] != kUncertainSides;
  };
  parallelBlocks(stage, topology.tetCount(), RegularVertices::kBlock,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   std::fill(&crossings[4 * begin], &crossings[4 * begin] + 4 * (end - begin),
                             HalfFaceCrossing());
                   for (auto t = static_cast<Index>(begin); t < end; ++t) {
                     if (survey.sides[t] != kUncertainSides) continue;
                     for (adjacency::HalfFace h = 4 * t; h < 4 * t + 4; ++h) {
                       crossings[h] = HalfFaceCrossing::inner(lattice::Rotation(), false);
                     }
                   }
                   for (const RegularVertices::BoundaryFace& face : survey.boundaryFaces[block]) {
                     const bool isConstant = face.constantAxes == 1U << face.axis;
                     crossings[face.halfFace] = HalfFaceCrossing::boundary(
                         face.axis, isConstant && isCertain(face.halfFace));
                   }
                 });
  parallelFor(stage, survey.unequalFaces.size(), 1, [&](std::size_t block) {
    for (const adjacency::HalfFace halfFace : survey.unequalFaces[block]) {
      for (const adjacency::HalfFace h : {halfFace, topology.mate[halfFace]}) {
        if (transitions.ofFace.empty()) {
          crossings[h] = HalfFaceCrossing::inner(lattice::Rotation(), false);
          continue;
        }
        const Index index = transitions.ofFace[h];
        crossings[h] = HalfFaceCrossing::inner(transitions.table[index].rotation,
                                               transitions.isExact[index] != 0 && isCertain(h));
      }
    }
  });
  return crossings;
}

void collectMisfits(const Transitions& transitions, DefectCollector& defects) {
  for (const Transitions::Misfit& misfit : transitions.misfits) {
    defects.add(ErrorCode::TransitionResidual,
                {PlaceKind::Face, adjacency::tetOf(misfit.halfFace), misfit.halfFace % 4},
                misfit.residual);
  }
}

}  // namespace hexhex::igm
