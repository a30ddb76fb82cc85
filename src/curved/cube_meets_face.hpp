// Whether the open unit cube of a frame meets a triangle, exactly.
#pragma once

#include <cstdint>

#include <lattice/tet_geometry.hpp>

namespace hexhex {

/// Whether a closed triangle that is not degenerate has a point in the open cube from 0 to `unit`
/// along all axes. By separating axes: the open cube and the triangle are disjoint exactly if a
/// plane parallel to a side of the cube, to the triangle, or to an edge of each is between them.
[[nodiscard]] bool cubeMeetsFace(const LatticeTet& corners, int face, std::int64_t unit) noexcept;

}  // namespace hexhex
