// What main registers: single steps beside alternatives to them, with one thread. Names are
// FAMILY/MAP/scale:S/method:M.
#pragma once

namespace hexhex::bench {

/// rasterization/: the grid points of all tets by different methods.
void registerRasterization();

/// lookup/: the hex vertex at a grid point of a tet by different tables.
void registerLookup();

}  // namespace hexhex::bench
