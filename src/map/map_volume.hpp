// The parametric volume of a map.
#pragma once

#include <map/exact_map.hpp>

namespace hexhex {

/// Sets map.sixfoldVolume, from corners and transitions.
/// @param plain  knows the boundary, and where tets differ
void addVolume(const PlainVertices& plain, Stage& stage, ExactMap& map);

}  // namespace hexhex
