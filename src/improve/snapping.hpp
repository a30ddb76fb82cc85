// Snaps edges of a mesh to curves of the surface that none of its edges follow.
//
// X. Gao, H. Shen, D. Panozzo, "Feature preserving octree-based hexahedral meshing", Computer
// Graphics Forum 38 (2019), do so for octree-based grids.
#pragma once

#include <optional>

#include <hexhex/improve.hpp>

#include <base/stage.hpp>
#include <improve/moving.hpp>
#include <improve/pillowed.hpp>

namespace hexhex::improvement {

/// Snaps edges of a copy to curves, along shortest paths on its boundary; adds a pillow, and layers
/// where a quad has two nearly collinear edges on curves; then improves it.
/// @param mesh, boundary, places, report  of the mesh, which is already improved
/// @return nothing if no curve can be followed this way
[[nodiscard]] std::optional<Improved> improvedWithCurves(
    const HexMesh& mesh, const Boundary& boundary, const VertexPlaces& places,
    const ImproveOptions& options, const ImproveReport& report, Context& context, Stage& stage);

}  // namespace hexhex::improvement
