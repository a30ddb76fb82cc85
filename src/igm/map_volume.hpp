// The parametric volume of a map.
#pragma once

#include <igm/exact_map.hpp>
#include <igm/tet_rounder.hpp>

namespace hexhex {

// Sets map.sixfoldVolume from corners and transitions, for a map without defects, by one of two
// sums:

/// Along the boundary and the cuts.
/// @param survey  knows the boundary, and where tets differ
void addVolume(const RegularVertices& survey, Stage& stage, ExactMap& map);

/// Tet by tet.
/// @param rounded  measured
void addVolume(const RoundedTets& rounded, Stage& stage, ExactMap& map);

}  // namespace hexhex
