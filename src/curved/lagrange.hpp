// Higher-order cells: groups of vertices of a refined grid.
#pragma once

#include <cstdint>

#include <hexhex/curved.hpp>

#include <igm/igm.hpp>
#include <lattice/tet_geometry.hpp>
#include <sweep/cell_order.hpp>

namespace hexhex::curved {

/// @param mesh  of the map at its current scale; its vertices become the first nodes
/// @param map   is rescaled for the nodes, by `order`
[[nodiscard]] LagrangeMesh groupNodes(const HexMesh& mesh, igm::PreparedMap& map, int order,
                                      Context& context);

/// Index of a cell's corner among its nodes.
[[nodiscard]] inline std::size_t nodeOfCorner(std::size_t corner, int order) {
  const auto last = static_cast<std::size_t>(order);
  const std::size_t stride = last + 1;
  const lattice::GridPoint& offset = lattice::kCellCorners[corner];
  const std::size_t x = static_cast<std::size_t>(offset[0]) * last;
  const std::size_t y = static_cast<std::size_t>(offset[1]) * last;
  const std::size_t z = static_cast<std::size_t>(offset[2]) * last;
  return x + stride * (y + stride * z);
}

/// Whether a closed, nondegenerate triangle meets the open cube from 0 to `unit` along all axes. By
/// separating axes: the open cube and the triangle are disjoint if and only if they are separated
/// by a plane parallel to a side of the cube, to the triangle, or to an edge of each.
[[nodiscard]] bool cubeMeetsFace(const lattice::LatticeTet& corners, int face,
                                 std::int64_t unit) noexcept;

}  // namespace hexhex::curved
