// Adds a layer of cells under the boundary of a mesh (a pillow) where that makes it better.
#pragma once

#include <optional>

#include <hexhex/improve.hpp>

#include <base/stage.hpp>
#include <improve/moving.hpp>

namespace hexhex::improvement {

/// An improved mesh, and its report.
struct Improved {
  HexMesh mesh;
  Boundary boundary;
  VertexPlaces places;
  BoundaryDistance distance;
  ImproveReport report;  ///< as far as movePoints() and moveEnlarged() write it
};

/// Moves the points of an improved mesh to which cells were added, and certifies it. The report
/// keeps the `before` of the mesh without these cells.
/// @param without  the mesh without added cells; its cells and points come first
void moveEnlarged(Improved& improved, const HexMesh& without, const ImproveOptions& options,
                  Context& context, Stage& stage);

/// Whether PillowMode::Auto keeps a pillow: if the mesh is better overall or, at no greater
/// distance from the surface, in its cells.
/// @param pillowed, without  complete reports
[[nodiscard]] bool isWorthLayer(const ImproveReport& pillowed, const ImproveReport& without);

/// Improves a copy with a pillow.
/// @param boundary, places, report  of the mesh, which is already improved
/// @return nothing if no pillow is requested or, with PillowMode::Auto, if none can help
/// @throws Error  with PillowMode::Always, if no pillow is possible
[[nodiscard]] std::optional<Improved> improvedWithPillow(
    const HexMesh& mesh, const Boundary& boundary, const VertexPlaces& places,
    const ImproveOptions& options, const ImproveReport& report, Context& context, Stage& stage);

}  // namespace hexhex::improvement
