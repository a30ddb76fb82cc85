// Leads labels around handles: graph cuts and random changes rarely find the way.
#pragma once

#include <vector>

#include <shape/handle_loops.hpp>
#include <shape/label_costs.hpp>

namespace hexhex::shape {

/// Chooses labels for the triangles of a loop, in order: the four around the axis closest to its
/// area, in turn and once around, such that they deviate least from the normals.
[[nodiscard]] Labels labelsAlong(const Surface& surface, const HandleLoop& loop);

/// Turns normals around handles as if each loop lay in an axis-aligned plane, and those close to
/// loops towards the labels of the loops. Labels of the new normals wind around the handles.
/// @return the labels of triangles in loops; lattice::kDirections elsewhere
Labels turnAroundHandles(Surface& surface, const std::vector<HandleLoop>& loops);

}  // namespace hexhex::shape
