// Moves the vertices of a regular grid of tets so that it looks like the output of an optimizer
// (jitter), or so that lattice points fall onto vertices, edges and faces of tets (rounding).
#pragma once

#include <samples/tet_grid.hpp>

namespace hexhex::samples {

/// Tets stay positive under this multiple of the noise, so that angles between their faces, whose
/// sums tell which edges are singular, stay recognizable too.
inline constexpr double kNoiseReserve = 4;

/// Moves every vertex by up to `share` of a sub-block along each axis in the map and, inside, in
/// space, as far as all tets stay positive in both. The map stays an integer-grid map: shifts are
/// the same in all charts, boundaries stay on their planes and singular edges on their lines.
/// @param share  in [0, 1]
/// @param noise  by which corners will still be moved, in parameter units; see kNoiseReserve
void jitter(TetGrid& grid, const BlockComplex& complex, double share, double noise,
            std::uint64_t seed);

/// Rounds parameters of some vertices (a random choice of their coordinates) to the nearest
/// integers, unless tets would flip. The rest as for jitter.
/// @param share  of the vertices, in [0, 1]
void roundToLattice(TetGrid& grid, const BlockComplex& complex, double share, double noise,
                    std::uint64_t seed);

}  // namespace hexhex::samples
