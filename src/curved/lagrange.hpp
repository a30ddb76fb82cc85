// Cells of higher order: groups of the vertices of a refined grid.
#pragma once

#include <cstdint>

#include <hexhex/curved.hpp>

#include <igm/prepare.hpp>
#include <lattice/tet_geometry.hpp>
#include <sweep/cell_centers.hpp>

namespace hexhex::curved {

/// @param mesh  of the map as it is scaled now; its vertices become the first nodes
/// @param map   receives the scale of the nodes, `order` times what it had
[[nodiscard]] LagrangeMesh groupNodes(const HexMesh& mesh, igm::PreparedMap& map, int order,
                                      Context& context);

/// Place of a cell's corner among its nodes.
[[nodiscard]] inline std::size_t nodeOfCorner(std::size_t corner, int order) {
  const auto last = static_cast<std::size_t>(order);
  const std::size_t stride = last + 1;
  const lattice::GridPoint& offset = lattice::kCellCorners[corner];
  const std::size_t x = static_cast<std::size_t>(offset[0]) * last;
  const std::size_t y = static_cast<std::size_t>(offset[1]) * last;
  const std::size_t z = static_cast<std::size_t>(offset[2]) * last;
  return x + stride * (y + stride * z);
}

/// Whether a closed triangle that is not degenerate has a point in the open cube from 0 to `unit`
/// along all axes. By separating axes: the open cube and the triangle are disjoint exactly if a
/// plane parallel to a side of the cube, to the triangle, or to an edge of each is between them.
[[nodiscard]] bool cubeMeetsFace(const lattice::LatticeTet& corners, int face,
                                 std::int64_t unit) noexcept;

}  // namespace hexhex::curved
