// What is wrong with a map apart from flipped and flat tets: looked for where none of them is near.
#pragma once

#include <vector>

#include <igm/defects.hpp>
#include <igm/input.hpp>
#include <igm/prepare.hpp>

namespace hexhex {

struct Diagnosis {
  DefectCollector hopeless;      ///< conditions violated by more than the limit
  std::vector<Index> roundable;  ///< vertices with conditions violated by up to it, ascending
};

/// Looks at vertices and triangles that no bad tet touches.
/// @param bad  ascending
/// @param tolerance  up to which nothing is wrong
/// @param limit      up to which vertices may be rounded; equal to `tolerance` if not
void diagnose(const PreparedMap& map, const LocalParameters& parameters,
              const std::vector<Index>& bad, double tolerance, double limit, Stage& stage,
              Diagnosis& diagnosis);

}  // namespace hexhex
