// Moves the borders of charts to where they cost least, and keeps which charts meet where.
#pragma once

#include <vector>

#include <shape/surface.hpp>

#include <hexhex/context.hpp>

#include <base/function_ref.hpp>

namespace hexhex::shape {

using CostOfTriangle = FunctionRef<double(Index triangle, Index chart)>;
using CostOfSide = FunctionRef<double(Side side, Index chart, Index beyond)>;

/// A triangle changes to a chart beside it only if that deforms the charts: none is torn, gets a
/// hole, or meets itself or another one elsewhere; corners move from a vertex to a neighbour.
/// @param[in,out] chartOf  per triangle
void moveBorders(const Surface& surface, std::vector<Index>& chartOf, CostOfTriangle ofTriangle,
                 CostOfSide ofSide, Context& context);

}  // namespace hexhex::shape
