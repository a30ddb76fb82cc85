// Tags of the tet mesh, carried over to the mesh that was extracted from it.
//
// An edge of a cell, and a face beside an edge, are looked at where they begin: the half diagonal
// from the cell's centre to the corner ends in a tet that holds that beginning (CellTracer), and
// there the signs of face normals decide exactly into which simplex it leads (holder and casing,
// Section 4.2). Only the cells with a corner at a tagged simplex are looked at.
#pragma once

#include <cstdint>
#include <functional>

#include <hexhex/types.hpp>

#include <igm/prepare.hpp>

namespace hexhex::extraction {

/// Refuses features and regions that make no sense, before work begins.
/// @throws Error InvalidArgument as extract()
void requireValidTags(const TetMapView& map);

/// Fills mesh.features and mesh.regions as extract() promises; does nothing without tags.
/// @param given     the caller's map, with tags that have passed requireValidTags()
/// @param prepared  scaled, as `mesh` was extracted from it
void carryTags(const TetMapView& given, const igm::PreparedMap& prepared, HexMesh& mesh,
               Context& context);

/// Cells that are looked at for tags, by groups that different threads may take.
struct TaggedCells {
  /// Of (number in the mesh, owner, smallest corner, simplex of the owner with the centre).
  using Visit =
      std::function<void(std::uint64_t, Index, const lattice::GridPoint&, lattice::CornerMask)>;
  std::size_t groups = 0;
  std::function<void(std::size_t group, const Visit&)> forEach;
};

/// Fills mesh.features from some cells of a mesh. Vertices may have any numbers in the order of
/// those of extract().
void carryFeatures(const TetMapView& given, const igm::PreparedMap& prepared,
                   const TaggedCells& cells, HexMesh& mesh, Stage& stage);

}  // namespace hexhex::extraction
