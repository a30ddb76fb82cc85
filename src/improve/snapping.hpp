// A mesh whose edges are laid onto the curves of the surface that none of them followed.
#pragma once

#include <optional>

#include <hexhex/improve.hpp>

#include <base/stage.hpp>
#include <improve/moving.hpp>
#include <improve/pillowed.hpp>

namespace hexhex::improvement {

/// Lays edges of a copy onto curves, along shortest paths of its boundary (Gao et al. 2019,
/// "Feature preserving octree-based hexahedral meshing", do so for grids), adds a pillow, and
/// layers where a quad has two edges on a curve that hardly turns; then improves it.
/// @param mesh, boundary, places, report  of the mesh, which was improved already
/// @return nothing if no curve can be followed so
[[nodiscard]] std::optional<Improved> improvedWithCurves(
    const HexMesh& mesh, const Boundary& boundary, const VertexPlaces& places,
    const ImproveOptions& options, const ImproveReport& report, Context& context, Stage& stage);

}  // namespace hexhex::improvement
