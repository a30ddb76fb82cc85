// All maps with the singular curves of a field, which are seamless whatever their unknowns are.
//
// The tets are cut open to a common chart. Conditions of a seamless map (what vertices on singular
// curves, on the boundary and on both sides of the cut have in common) are linear with integer
// coefficients; solved exactly, they leave free coordinates of vertices, free planes and free
// translations across pieces of the cut. Parameters are sums of these, nearly always with factors
// that are halves or integers: rounded to a grid, they make a map that is seamless to the last bit.
#pragma once

#include <vector>

#include <shape/frames_tets.hpp>
#include <untangle/problem.hpp>

#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex::shape {

/// The problem of the map whose gradients are nearest to the frames: its elements are the tets,
/// their targets what takes space to coordinates of the frame.
/// @pre around each edge, charts turn about an axis
[[nodiscard]] untangle::Problem seamlessProblem(const FrameTets& tets, const EdgeWalks& walks,
                                                Stage& stage);

/// Rounds unknowns such that parameters are exact.
/// @return tets that are not positive then, decided exactly
[[nodiscard]] std::vector<Index> roundUnknowns(untangle::Problem& problem);

[[nodiscard]] std::vector<TetParameters> parametersOf(const untangle::Problem& problem);

}  // namespace hexhex::shape
