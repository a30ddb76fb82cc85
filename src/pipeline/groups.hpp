// Tags of a part, as groups of its mesh. Tags inside of the part, and of edges that are lines of
// the map, are the extraction's; tags of the surface are found where it is in the end, as vertices
// have moved along it.
#pragma once

#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex::pipeline {

/// The tags that vertices are to stay on: those of edges and inner triangles in planes of the grid.
/// Others have no edges or quads, and borders on a smooth surface would only be in the way.
[[nodiscard]] Features heldTags(const TetMap& map, Stage& stage);

/// Gives boundary quads the tags of the triangles that are nearest to their centres, and so quads
/// between two regions that have none those of triangles between these; edges of the
/// mesh beside tagged curves that are not lines of the map the tags of these; and vertices nearest
/// to tagged ones theirs.
/// @param held  as of heldTags()
/// @return pieces of tagged curves that have no edges
[[nodiscard]] std::uint64_t tagBoundary(const TetMap& map, const Features& held, HexMesh& mesh,
                                        Stage& stage);

}  // namespace hexhex::pipeline
