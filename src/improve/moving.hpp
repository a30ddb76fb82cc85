// Improves a mesh once, given its boundary and the places of its vertices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <hexhex/improve.hpp>

#include <base/stage.hpp>
#include <improve/neighbourhoods.hpp>
#include <improve/subject.hpp>
#include <improve/surface_distance.hpp>
#include <improve/vertex_places.hpp>

namespace hexhex::improvement {

/// The boundary of a mesh, and the surface that it must stay near.
struct Boundary {
  std::vector<std::uint64_t> faces;  ///< from boundaryPlaces()
  Array<Quad> quads;
  TriangleTree surface{{}};

  Boundary() = default;
  Boundary(const HexMesh& mesh, TriangleTree surface, Stage& stage);

  [[nodiscard]] BoundaryDistance distanceTo(const VertexPlaces& places, const Array<Vec3>& points,
                                            double diagonal, Stage& stage,
                                            const Accuracy& accuracy = {}) const;
  /// @param parts  Subject::parts()
  [[nodiscard]] Array<std::uint64_t> cellsBeyond(double limit, const BoundaryDistance& distance,
                                                 std::size_t parts) const;
};

/// Maximum distance of the improved boundary from the surface, in diagonals.
[[nodiscard]] double farthestAllowed(const SurfaceDistance& before);

/// Cells that are not certified positive.
[[nodiscard]] inline std::uint64_t notPositive(const Certificate& certificate) noexcept {
  return certificate.refuted + certificate.undecided;
}

/// Moves points and certifies the result. Restores the points around cells that became worse.
/// @param[in,out] before  the initial positions; simplices change where vertices left creases
/// @param[in,out] report  with `before`, `diagonal` and `distanceBefore`; gets `after` and
///         `offCreases`
/// @return the final distance of the boundary from the surface
[[nodiscard]] BoundaryDistance movePoints(const Subject& subject, const Boundary& boundary,
                                          VertexPlaces& places, const ImproveOptions& options,
                                          Positions& before, ImproveReport& report,
                                          Context& context, Stage& stage);

/// Whether a mesh is so far from the surface that closeGaps() may help.
[[nodiscard]] bool isOtherShape(const BoundaryDistance& distance);

/// Moves vertices off the surface where a straight mesh would otherwise be a different shape, and
/// certifies the result.
/// @param distance        as of movePoints(), for the present points
/// @param[in,out] report  as movePoints() leaves it; gets `after`
/// @return the new distance; nothing if no vertex was moved
[[nodiscard]] std::optional<BoundaryDistance> closeGaps(
    const Subject& subject, const Boundary& boundary, VertexPlaces& places,
    const BoundaryDistance& distance, const ImproveOptions& options, ImproveReport& report,
    Context& context, Stage& stage);

}  // namespace hexhex::improvement
