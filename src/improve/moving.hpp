// One mesh, its boundary and where its vertices may be: all that it takes to improve it once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <hexhex/curved.hpp>
#include <hexhex/improve.hpp>

#include <base/stage.hpp>
#include <improve/surface_distance.hpp>
#include <improve/vertex_places.hpp>

namespace hexhex::improvement {

/// What is improved: a mesh whose points move, and the curved cells between these, if there are
/// any.
struct Subject {
  HexMesh& mesh;
  LagrangeMesh* curved = nullptr;

  /// Cells of the mesh for each that counts.
  [[nodiscard]] std::size_t parts() const;
  [[nodiscard]] Certificate certifyNow(Context& context) const;
  void putBack(const Array<Vec3>& points) const;
};

/// The boundary of a mesh, and the surface that it must be near.
struct Boundary {
  std::vector<std::uint64_t> faces;  ///< as of boundaryPlaces()
  Array<Quad> quads;
  TriangleTree surface{{}};

  Boundary() = default;
  Boundary(const HexMesh& mesh, TriangleTree surface, Stage& stage);

  [[nodiscard]] BoundaryDistance distanceTo(const VertexPlaces& places, const Array<Vec3>& points,
                                            double diagonal, Stage& stage) const;
  /// @param parts  cells of the mesh for each that counts
  [[nodiscard]] Array<std::uint64_t> cellsBeyond(double limit, const BoundaryDistance& distance,
                                                 std::size_t parts) const;
};

/// So far may the boundary be in the end, in diagonals.
[[nodiscard]] double farthestAllowed(const SurfaceDistance& before);

/// Cells that are not certified positive.
[[nodiscard]] inline std::uint64_t notPositive(const Certificate& certificate) noexcept {
  return certificate.refuted + certificate.undecided;
}

/// How good a mesh is in the end: less than 0 if cells are not positive, 1 if nothing is to be
/// better. A product, so that nothing pays for another.
[[nodiscard]] double meritOf(const ImproveReport& report);

/// Moves points and certifies. What did not become better in spite of all is put back.
/// @param before          where points were, in the beginning
/// @param[in,out] report  knows `before`, `diagonal` and `distanceBefore`; `after` and `offCreases`
///                        are entered
/// @return how far the boundary is in the end
[[nodiscard]] BoundaryDistance movePoints(const Subject& subject, const Boundary& boundary,
                                          VertexPlaces& places, const ImproveOptions& options,
                                          const Array<Vec3>& before, ImproveReport& report,
                                          Context& context, Stage& stage);

}  // namespace hexhex::improvement
