// What is wrong with a map apart from single flipped and flat tets: other conditions, looked for
// where no such tet is near, and whole parts of the map that are inverted or collapsed.
#pragma once

#include <vector>

#include <adjacency/tet_topology.hpp>

#include <igm/defects.hpp>
#include <igm/input.hpp>
#include <igm/prepare.hpp>

namespace hexhex::repairs {

struct Diagnosis {
  igm::DefectCollector hopeless;  ///< conditions violated by more than the limit
  std::vector<Index> roundable;   ///< vertices with conditions violated by up to it, ascending
};

/// Looks at vertices and triangles that no bad tet touches.
/// @param bad  ascending
/// @param tolerance  up to which nothing is wrong
/// @param limit      up to which vertices may be rounded; equal to `tolerance` if not
void diagnose(const igm::PreparedMap& map, const igm::LocalParameters& parameters,
              const std::vector<Index>& bad, double tolerance, double limit, Stage& stage,
              Diagnosis& diagnosis);

/// Moving parameters along free coordinates changes no volume. So a component of the mesh without
/// positive volume cannot be repaired; nor can a map of which a large part is bad.
/// @param bad  ascending
/// @throws Error FlippedTet  that says what was found where
void refuseInvertedParts(const adjacency::TetTopology& topology,
                         const igm::LocalParameters& parameters, const std::vector<Index>& bad);

/// Refuses regions of many bad tets some of which have no good tet around: only a guess would tell
/// what they were meant to be.
/// @param bad  ascending
/// @throws Error FlippedTet  likewise
void refuseInvertedRegions(const adjacency::TetTopology& topology, const std::vector<Index>& bad);

}  // namespace hexhex::repairs
