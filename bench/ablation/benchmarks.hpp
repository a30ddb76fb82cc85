// What main registers. Single steps beside alternatives to them, with one thread, are named
// FAMILY/MAP/scale:S/method:M, whole extractions ablation/MAP/switch:NAME/threads:T.
#pragma once

namespace hexhex::bench {

/// epsilon/: the propeller engine for different enlargements of tets.
void registerEpsilon();

/// rasterization/: the grid points of all tets by different methods.
void registerRasterization();

/// lookup/: the hex vertex at a grid point of a tet by different tables.
void registerLookup();

/// ablation/: whole extractions with a special path and without it.
void registerSwitches();

}  // namespace hexhex::bench
