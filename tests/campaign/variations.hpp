// Changes of a map that leave its mesh as it is, but for numbers and places of elements.
#pragma once

#include <lattice/grid_motion.hpp>

#include "campaign/block_map.hpp"

namespace hexhex::campaign {

/// Any rotation, and a translation by up to `limit` along each axis.
[[nodiscard]] lattice::Transition drawChart(std::int64_t limit, Random& random);

/// Draws which changes to make: other charts, more tets, other numbers, a mirror image, noise,
/// unused vertices, another place and size in space.
/// @param[in,out] drawn  its kind tells of what is rare
void vary(DrawnMap& drawn, Random& random);

}  // namespace hexhex::campaign
