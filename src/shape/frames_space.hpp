// The linear space of seamless maps with the singular curves of a field.
//
// The tets are cut open to a common chart. The conditions of a seamless map (for vertices on
// singular curves, on the boundary and on both sides of the cut) are linear with integer
// coefficients. Solved exactly, they leave free coordinates of vertices, free planes and free
// translations across pieces of the cut. Parameters are sums of these, nearly always with factors
// that are integers or halves: if unknowns are rounded to a grid, the map is seamless to the last
// bit.
#pragma once

#include <vector>

#include <shape/frames_tets.hpp>
#include <untangle/problem.hpp>

#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex::shape {

/// The problem of the map whose gradients are closest to the frames. Elements are the tets; their
/// targets map space to coordinates of the frame.
/// @pre around each edge, charts agree or turn about an axis
[[nodiscard]] untangle::Problem seamlessProblem(const FrameTets& tets, const EdgeWalks& walks,
                                                Stage& stage);

/// Rounds unknowns so that parameters are exact.
/// @return tets that are exactly nonpositive then
[[nodiscard]] std::vector<Index> roundUnknowns(untangle::Problem& problem);

[[nodiscard]] std::vector<TetParameters> parametersOf(const untangle::Problem& problem);

}  // namespace hexhex::shape
