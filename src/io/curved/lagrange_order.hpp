// The order in which formats list the nodes of a Lagrange hexahedron.
#pragma once

#include <cstdint>
#include <vector>

namespace hexhex {

/// Entry i: the place in LagrangeMesh's order, i + (p + 1) (j + (p + 1) k), of the node that the
/// format lists at place i.
[[nodiscard]] std::vector<std::uint32_t> vtkNodeOrder(int order);
[[nodiscard]] std::vector<std::uint32_t> gmshNodeOrder(int order);

/// The same for Gmsh's edges, whose nodes are numbered 0 to p along them, and for its quads, whose
/// node i steps towards corner 1 and j towards corner 3 has the place i + (p + 1) j.
[[nodiscard]] std::vector<std::uint32_t> gmshEdgeOrder(int order);
[[nodiscard]] std::vector<std::uint32_t> gmshQuadOrder(int order);

}  // namespace hexhex
