// What main registers.
#pragma once

namespace hexhex::bench {

/// The whole extraction and its stages on every map, with one and two threads.
void registerExtraction();

/// Quality and verification of a finished mesh.
void registerMesh();

/// Reading maps.
void registerFiles();

}  // namespace hexhex::bench
