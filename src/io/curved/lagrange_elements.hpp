// The edges and quads of Lagrange cells that formats list beside the cells: where their nodes are.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <hexhex/curved.hpp>

#include <base/stage.hpp>
#include <io/core/mesh_groups.hpp>

namespace hexhex {

/// The nodes of tagged edges, order + 1 each.
/// @param straight   what straightMesh() returns
/// @param nodeOrder  entry k: which of the nodes, from 0 at an end to p at the other, comes k-th
/// @throws Error InvalidArgument for an edge that is none of a cell
[[nodiscard]] Array<Index> edgeNodes(const LagrangeMesh& mesh, const HexMesh& straight,
                                     const EdgeGroups& edges,
                                     std::span<const std::uint32_t> nodeOrder, Stage& stage);

/// The nodes of quads, (order + 1)^2 each; those of the boundary run counter-clockwise seen from
/// outside, those inside the mesh so seen from outside of the first cell that they belong to.
/// @param nodeOrder  entry k: the place i + (p + 1) j of the node that comes k-th
/// @throws Error InvalidArgument for a quad that is no face of a cell
[[nodiscard]] Array<Index> quadNodes(const LagrangeMesh& mesh, const HexMesh& straight,
                                     const QuadGroups& quads,
                                     std::span<const std::uint32_t> nodeOrder, Stage& stage);

}  // namespace hexhex
