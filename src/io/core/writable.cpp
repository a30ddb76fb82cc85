#include <algorithm>
#include <cmath>
#include <string>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <io/core/writable.hpp>

namespace hexhex {
namespace {

bool isFinite(const Vec3& v) {
  return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

}  // namespace

void requireWritable(const TetMap& map, Stage& stage) {
  const auto requireSize = [&map](std::size_t size, const char* what) {
    if (size == map.tets.size()) return;
    throw Error(ErrorCode::InvalidArgument, "The map has " + std::to_string(map.tets.size()) +
                                                " tets but " + what + " for " +
                                                std::to_string(size) + ".");
  };
  requireSize(map.parameters.size(), "parameters");
  if (!map.rotations.empty()) requireSize(map.rotations.size(), "rotations");
  if (!map.regions.empty()) requireSize(map.regions.size(), "regions");
  const std::size_t point = firstNotFinite(map.points, stage);
  if (point < map.points.size()) {
    throw Error(ErrorCode::NotFinite,
                "A coordinate of vertex " + std::to_string(point) + " is not finite.",
                Place{PlaceKind::Vertex, point});
  }
  const auto inRange = [&map](Index v) { return v < map.points.size(); };
  const std::size_t tet = firstFault(stage, map.tets.size(), [&](std::size_t t) {
    return std::all_of(map.tets[t].begin(), map.tets[t].end(), inRange) &&
           std::all_of(map.parameters[t].begin(), map.parameters[t].end(), isFinite);
  });
  if (tet == map.tets.size()) return;
  const bool range = std::all_of(map.tets[tet].begin(), map.tets[tet].end(), inRange);
  throw Error(range ? ErrorCode::NotFinite : ErrorCode::IndexOutOfRange,
              range ? "A parameter of tet " + std::to_string(tet) + " is not finite."
                    : "Tet " + std::to_string(tet) + " names a vertex that does not exist.",
              Place{PlaceKind::Tet, tet});
}

std::size_t firstNotFinite(std::span<const Vec3> points, Stage& stage) {
  constexpr std::size_t kGrain = std::size_t{1} << 14;  // a fraction of a millisecond's work
  return firstFault(
      stage, points.size(), [&](std::size_t i) { return isFinite(points[i]); }, kGrain);
}

}  // namespace hexhex
