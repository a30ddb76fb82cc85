// What a page takes of cells of higher order: the nodes on their faces.
#pragma once

#include <cstddef>

#include <hexhex/curved.hpp>
#include <hexhex/types.hpp>

namespace hexhex {

/// Nodes on the faces of cells, without those at corners. Their numbers follow those of the hex
/// vertices, in the order in which cells name them first.
struct SurfaceNodes {
  int order = 1;
  Array<Vec3> points;
  std::size_t perCell = 0;  ///< (p + 1)^3 - (p - 1)^3 - 8
  /// `perCell` numbers per cell: the nodes (i, j, k) of LagrangeMesh with an index that is 0 or p,
  /// but not all three, in the order there. As in viewer/src/curves.ts.
  Array<Index> numbers;
};

/// @throws Error InvalidArgument if arrays of the mesh disagree, or a cell names a node that does
///         not exist or has a corner that is no hex vertex
[[nodiscard]] SurfaceNodes surfaceNodesOf(const LagrangeMesh& mesh);

}  // namespace hexhex
