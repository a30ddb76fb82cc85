// What is wrong with a map apart from single flipped and flat tets: other violated conditions, away
// from such tets, and whole parts of the map that are inverted or collapsed.
#pragma once

#include <vector>

#include <adjacency/tet_topology.hpp>

#include <igm/defects.hpp>
#include <igm/igm.hpp>
#include <igm/input.hpp>

namespace hexhex::repairs {

struct Diagnosis {
  igm::DefectCollector hopeless;  ///< conditions violated by more than the limit
  std::vector<Index> roundable;   ///< vertices that violate conditions by less, ascending
};

/// Examines vertices and triangles that touch no bad tet.
/// @param bad  ascending
/// @param tolerance  deviations up to this are not defects
/// @param limit      maximum rounding of vertices; equal to `tolerance` for none
void diagnose(const igm::PreparedMap& map, const igm::LocalParameters& parameters,
              const std::vector<Index>& bad, double tolerance, double limit, Stage& stage,
              Diagnosis& diagnosis);

/// Moving parameters along free coordinates preserves volume. So a component of the mesh without
/// positive volume cannot be repaired; nor can a map with a large share of bad tets.
/// @param bad  ascending
/// @throws Error FlippedTet  saying what was found where
void refuseInvertedParts(const adjacency::TetTopology& topology,
                         const igm::LocalParameters& parameters, const std::vector<Index>& bad);

/// Refuses regions of many bad tets some of which have no good tet around them: what they were
/// meant to be would be a guess.
/// @param bad  ascending
/// @throws Error FlippedTet  likewise
void refuseInvertedRegions(const adjacency::TetTopology& topology, const std::vector<Index>& bad);

}  // namespace hexhex::repairs
