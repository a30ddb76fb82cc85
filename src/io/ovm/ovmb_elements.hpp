// Vertices, edges, faces and cells of an `.ovmb` file.
#pragma once

#include <base/stage.hpp>
#include <io/ovm/ovm_mesh.hpp>
#include <io/ovm/ovmb_chunks.hpp>

namespace hexhex {

/// A range of elements, as VERT, TOPO and PROP chunks begin with.
struct OvmbSpan {
  std::uint64_t first = 0;
  std::uint64_t count = 0;
};
[[nodiscard]] OvmbSpan readOvmbSpan(ByteCursor& cursor);

/// Decodes all VERT and TOPO chunks: any encoding of numbers, handles and valences, any number of
/// spans. Handles are in range afterwards; nothing else about the topology is checked.
/// @throws Error FileSyntax, FileUnsupported, IndexOutOfRange, NotFinite
void readOvmbElements(const OvmbFrame& frame, OvmMesh& mesh, Stage& stage);

}  // namespace hexhex
