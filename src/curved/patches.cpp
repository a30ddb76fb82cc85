#include <algorithm>
#include <cassert>
#include <string>
#include <vector>

#include <curved/batches.hpp>
#include <curved/face_cutter.hpp>
#include <curved/patches.hpp>

namespace hexhex::curved {

namespace {

/// Where a block's pieces go.
struct PiecePlaces {
  std::uint64_t polygon = 0;
  std::uint64_t corner = 0;
  std::uint64_t point = 0;
};

/// Copies a block's pieces to their places.
void join(const PatchPieces& pieces, const PiecePlaces& to, std::uint64_t firstInnerPoint,
          Patches& patches) {
  std::uint64_t corner = to.corner;
  for (std::size_t i = 0; i < pieces.carriers.size(); ++i) {
    patches.cornerBegin[to.polygon + i] = corner;
    corner += pieces.cornerCounts[i];
    patches.polygonTet[to.polygon + i] = pieces.carriers[i].tet;
    patches.polygonCorners[to.polygon + i] = pieces.carriers[i].corners;
  }
  assert(corner == to.corner + pieces.corners.size());
  assert(pieces.parameters.size() == pieces.corners.size());
  assert(pieces.generators.size() == pieces.points.size());
  const auto shift = static_cast<Index>(to.point);
  for (std::size_t i = 0; i < pieces.corners.size(); ++i) {
    const Index number = pieces.corners[i];
    patches.corners[to.corner + i] = number + (number >= firstInnerPoint ? shift : 0);
  }
  std::copy_n(pieces.parameters.data(), pieces.parameters.size(),
              patches.parameters.data() + to.corner);
  std::copy_n(pieces.points.data(), pieces.points.size(), patches.points.data() + to.point);
  for (std::size_t i = 0; i < pieces.generators.size(); ++i) {
    patches.generatorTet[to.point + i] = pieces.generators[i].tet;
    patches.generatorCorners[to.point + i] = pieces.generators[i].corners;
  }
}

void requireIndexable(std::uint64_t points) {
  if (points < kNone) return;
  throw Error(ErrorCode::TooLarge, "Vertices, arcs and patches would have " +
                                       std::to_string(points) +
                                       " points, more than 32-bit indices can number. Lower the "
                                       "scale.");
}

/// Makes room.
/// @param share  of all faces whose pieces then have room
void lengthenAll(Patches& patches, const PiecePlaces& totals, double share) {
  lengthen(patches.cornerBegin, totals.polygon + 1, share);
  lengthen(patches.polygonTet, totals.polygon, share);
  lengthen(patches.polygonCorners, totals.polygon, share);
  lengthen(patches.corners, totals.corner, share);
  lengthen(patches.parameters, totals.corner, share);
  lengthen(patches.points, totals.point, share);
  lengthen(patches.generatorTet, totals.point, share);
  lengthen(patches.generatorCorners, totals.point, share);
  patches.cornerBegin.back() = totals.corner;
}

Patches ofFaces(std::uint64_t faces) {
  Patches patches;
  patches.vertices.resize(faces);
  patches.arcs.resize(faces);
  patches.reversedArcs.resize(faces);
  patches.polygonBegin.resize(faces + 1);
  patches.polygonBegin.back() = 0;
  return patches;
}

/// Cuts the faces owned by some tets.
void cutFaces(const PatchInput& input, std::size_t begin, std::size_t end, Patches& patches,
              PatchPieces& pieces) {
  pieces.clear();
  FaceCutter cutter(input, pieces);
  for (std::size_t t = begin; t < end; ++t) {
    const auto tet = static_cast<Index>(t);
    input.faces.forEach(tet, [&](const Element& face) {
      patches.polygonBegin[face.number] = cutter.cut(tet, face);
      const FaceBorder& border = cutter.border();
      patches.vertices[face.number] = border.vertices();
      patches.arcs[face.number] = border.arcs();
      patches.reversedArcs[face.number] = border.reversed();
    });
  }
}

}  // namespace

Patches cutPatches(const PatchInput& input, Stage& stage) {
  const std::uint64_t firstInnerPoint = input.firstInnerPoint();
  requireIndexable(firstInnerPoint);
  Patches patches = ofFaces(input.faces.count());
  lengthenAll(patches, {}, 1);
  const std::size_t tets = input.map.topology.tetCount();
  PiecePlaces totals;
  parallelBatches<PatchPieces>(
      stage, tets, tetsPerBlock(input.faces.count(), tets),
      [&](std::size_t begin, std::size_t end, PatchPieces& pieces) {
        cutFaces(input, begin, end, patches, pieces);
      },
      [&](const PatchPieces& pieces, std::size_t end) {
        const PiecePlaces places = totals;
        totals.polygon += pieces.carriers.size();
        totals.corner += pieces.corners.size();
        totals.point += pieces.points.size();
        requireIndexable(firstInnerPoint + totals.point);
        lengthenAll(
            patches, totals,
            static_cast<double>(input.faces.begin(end)) / static_cast<double>(input.faces.count()));
        return places;
      },
      [&](const PatchPieces& pieces, const PiecePlaces& places, std::size_t /*begin*/) {
        join(pieces, places, firstInnerPoint, patches);
      });
  exclusiveScan(std::span(patches.polygonBegin));
  return patches;
}

}  // namespace hexhex::curved
