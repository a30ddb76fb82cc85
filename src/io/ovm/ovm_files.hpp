// Readers and writers of `.ovm` (text) and `.ovmb` (binary): both deliver and take the same meshes.
//
// A text has the sections Vertices, Edges, Faces, Polyhedra, each with a count and one element per
// line; then properties: a line `HFProp vec3d "name"`, and a value per element. Binary files are a
// header and chunks (ovmb_reader.hpp).
#pragma once

#include <string>
#include <string_view>

#include <base/stage.hpp>
#include <io/core/output_file.hpp>
#include <io/ovm/ovm_mesh.hpp>

namespace hexhex {

/// Read the mesh and the properties that this library knows. Handles are in range; nothing else
/// about the topology is checked.
/// @throws Error FileSyntax, FileUnsupported, IndexOutOfRange, NotFinite, TooLarge, with the line
/// or
///         byte
[[nodiscard]] OvmMesh parseOvmText(std::string_view text, const std::string& fileName,
                                   Stage& stage);
[[nodiscard]] OvmMesh parseOvmb(std::string_view bytes, const std::string& fileName, Stage& stage);

/// Write and commit a mesh in the layout of OpenVolumeMesh's own files: for each kind of element
/// one chunk or section, handles without offset; numbers of `.ovm` have the fewest digits that read
/// back to the same double.
/// @param mesh  for `.ovm` with faces and cells of one valence each
/// @throws Error FileWrite
void writeOvmText(const OvmOutput& mesh, OutputFile& output, Stage& stage);
void writeOvmb(const OvmOutput& mesh, OutputFile& output, Stage& stage);

}  // namespace hexhex
