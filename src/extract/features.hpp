// Tags of the tet mesh, carried over to the mesh that was extracted from it.
//
// An edge of a cell, and a face beside an edge, are looked at where they begin: the half diagonal
// from the cell's centre to the corner ends in a tet that holds that beginning (CellTracer), and
// there the signs of face normals decide exactly into which simplex it leads (holder and casing,
// Section 4.2). Only the cells with a corner at a tagged simplex are looked at.
#pragma once

#include <hexhex/types.hpp>

#include <igm/prepare.hpp>

namespace hexhex {

/// Refuses features and regions that make no sense, before work begins.
/// @throws Error InvalidArgument as extract()
void requireValidTags(const TetMapView& map);

/// Fills mesh.features and mesh.regions as extract() promises; does nothing without tags.
/// @param given     the caller's map, with tags that have passed requireValidTags()
/// @param prepared  scaled, as `mesh` was extracted from it
void carryTags(const TetMapView& given, const PreparedMap& prepared, HexMesh& mesh,
               Context& context);

}  // namespace hexhex
