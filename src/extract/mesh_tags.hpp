// Carries tags of the tet mesh over to the mesh extracted from it.
//
// An edge of a cell, and a face beside an edge, are examined where they begin: the half diagonal
// from the cell's centre to the corner ends in a tet that contains that beginning (CellTracer), and
// there the signs of face normals decide exactly which simplex it leads into (holder and casing,
// Sections 5.3.2 and 5.3.3). Only cells with a corner at a tagged simplex are examined.
#pragma once

#include <cstdint>
#include <functional>

#include <hexhex/types.hpp>

#include <igm/igm.hpp>

namespace hexhex::extraction {

/// Rejects invalid features and regions before work begins.
/// @throws Error InvalidArgument as extract()
void requireValidTags(const TetMapView& map);

/// Fills mesh.features and mesh.regions as extract() promises; does nothing without tags.
/// @param given     the caller's map, with tags that have passed requireValidTags()
/// @param prepared  scaled, as `mesh` was extracted from it
void carryTags(const TetMapView& given, const igm::PreparedMap& prepared, HexMesh& mesh,
               Context& context);

/// Cells to be examined for tags, in groups that different threads may take.
struct TaggedCells {
  /// Called with (number in the mesh, owner, smallest corner, simplex of the owner with the
  /// centre).
  using Visit =
      std::function<void(std::uint64_t, Index, const lattice::GridPoint&, lattice::CornerMask)>;
  std::size_t groups = 0;
  std::function<void(std::size_t group, const Visit&)> forEach;
};

/// Fills mesh.features from some cells of a mesh. Vertices may have any numbers, as long as they
/// are in the order of those of extract().
void carryFeatures(const TetMapView& given, const igm::PreparedMap& prepared,
                   const TaggedCells& cells, HexMesh& mesh, Stage& stage);

}  // namespace hexhex::extraction
