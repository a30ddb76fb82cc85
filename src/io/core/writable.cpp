#include <algorithm>
#include <string>

#include <adjacency/hex_topology.hpp>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <io/core/writable.hpp>
#include <mesh/smooth_patches.hpp>

namespace hexhex {
namespace {

/// Refuses an optional array that is there but has another size than what it describes.
void requireSize(std::size_t size, std::size_t expected, const char* elements, const char* values) {
  if (size == 0 || size == expected) return;
  throw Error(ErrorCode::InvalidArgument, "The mesh has " + std::to_string(expected) + " " +
                                              elements + " but " + std::to_string(size) + " " +
                                              values + ".");
}

void requireFinite(std::span<const Vec3> points, Stage& stage) {
  const std::size_t vertex = firstNotFinite(points, stage);
  if (vertex == points.size()) return;
  throw Error(ErrorCode::NotFinite,
              "A coordinate of vertex " + std::to_string(vertex) + " is not finite.",
              Place{PlaceKind::Vertex, vertex});
}

}  // namespace

std::size_t firstNotFinite(std::span<const Vec3> points, Stage& stage) {
  constexpr std::size_t kGrain = std::size_t{1} << 14;  // a fraction of a millisecond's work
  return firstFault(
      stage, points.size(), [&](std::size_t i) { return isFinite(points[i]); }, kGrain);
}

void requireWritable(const TetMap& map, Stage& stage) {
  const auto requirePerTet = [&map](std::size_t size, const char* what) {
    if (size == map.tets.size()) return;
    throw Error(ErrorCode::InvalidArgument, "The map has " + std::to_string(map.tets.size()) +
                                                " tets but " + what + " for " +
                                                std::to_string(size) + ".");
  };
  requirePerTet(map.parameters.size(), "parameters");
  if (!map.rotations.empty()) requirePerTet(map.rotations.size(), "rotations");
  if (!map.regions.empty()) requirePerTet(map.regions.size(), "regions");
  requireFinite(map.points, stage);
  const auto isInRange = [&map](std::size_t t) {
    return *std::max_element(map.tets[t].begin(), map.tets[t].end()) < map.points.size();
  };
  const std::size_t tet = firstFault(stage, map.tets.size(), [&](std::size_t t) {
    return isInRange(t) && isFinite(map.parameters[t]);
  });
  if (tet == map.tets.size()) return;
  const bool range = isInRange(tet);
  throw Error(range ? ErrorCode::NotFinite : ErrorCode::IndexOutOfRange,
              range ? "A parameter of tet " + std::to_string(tet) + " is not finite."
                    : "Tet " + std::to_string(tet) + " names a vertex that does not exist.",
              Place{PlaceKind::Tet, tet});
}

void requireWritable(const HexMesh& mesh, const WriteOptions& options, Stage& stage) {
  requireCornersInRange(mesh, stage);
  requireSize(mesh.generatorCorners.size(), mesh.points.size(), "vertices", "generators");
  requireSize(mesh.generatorTet.size(), mesh.points.size(), "vertices", "generators");
  requireSize(mesh.regions.size(), mesh.cells.size(), "cells", "regions");
  requirePatchAngle(options.patchAngle);
  requireSize(options.scaledJacobians.size(), mesh.cells.size(), "cells", "scaled Jacobians");
  requireFinite(mesh.points, stage);
}

}  // namespace hexhex
