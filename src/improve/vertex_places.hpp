// How each vertex of a mesh may move: freely, on a patch of the surface, on a curve, or not at all.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <improve/reference_surface.hpp>

namespace hexhex::improvement {

inline constexpr std::array<Vec3, 3> kAxes = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};

struct VertexPlaces {
  ReferenceSurface surface;
  Array<Freedom> freedom;  ///< per vertex
  /// Per vertex: the triangle or segment that holds it, the corner, or kNone.
  Array<Index> simplex;
  std::vector<bool> isLoose;     ///< per vertex on a patch: whether it may leave it across creases
  std::vector<Quad> innerQuads;  ///< of the mesh, on inner triangles of the surface
  std::uint64_t tagged = 0;      ///< vertices that are Fixed because they have a tag

  /// Whether the surface was given separately: the boundary may be off it, and is pulled onto it.
  bool isGiven = false;
  /// Whether the surface is the initial boundary of the mesh, with the folds of bad cells.
  bool isOwn = false;

  /// Whether all of the vertices are fixed.
  [[nodiscard]] bool areHeld(std::span<const Index> vertices) const {
    return std::all_of(vertices.begin(), vertices.end(),
                       [this](Index v) { return freedom[v] == Freedom::Fixed; });
  }

  /// The nearest place to a point among those to which a vertex may move.
  [[nodiscard]] SurfacePlace nearest(Index vertex, const Vec3& point, double enough = 0) const {
    if (freedom[vertex] == Freedom::OnPatch) {
      return isLoose[vertex] ? surface.acrossCreases(point, simplex[vertex], enough)
                             : surface.onPatch(point, simplex[vertex], enough);
    }
    if (freedom[vertex] == Freedom::OnCurve) return surface.onCurve(point, simplex[vertex]);
    return {point, simplex[vertex]};
  }

  /// Like nearest(), but the corner of the surface for a vertex that belongs to one, even if the
  /// vertex is not there yet.
  [[nodiscard]] SurfacePlace home(Index vertex, const Vec3& point) const {
    const bool isCorner = freedom[vertex] == Freedom::Fixed && simplex[vertex] != kNone;
    return isCorner ? SurfacePlace{surface.points()[simplex[vertex]], simplex[vertex]}
                    : nearest(vertex, point);
  }

  /// Orthonormal directions in which a vertex may move: all axes, two in the plane of its triangle,
  /// that of its segment, or none.
  /// @return their number
  std::size_t directionsAt(Index vertex, std::array<Vec3, 3>& directions) const;
};

/// Places on the surface of the map: its boundary, tagged triangles, and those between regions. The
/// generator of a vertex determines its place.
/// @param mesh  with generators in the map
/// @param angle  SurfaceParts::angle
/// @throws Error InvalidArgument for generators that are not in the map, and for a map whose tets
///         do not form a manifold
[[nodiscard]] VertexPlaces placesOnMap(const HexMesh& mesh, const TetMapView& map, double angle,
                                       Stage& stage);

/// Places on the mesh's own boundary and tagged quads, two triangles each.
/// @param isAtBad  per vertex: 1 if a cell there is not positive; as for creaseChains()
/// @throws Error InvalidArgument for features that are not in the mesh
[[nodiscard]] VertexPlaces placesOnMesh(const HexMesh& mesh, std::span<const std::uint8_t> isAtBad,
                                        double angle, Stage& stage);

}  // namespace hexhex::improvement
