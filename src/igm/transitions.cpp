#include <algorithm>

#include <base/branchless.hpp>
#include <igm/plain_vertices.hpp>
#include <igm/transition_fit.hpp>
#include <igm/transitions.hpp>
#include <igm/turn.hpp>

namespace hexhex {

namespace {

/// Triangles between asking for a tet and looking at it: the memory's delay, in steps of a loop.
constexpr std::size_t kFacesAhead = 4;

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
      const FittedTransition fitted = fit(here, there);
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
  [[nodiscard]] FittedTransition fit(HalfFace here, HalfFace there) const {
    const int known = rotations_.empty() ? -1 : rotations_[tetOf(here)][here % 4];
    return known >= 0 && known < Rotation::kCount
               ? fitTransition(topology_, parameters_, here, there, rotationFromAlgoHex(known))
               : fitTransition(topology_, parameters_, here, there);
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
