// Which of the 24 rotations carries two vectors over best.
#pragma once

#include <array>
#include <optional>

#include <hexhex/types.hpp>

#include <lattice/rotation.hpp>

namespace hexhex {

/// Two edges of a triangle, in the chart of one tet or the other.
using VectorPair = std::array<Vec3, 2>;

/// argmin over the rotations R of |images[0] - R vectors[0]|^2 + |images[1] - R vectors[1]|^2, as
/// far as rounding can tell; the first of several.
[[nodiscard]] Rotation bestRotation(const VectorPair& vectors, const VectorPair& images) noexcept;

/// The same, found by comparing all rotations; for vectors that leave a choice, and for tests.
[[nodiscard]] Rotation bestRotationOfAll(const VectorPair& vectors,
                                         const VectorPair& images) noexcept;

/// The same, but nothing unless it is certain that all other rotations are far worse.
[[nodiscard]] std::optional<Rotation> certainRotation(const VectorPair& vectors,
                                                      const VectorPair& images) noexcept;

}  // namespace hexhex
