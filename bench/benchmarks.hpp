// What main registers. Names are FAMILY/MAP/KEY:VALUE/...; bench/evaluation reads them.
#pragma once

namespace hexhex::bench {

/// extract/: the whole extraction and its stages on every map, with one and two threads; on some
/// maps also with 3, 4, 6, 8, ... up to all cores.
void registerExtraction();

/// scale/: the same on few maps at many scales.
void registerScales();

/// density/: the same from few to many hexahedra per tet.
void registerDensities();

/// check/: verification, quality and certificates beside the extraction; command/ and ways/: whole
/// runs of the command, the latter into files of all kinds.
void registerMesh();

/// Reading and writing maps and meshes.
void registerFiles();

/// arcs_and_patches/, lagrange/: curved meshes.
void registerCurved();

/// repair/: repair of damaged maps, and check and extraction of the undamaged ones.
void registerRepair();

}  // namespace hexhex::bench
