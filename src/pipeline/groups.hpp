// Transfers the tags of a part to its mesh. Extraction provides tags inside the part, and those of
// edges on grid lines of the map. Tags of the surface are assigned after improvement, since
// vertices move along the surface.
#pragma once

#include <vector>

#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex::pipeline {

/// The tags that improvement must preserve: those of vertices, of edges on grid lines, and of inner
/// triangles. Other edges have no edges of the mesh, and borders on a smooth surface would only be
/// in the way.
[[nodiscard]] Features heldTags(const TetMap& map, Stage& stage);

/// Tags boundary quads like the triangles nearest to their centres; untagged quads between two
/// regions like the nearest triangle between these; edges of the mesh along tagged curves that are
/// not on grid lines like the curve; and the vertices nearest to tagged ones like these.
/// @param held  from heldTags()
/// @return number of pieces of tagged curves without edges of the mesh
[[nodiscard]] std::uint64_t tagBoundary(const TetMap& map, const Features& held, HexMesh& mesh,
                                        Stage& stage);

/// Regions of the map without cells, and tags of its triangles without quads, with their names.
[[nodiscard]] std::vector<TagName> missingGroups(const TetMap& map, const HexMesh& mesh);

}  // namespace hexhex::pipeline
