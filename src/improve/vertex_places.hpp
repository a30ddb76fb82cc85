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
  /// Per vertex on a patch: 1 if it may leave it across creases.
  std::vector<std::uint8_t> isLoose;
  std::vector<Quad> innerQuads;  ///< of the mesh, on triangles of the surface that are inside
  std::uint64_t tagged = 0;      ///< vertices that are Fixed because they have a tag

  /// Whether a mesh was given a surface that its boundary may be off, and is to be pulled onto.
  bool isGiven = false;

  /// Whether none of some vertices can move.
  [[nodiscard]] bool areHeld(std::span<const Index> vertices) const {
    return std::all_of(vertices.begin(), vertices.end(),
                       [this](Index v) { return freedom[v] == Freedom::Fixed; });
  }

  /// The place nearest to a point that a vertex may move to.
  [[nodiscard]] SurfacePlace nearest(Index vertex, const Vec3& point, double enough = 0) const {
    if (freedom[vertex] == Freedom::OnPatch) {
      return isLoose[vertex] != 0 ? surface.acrossCreases(point, simplex[vertex], enough)
                                  : surface.onPatch(point, simplex[vertex], enough);
    }
    if (freedom[vertex] == Freedom::OnCurve) return surface.onCurve(point, simplex[vertex]);
    return {point, simplex[vertex]};
  }

  /// The same, or the corner of the surface that a vertex belongs to, though it may not be there.
  [[nodiscard]] SurfacePlace home(Index vertex, const Vec3& point) const {
    const bool isCorner = freedom[vertex] == Freedom::Fixed && simplex[vertex] != kNone;
    return isCorner ? SurfacePlace{surface.points()[simplex[vertex]], simplex[vertex]}
                    : nearest(vertex, point);
  }

  /// Orthonormal directions in which a vertex may move: all axes, those of its triangle, that of
  /// its segment, or none.
  /// @return how many
  std::size_t directionsAt(Index vertex, std::array<Vec3, 3>& directions) const;
};

/// The surface is that of the map: its boundary, tagged triangles, and those between regions. A
/// vertex is where its generator is.
/// @param mesh  with generators in the map
/// @param angle  as of SurfaceParts
/// @throws Error InvalidArgument for generators that are not in the map, and for a map whose tets
///         do not form a manifold
[[nodiscard]] VertexPlaces placesOnMap(const HexMesh& mesh, const TetMapView& map, double angle,
                                       Stage& stage);

/// The surface is the mesh's own boundary with its tagged quads, two triangles each.
/// @param isAtBad  per vertex: 1 if a cell there is not positive; as of creaseChains()
/// @throws Error InvalidArgument for features that are not in the mesh
[[nodiscard]] VertexPlaces placesOnMesh(const HexMesh& mesh, std::span<const std::uint8_t> isAtBad,
                                        double angle, Stage& stage);

}  // namespace hexhex::improvement
