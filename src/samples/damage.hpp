// Makes a valid grid of tets invalid, in one place: what a repair is to mend.
#pragma once

#include <cstdint>

#include <hexhex/samples.hpp>

#include <samples/tet_grid.hpp>

namespace hexhex::samples {

/// Moves vertices near a random one, all copies alike, until at least `tets` tets are flipped or
/// flat. Boundaries stay on their planes and singular edges on their lines, so the undamaged map is
/// one that a repair could arrive at, and transitions, singularities and volume remain as they are.
/// @throws Error InvalidArgument if the sample has too few vertices of that kind
void damage(TetGrid& grid, const BlockComplex& complex, DefectKind kind, int tets,
            std::uint64_t seed);

}  // namespace hexhex::samples
