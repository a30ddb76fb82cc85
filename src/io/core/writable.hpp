// What all writers refuse.
#pragma once

#include <cstddef>
#include <span>

#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex {

/// Refuses a map that could not be read back.
/// @throws Error InvalidArgument if arrays disagree, IndexOutOfRange, NotFinite
void requireWritable(const TetMap& map, Stage& stage);

/// The first point with a coordinate that is infinite or no number, or the number of points.
[[nodiscard]] std::size_t firstNotFinite(std::span<const Vec3> points, Stage& stage);

}  // namespace hexhex
