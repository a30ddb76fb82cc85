// Brings the boundary of a mesh nearer to a surface where vertices on the surface cannot: between
// them, quads cut corners, so moving them to its other side halves the distance.
#pragma once

#include <cstdint>
#include <span>

#include <hexhex/types.hpp>

#include <improve/surface_distance.hpp>

namespace hexhex::improvement {

/// Per vertex, a move no longer than the limit. After these, which are nearly the least that do so,
/// no gap is longer than the limit, as far as that is possible.
/// @param isHeld  per vertex: 1 if it does not move
[[nodiscard]] Array<Vec3> closingMoves(std::span<const Gap> gaps, std::span<const Quad> quads,
                                       std::span<const std::uint8_t> isHeld, double limit);

}  // namespace hexhex::improvement
