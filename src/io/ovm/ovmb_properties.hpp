// Properties of an `.ovmb` file.
#pragma once

#include <base/stage.hpp>
#include <io/ovm/ovm_mesh.hpp>
#include <io/ovm/ovmb_chunks.hpp>

namespace hexhex {

/// Decodes the properties that this library knows, by entity, name and type; the map may be of
/// doubles or floats, integers of any width, or bits. All others are skipped, after a check of
/// their place in the file. Elements outside of all spans have the default value.
/// @param mesh  with complete topology
/// @throws Error FileSyntax, FileUnsupported
void readOvmbProperties(const OvmbFrame& frame, OvmMesh& mesh, Stage& stage);

}  // namespace hexhex
