// Names for a boundary that has none: the smooth patches between sharp edges.
#pragma once

#include <cstdint>
#include <string>
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

/// A part of the boundary with the name that formats with groups give it.
struct NamedPatch {
  /// "inlet", if the file that the tags come from has a name for them; "surface_7" for a tag 7;
  /// "patch_1" for a smooth patch; "boundary" for other quads without a tag.
  std::string name;
  std::int32_t tag = 0;     ///< that its quads have in mesh.features; 0: none
  std::vector<Quad> quads;  ///< facing outwards
  double area = 0;          ///< mean of both ways to split quads into triangles
  Vec3 centre{};            ///< of the area
  /// Mean of the unit normals by area, outwards: its length is 1 for a flat patch, and 0 for a
  /// closed one.
  Vec3 normal{};
};

/// The groups of boundary quads that files get: by tag; or, if none is tagged, the smooth patches
/// of boundaryPatches(), unless there is but one. In order of their tags or numbers.
/// @param angle  as of boundaryPatches(), but 0: no patches, one group
/// @throws Error  as boundaryPatches()
[[nodiscard]] std::vector<NamedPatch> namedPatches(const HexMesh& mesh, double angle,
                                                   Context& context);

}  // namespace HEXHEX_API_NAMESPACE
