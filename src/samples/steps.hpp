// The steps from a block complex to a map and its answer, in order.
#pragma once

#include <cstdint>

#include <hexhex/samples.hpp>

#include <samples/block_complex.hpp>
#include <samples/tet_grid.hpp>

namespace hexhex::samples {

/// Tets stay positive under this multiple of the noise, so that the angles between their faces,
/// whose sums reveal singular edges, stay recognizable too.
inline constexpr double kNoiseReserve = 4;

/// Moves every vertex by up to `share` of a sub-block along each axis in the map and, inside, in
/// space, as far as all tets stay positive in both: the way an optimizer might leave them. The map
/// stays an integer-grid map: shifts are the same in all charts, boundaries stay on their planes
/// and singular edges on their lines.
/// @param share  in [0, 1]
/// @param noise  by which corners will still be moved, in parameter units; see kNoiseReserve
void jitter(TetGrid& grid, const BlockComplex& complex, double share, double noise,
            std::uint64_t seed);

/// Rounds parameters of some vertices (a random choice of their coordinates) to the nearest
/// integers, unless tets would flip, so that lattice points fall onto vertices, edges and faces of
/// tets. Other parameters as for jitter.
/// @param share  of the vertices, in [0, 1]
void roundToLattice(TetGrid& grid, const BlockComplex& complex, double share, double noise,
                    std::uint64_t seed);

/// Makes a valid grid invalid in one place, as a task for repair: moves vertices near a random one,
/// all copies alike, until at least `tets` tets are flipped or flat. Boundaries stay on their
/// planes and singular edges on their lines, so repair could arrive at the undamaged map;
/// transitions, singularities and volume remain unchanged.
/// @throws Error InvalidArgument if the sample has too few vertices of the required kind
void damage(TetGrid& grid, const BlockComplex& complex, DefectKind kind, int tets,
            std::uint64_t seed);

/// Tags corners, curves and patches, and numbers the blocks as regions, as described in
/// SampleOptions::features.
/// @param[out] map  gets features and regions for the tets of `grid` in order
void addFeatures(const TetGrid& grid, const BlockComplex& complex, TetMap& map);

/// Gives each block or tet its own chart, and adds noise. Reads charts, noise, offset and seed of
/// the options.
/// @param grid  loses its points
/// @param[out] map  gets points, tets and parameters
void addCharts(TetGrid&& grid, const BlockComplex& complex, const SampleOptions& options,
               TetMap& map);

/// What a block complex implies about the hexahedral mesh.
/// @param cellsPerEdge  hexahedra along each block edge, at least 1
/// @param features  whether they are tagged
[[nodiscard]] SampleAnswer expectedAnswer(const BlockComplex& complex, std::uint64_t cellsPerEdge,
                                          bool features);

}  // namespace hexhex::samples
