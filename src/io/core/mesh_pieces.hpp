// A mesh in memory, in pieces.
#pragma once

#include <hexhex/stream.hpp>
#include <hexhex/types.hpp>

namespace hexhex {

/// Hands a mesh over, from begin() to end(). Generators go along if there are as many as vertices.
void sendTo(MeshSink& sink, const HexMesh& mesh);

}  // namespace hexhex
