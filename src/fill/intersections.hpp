// Self-intersections of a surface.
#pragma once

#include <array>
#include <optional>

#include <hexhex/fill.hpp>

#include <base/stage.hpp>

namespace hexhex::fill {

/// The first pair of triangles with a common point that is not a vertex or on an edge of both, for
/// any number of threads. Exact.
/// @param surface  its triangles have nonzero area and no two have the same corners
[[nodiscard]] std::optional<std::array<Index, 2>> firstIntersection(const TriangleMesh& surface,
                                                                    Stage& stage);

/// Whether a triangle has no area. Exact.
[[nodiscard]] bool isFlat(const std::array<Vec3, 3>& triangle);

}  // namespace hexhex::fill
