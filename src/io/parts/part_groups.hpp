// The groups of a part's elements: the same in all parts, some of them empty.
#pragma once

#include <hexhex/parts.hpp>

#include <base/stage.hpp>
#include <io/core/mesh_groups.hpp>

namespace hexhex::io {

/// Boundary quads are those of the whole mesh; quads between parts are in groups if they are
/// tagged. Groups of boundary quads are "surface_TAG" and "boundary", as in a whole mesh with a
/// patch angle of 0. Cells are own cells.
[[nodiscard]] MeshGroups groupPart(const MeshPart& part, const PartsInfo& info, Stage& stage);

}  // namespace hexhex::io
