// Finds paths of edges on the boundary of a mesh along curves of a surface that its edges do not
// follow.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <adjacency/vertex_lists.hpp>

#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <improve/reference_surface.hpp>

namespace hexhex::improvement {

/// A place on a segment of the surface, or at a point of it if both ends are equal.
struct PlaceOnCurve {
  std::array<Index, 2> segment;  ///< points of the surface
  Vec3 point;
};

/// A piece of a curve between corners, or a third of a closed one, and the path along it.
struct CurvePath {
  std::vector<std::array<Index, 2>> segments;
  std::vector<Index> vertices;       ///< of the mesh, from end to end
  std::vector<PlaceOnCurve> places;  ///< of these
};

struct CurvePaths {
  std::vector<CurvePath> paths;
  std::size_t missing = 0;  ///< number of pieces without a path
};

/// Shortest paths, whose edges cost more the farther they are from the curve. Two paths share
/// corners only.
/// @param quads  of the boundary of the mesh
[[nodiscard]] CurvePaths pathsAlongCurves(const Array<Vec3>& points, std::span<const Quad> quads,
                                          const ReferenceSurface& surface, Stage& stage);

}  // namespace hexhex::improvement
