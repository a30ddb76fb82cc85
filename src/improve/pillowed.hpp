// An improved mesh with a layer of cells under its boundary, where that makes it better.
#pragma once

#include <optional>

#include <hexhex/improve.hpp>

#include <base/stage.hpp>
#include <improve/moving.hpp>

namespace hexhex::improvement {

/// A mesh that was improved once, and how it ended.
struct Improved {
  HexMesh mesh;
  Boundary boundary;
  VertexPlaces places;
  BoundaryDistance distance;
  ImproveReport report;  ///< `after` and what counts vertices
};

/// Moves the points of a mesh that has more cells than one which was improved already, and
/// certifies. The report keeps the `before` of the latter.
/// @param without  that mesh, whose cells and points come first
void moveEnlarged(Improved& improved, const HexMesh& without, const ImproveOptions& options,
                  Context& context, Stage& stage);

/// Improves a copy with a pillow.
/// @param boundary, places, distance, report  of the mesh, which was improved already
/// @return nothing if no pillow is wanted or, with PillowMode::Auto, helps
/// @throws Error  with PillowMode::Always, if there cannot be one
[[nodiscard]] std::optional<Improved> improvedWithPillow(
    const HexMesh& mesh, const Boundary& boundary, const VertexPlaces& places,
    const BoundaryDistance& distance, const ImproveOptions& options, const ImproveReport& report,
    Context& context, Stage& stage);

}  // namespace hexhex::improvement
