// The nodes of Lagrange hexahedra in the order of formats, and those of edges and quads that
// formats list beside the cells.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <hexhex/curved.hpp>

#include <base/stage.hpp>
#include <io/core/mesh_groups.hpp>

namespace hexhex {

/// Entry i: the place in LagrangeMesh's order, i + (p + 1) (j + (p + 1) k), of the node that the
/// format lists at place i.
[[nodiscard]] std::vector<std::uint32_t> vtkNodeOrder(int order);
[[nodiscard]] std::vector<std::uint32_t> gmshNodeOrder(int order);

/// The nodes of tagged edges, order + 1 each, in Gmsh's order.
/// @param straight  what straightMesh() returns
/// @throws Error InvalidArgument for an edge that is none of a cell
[[nodiscard]] Array<Index> gmshEdgeNodes(const LagrangeMesh& mesh, const HexMesh& straight,
                                         const EdgeGroups& edges, Stage& stage);

/// The nodes of quads, (order + 1)^2 each, in Gmsh's order; those of the boundary run
/// counter-clockwise seen from outside, those inside the mesh so seen from outside of the first
/// cell that they belong to.
/// @throws Error InvalidArgument for a quad that is no face of a cell
[[nodiscard]] Array<Index> gmshQuadNodes(const LagrangeMesh& mesh, const HexMesh& straight,
                                         const QuadGroups& quads, Stage& stage);

}  // namespace hexhex
