// What is manifold, and the choice among the structures.
#include "campaign/block_structure.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <vector>

#include <base/disjoint_sets.hpp>

namespace hexhex::campaign {

namespace {

using samples::BlockComplex;
using samples::BlockModel;
using samples::BlockPart;
using samples::CoarseCell;
using samples::Occurrence;

/// Whether the blocks around a cell are connected through faces around it.
bool isStarConnected(const BlockComplex& complex, const CoarseCell& cell) {
  DisjointSets sets(complex.blockCount());
  for (const Occurrence& at : cell.occurrences) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const int side = at.part.digits[axis];
      if (side == BlockPart::kAlong) continue;
      const auto other = complex.neighbour(at.block, axis, side);
      if (other) sets.unite(static_cast<Index>(at.block), static_cast<Index>(other->block));
    }
  }
  const auto setOf = [&](const Occurrence& at) { return sets.find(static_cast<Index>(at.block)); };
  return std::all_of(cell.occurrences.begin(), cell.occurrences.end(), [&](const Occurrence& at) {
    return setOf(at) == setOf(cell.occurrences.front());
  });
}

/// Of the surface (around a vertex) or curve (around an edge) in which a small sphere around the
/// cell cuts the blocks: a cell of dimension d around it leaves one of d - dimension - 1.
std::int64_t eulerCharacteristicOfLink(const BlockComplex& complex, const CoarseCell& cell) {
  std::set<std::size_t> around;
  for (const Occurrence& at : cell.occurrences) {
    for (std::size_t code = 0; code < BlockPart::kCount; ++code) {
      const BlockPart part = BlockPart::fromCode(code);
      if (part.dimension() > cell.dimension && part.contains(at.part)) {
        around.insert(complex.find(at.block, part).cell);
      }
    }
  }
  std::int64_t sum = 0;
  for (const std::size_t other : around) {
    sum += (complex.cells()[other].dimension - cell.dimension) % 2 == 1 ? 1 : -1;
  }
  return sum;
}

/// The same blocks, each with its frame turned in one of 24 ways.
void turnBlocks(BlockModel& model, Random& random) {
  for (std::size_t block = 0; block < model.blocks.size(); ++block) {
    const lattice::Rotation rotation(static_cast<int>(random.below(lattice::Rotation::kCount)));
    const samples::BlockCorners corners = model.blocks[block];
    const std::array<Vec3, 8> shape = model.shapes[block];
    for (std::size_t c = 0; c < 8; ++c) {
      std::array<int, 3> fromCentre{};
      for (std::size_t a = 0; a < 3; ++a) fromCentre[a] = (c >> a & 1) == 1 ? 1 : -1;
      fromCentre = rotation(fromCentre);
      std::size_t turned = 0;
      for (std::size_t a = 0; a < 3; ++a) turned |= std::size_t{fromCentre[a] > 0} << a;
      model.blocks[block][c] = corners[turned];
      model.shapes[block][c] = shape[turned];
    }
  }
}

}  // namespace

bool isManifold(const BlockComplex& complex) {
  return std::all_of(complex.cells().begin(), complex.cells().end(), [&](const CoarseCell& cell) {
    if (cell.dimension == 3) return cell.valence() == 1;
    if (cell.dimension == 2) return cell.valence() <= 2;
    // A circle has 0, an arc and a disc 1, a sphere 2.
    const std::int64_t inside = cell.dimension == 1 ? 0 : 2;
    return isStarConnected(complex, cell) &&
           eulerCharacteristicOfLink(complex, cell) == (cell.boundary ? 1 : inside);
  });
}

BlockStructure drawSampleBlocks(Random& random) {
  const auto kinds = sampleKinds();
  const SampleKindName& chosen = kinds[random.below(kinds.size())];
  std::uint64_t span = 10;
  if (random.below(8) == 0) span = random.below(8) == 0 ? 600 : 60;
  const auto valence = static_cast<int>(3 + random.below(span));
  return {"blocks of a " + std::string(chosen.name), samples::blockModel(chosen.kind, valence)};
}

BlockStructure drawBlockStructure(Random& random) {
  constexpr std::array kDraws = {drawPolycube,       drawGluedCubes, drawGluedCubes,
                                 drawClosedManifold, drawPrism,      drawTwistedRing,
                                 drawCutTets,        drawHexMesh,    drawSampleBlocks};
  BlockStructure structure = kDraws[random.below(kDraws.size())](random);
  if (structure.model.warp == nullptr && random.below(2) == 0) turnBlocks(structure.model, random);
  return structure;
}

}  // namespace hexhex::campaign
