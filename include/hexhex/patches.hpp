// Names for a boundary that has none: the smooth patches between sharp edges.
#pragma once

#include <vector>

#include <hexhex/context.hpp>
#include <hexhex/export.h>
#include <hexhex/features.hpp>
#include <hexhex/types.hpp>

namespace hexhex HEXHEX_API_NAMESPACE {

/// The boundary quads of a mesh, facing outwards, tagged by patch. Two neighbours are in the same
/// patch unless the boundary turns by more than `angle` degrees at their edge, in either direction,
/// or the edge is tagged in mesh.features, or is shared by more than two boundary quads. The angle
/// is that between normals, which are taken from a quad's diagonals; a quad without area is a patch
/// of its own.
///
/// Patches are numbered from 1 on, in order of their first quads; quads are in order of (cell, face
/// of the cell).
/// @param angle  from 0, where every turn separates, to 180, where none does
/// @throws Error InvalidArgument for another angle, or a cell with a vertex that does not exist
[[nodiscard]] std::vector<FeatureQuad> boundaryPatches(const HexMesh& mesh, double angle,
                                                       Context& context);

}  // namespace HEXHEX_API_NAMESPACE
