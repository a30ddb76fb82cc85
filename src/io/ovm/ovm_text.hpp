// `.ovm`: the text files of OpenVolumeMesh. Sections Vertices, Edges, Faces, Polyhedra, each with a
// count and one element per line; then properties: a line `HFProp vec3d "name"`, and a value per
// element.
#pragma once

#include <string>
#include <string_view>

#include <base/stage.hpp>
#include <io/ovm/ovm_mesh.hpp>

namespace hexhex {

/// Reads the mesh and the properties that this library knows. Handles are in range; nothing else
/// about the topology is checked.
/// @throws Error FileSyntax, FileUnsupported, IndexOutOfRange, NotFinite, TooLarge, with the line
[[nodiscard]] OvmMesh parseOvmText(std::string_view text, const std::string& fileName,
                                   Stage& stage);

}  // namespace hexhex
