// What all writers refuse.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include <hexhex/io.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex {

[[nodiscard]] inline bool isFinite(const Vec3& v) noexcept {
  return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}
[[nodiscard]] inline bool isFinite(const TetParameters& corners) noexcept {
  return isFinite(corners[0]) && isFinite(corners[1]) && isFinite(corners[2]) &&
         isFinite(corners[3]);
}

/// The first point with a coordinate that is infinite or no number, or the number of points.
[[nodiscard]] std::size_t firstNotFinite(std::span<const Vec3> points, Stage& stage);

/// Refuses a map that could not be read back.
/// @throws Error InvalidArgument if arrays disagree, IndexOutOfRange, NotFinite
void requireWritable(const TetMap& map, Stage& stage);

/// Refuses meshes that would crash a writer or could not be read back.
/// @throws Error InvalidArgument if arrays disagree or a cell names no vertex, NotFinite
void requireWritable(const HexMesh& mesh, const WriteOptions& options, Stage& stage);

}  // namespace hexhex
