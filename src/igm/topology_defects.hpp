// What is wrong with a tet mesh that is not a manifold.
#pragma once

#include <adjacency/tet_topology.hpp>

#include <igm/defects.hpp>

namespace hexhex {

/// Builds adjacency through faces; defects are collected. After a defect the result must not be
/// used. Faces are checked here (non-manifold, inconsistent orientation); that edges and vertices
/// are manifold is for computeSingularities() to find out.
/// @param map  has passed checkInput()
[[nodiscard]] TetTopology buildTopology(const TetMapView& map, Stage& stage,
                                        DefectCollector& defects);

/// Goes through all faces, edges and vertices and names those that keep the mesh from being an
/// oriented manifold with boundary. Slow and simple: for meshes of which faster checks have found
/// that something is wrong.
/// @param topology  needs `tets` and `pointCount`; receives `mate` and the stars
void collectTopologyDefects(TetTopology& topology, Stage& stage, DefectCollector& defects);

}  // namespace hexhex
