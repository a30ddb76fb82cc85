// What is wrong with a tet mesh that is not a manifold.
#pragma once

#include <igm/tet_topology.hpp>

namespace hexhex {

/// Goes through all faces, edges and vertices and names those that keep the mesh from being an
/// oriented manifold with boundary. Slow and simple: for meshes of which faster checks have found
/// that something is wrong.
/// @param topology  needs `tets` and `pointCount`; receives `mate` and the stars
void collectTopologyDefects(TetTopology& topology, Stage& stage, DefectCollector& defects);

}  // namespace hexhex
