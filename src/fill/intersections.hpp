// Where a surface meets itself.
#pragma once

#include <array>
#include <optional>

#include <hexhex/fill.hpp>

#include <base/stage.hpp>

namespace hexhex::fill {

/// Two triangles that have a point in common which is not on a vertex or an edge of both: the first
/// such pair, for any number of threads. Exact.
/// @param surface  whose triangles have an area, and no two the same corners
[[nodiscard]] std::optional<std::array<Index, 2>> firstIntersection(const TriangleMesh& surface,
                                                                    Stage& stage);

/// Whether a triangle has no area. Exact.
[[nodiscard]] bool isFlat(const std::array<Vec3, 3>& triangle);

}  // namespace hexhex::fill
