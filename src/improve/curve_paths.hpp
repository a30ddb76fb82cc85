// Paths of edges of a mesh's boundary along the curves of a surface, whose edges lie elsewhere.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <adjacency/vertex_lists.hpp>

#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <improve/reference_surface.hpp>

namespace hexhex::improvement {

/// A place on a segment of the surface, or at a point of it if both ends are the same.
struct PlaceOnCurve {
  std::array<Index, 2> segment;  ///< points of the surface
  Vec3 point;
};

/// A piece of a curve between corners, or a third of a closed one, and its edges of the mesh.
struct CurvePath {
  std::vector<std::array<Index, 2>> segments;
  std::vector<Index> vertices;       ///< of the mesh, from end to end
  std::vector<PlaceOnCurve> places;  ///< of these
};

struct CurvePaths {
  std::vector<CurvePath> paths;
  std::size_t missing = 0;  ///< pieces that have none
};

/// Shortest paths, where what is far from its curve is long. Two paths share corners only.
/// @param quads  of the boundary of the mesh
[[nodiscard]] CurvePaths pathsAlongCurves(const Array<Vec3>& points, std::span<const Quad> quads,
                                          const ReferenceSurface& surface, Stage& stage);

}  // namespace hexhex::improvement
