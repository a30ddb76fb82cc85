// Which tets a repair has to mend.
#pragma once

#include <vector>

#include <hexhex/types.hpp>

#include <base/parallel.hpp>
#include <igm/exact_map.hpp>
#include <igm/input.hpp>

namespace hexhex {

/// det(u1 - u0, u2 - u0, u3 - u0): six times the signed volume.
[[nodiscard]] double determinantOf(const TetParameters& u) noexcept;

/// Whether a tet is flipped or flat, so far as floating point can tell.
[[nodiscard]] bool isBad(const TetParameters& u) noexcept;

/// Whether moving corners by up to `noise` along each axis could make a tet bad: the angles of such
/// a tet mean nothing.
[[nodiscard]] bool isThin(const TetParameters& u, double noise) noexcept;

/// The bad tets among all, ascending.
[[nodiscard]] std::vector<Index> findBadTets(std::size_t tets, const LocalParameters& parameters,
                                             Stage& stage);

/// The tets that are not positive on the sanitized lattice, ascending.
[[nodiscard]] std::vector<Index> findExactlyBadTets(const ExactMap& map, Stage& stage);

}  // namespace hexhex
