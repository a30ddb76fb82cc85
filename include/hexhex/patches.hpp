// Names for unnamed boundaries: the smooth patches between sharp edges.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <hexhex/context.hpp>
#include <hexhex/export.h>
#include <hexhex/features.hpp>
#include <hexhex/types.hpp>

namespace hexhex HEXHEX_API_NAMESPACE {

/// Returns the boundary quads of a mesh, facing outwards and tagged by patch. Two neighbours belong
/// to the same patch unless the boundary turns by more than `angle` degrees at their edge, in
/// either direction, or the edge is tagged in mesh.features or shared by more than two boundary
/// quads. The angle is measured between normals, which are computed from the diagonals of the
/// quads; a quad with zero area is a patch of its own.
///
/// Patches are numbered from 1 in order of their first quads; quads are ordered by (cell, face of
/// the cell).
/// @param angle  from 0, where every turn separates patches, to 180, where none does
/// @throws Error InvalidArgument for an angle out of range, or a cell with a vertex that does not
///         exist
[[nodiscard]] std::vector<FeatureQuad> boundaryPatches(const HexMesh& mesh, double angle,
                                                       Context& context);

/// A part of the boundary with its name in formats with groups.
struct NamedPatch {
  /// "inlet", if the file with the tags has a name for them; "surface_7" for tag 7; "patch_1" for a
  /// smooth patch; "boundary" for other untagged quads.
  std::string name;
  std::int32_t tag = 0;     ///< tag of its quads in mesh.features; 0: none
  std::vector<Quad> quads;  ///< facing outwards
  double area = 0;          ///< mean over both ways of splitting the quads into triangles
  Vec3 centre{};            ///< centroid of the area
  /// Area-weighted mean of the outward unit normals: its length is 1 for a flat patch and 0 for a
  /// closed one.
  Vec3 normal{};
};

/// Returns the groups of boundary quads that are written to files: one per tag or, if no quad is
/// tagged, the smooth patches of boundaryPatches(), provided there are at least two. Sorted by tag
/// or number.
/// @param angle  as for boundaryPatches(), except that 0 means a single group without patches
/// @throws Error  as boundaryPatches()
[[nodiscard]] std::vector<NamedPatch> namedPatches(const HexMesh& mesh, double angle,
                                                   Context& context);

}  // namespace HEXHEX_API_NAMESPACE
