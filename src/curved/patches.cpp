#include <string>
#include <vector>

#include <curved/face_cutter.hpp>
#include <curved/patches.hpp>

namespace hexhex {

namespace {

/// Where the pieces of a block go.
struct PiecePlaces {
  std::uint64_t polygon = 0;
  std::uint64_t corner = 0;
  std::uint64_t point = 0;
};

/// Moves the pieces of a block to their places.
void join(PatchPieces& pieces, const PiecePlaces& to, std::uint64_t firstInnerPoint,
          Patches& patches) {
  std::uint64_t corner = to.corner;
  for (std::size_t i = 0; i < pieces.carriers.size(); ++i) {
    patches.cornerBegin[to.polygon + i] = corner;
    corner += pieces.cornerCounts[i];
    patches.polygonTet[to.polygon + i] = pieces.carriers[i].tet;
    patches.polygonCorners[to.polygon + i] = pieces.carriers[i].corners;
  }
  for (std::size_t i = 0; i < pieces.corners.size(); ++i) {
    std::uint64_t number = pieces.corners[i];
    if (number >= firstInnerPoint) number += to.point;
    patches.corners[to.corner + i] = static_cast<Index>(number);
    patches.parameters[to.corner + i] = pieces.parameters[i];
  }
  for (std::size_t i = 0; i < pieces.points.size(); ++i) {
    patches.points[to.point + i] = pieces.points[i];
    patches.generatorTet[to.point + i] = pieces.generators[i].tet;
    patches.generatorCorners[to.point + i] = pieces.generators[i].corners;
  }
  pieces = {};
}

void requireIndexable(std::uint64_t points) {
  if (points < kNone) return;
  throw Error(ErrorCode::TooLarge, "Vertices, arcs and patches would have " +
                                       std::to_string(points) +
                                       " points, more than 32-bit indices can number. Lower the "
                                       "scale.");
}

/// Places of all blocks; the last entry has the totals.
std::vector<PiecePlaces> placesOf(const std::vector<PatchPieces>& blocks) {
  std::vector<PiecePlaces> places(1);
  for (const PatchPieces& block : blocks) {
    PiecePlaces next = places.back();
    next.polygon += block.carriers.size();
    next.corner += block.corners.size();
    next.point += block.points.size();
    places.push_back(next);
  }
  return places;
}

void reserve(Patches& patches, const PiecePlaces& totals) {
  patches.cornerBegin.resize(totals.polygon + 1);
  patches.cornerBegin.back() = totals.corner;
  patches.polygonTet.resize(totals.polygon);
  patches.polygonCorners.resize(totals.polygon);
  patches.corners.resize(totals.corner);
  patches.parameters.resize(totals.corner);
  patches.points.resize(totals.point);
  patches.generatorTet.resize(totals.point);
  patches.generatorCorners.resize(totals.point);
}

}  // namespace

Patches cutPatches(const PatchInput& input, Stage& stage) {
  const std::uint64_t firstInnerPoint = input.vertices.count() + input.arcs.points.size();
  requireIndexable(firstInnerPoint);
  Patches patches;
  const std::size_t faces = input.faces.count();
  patches.vertices.resize(faces);
  patches.arcs.resize(faces);
  patches.reversedArcs.resize(faces);
  patches.polygonBegin.resize(faces + 1);
  patches.polygonBegin.back() = 0;
  const std::size_t tets = input.map.topology.tetCount();
  std::vector<PatchPieces> blocks(blockCount(tets, kSweepBlock));
  parallelBlocks(stage, tets, kSweepBlock,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   FaceCutter cutter(input, firstInnerPoint, blocks[block]);
                   for (std::size_t t = begin; t < end; ++t) {
                     const auto tet = static_cast<Index>(t);
                     input.faces.forEach(tet, [&](const Element& face) {
                       const FaceCutter::Border border = cutter.cut(tet, face);
                       patches.vertices[face.number] = border.vertices;
                       patches.arcs[face.number] = border.arcs;
                       patches.reversedArcs[face.number] = border.reversed;
                       patches.polygonBegin[face.number] = border.polygons;
                     });
                   }
                 });
  exclusiveScan(std::span(patches.polygonBegin));
  const std::vector<PiecePlaces> places = placesOf(blocks);
  requireIndexable(firstInnerPoint + places.back().point);
  reserve(patches, places.back());
  parallelFor(stage, blocks.size(), 1, [&](std::size_t block) {
    join(blocks[block], places[block], firstInnerPoint, patches);
  });
  return patches;
}

}  // namespace hexhex
