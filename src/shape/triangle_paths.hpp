// Shortest paths from triangle to triangle.
#pragma once

#include <span>
#include <vector>

#include <shape/surface.hpp>

namespace hexhex::shape {

/// Paths through centres of triangles, each from the nearest of some starts.
struct TrianglePaths {
  std::vector<double> distances;  ///< per triangle: the length, or the reach if there is no path
  std::vector<Side> entries;      ///< per triangle: its side towards the start, or kNone
};

/// @param reach      paths are shorter than this
/// @param isBlocked  per triangle: whether paths must not lead there; empty: none
[[nodiscard]] TrianglePaths shortestPaths(const Surface& surface, std::span<const Index> starts,
                                          double reach, const std::vector<bool>& isBlocked);

/// The distance between the centres of two triangles.
[[nodiscard]] inline double distanceBetween(const Surface& surface, Index a, Index b) {
  return length(minus(surface.centres[a], surface.centres[b]));
}

}  // namespace hexhex::shape
