// From a grid of tets with one chart per block to a map: gives each block or tet its own chart, and
// adds noise.
#pragma once

#include <hexhex/samples.hpp>

#include <samples/tet_grid.hpp>

namespace hexhex::samples {

/// The finished map; takes the points out of the grid. Reads charts, noise, offset and seed of the
/// options.
[[nodiscard]] TetMap mapWithCharts(TetGrid&& grid, const BlockComplex& complex,
                                   const SampleOptions& options);

}  // namespace hexhex::samples
