// The properties at the end of an `.ovm` file.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <base/stage.hpp>
#include <io/ovm_mesh.hpp>

namespace hexhex {

/// Reads the properties that this library knows and skips all others.
/// @param begin  the position in the text behind the last cell
/// @param mesh   with complete topology
/// @throws Error FileSyntax, FileUnsupported
void readOvmTextProperties(std::string_view text, std::size_t begin, const std::string& fileName,
                           OvmMesh& mesh, Stage& stage);

/// Whether two words are the same but for the case of their letters.
[[nodiscard]] bool equalsIgnoringCase(std::string_view a, std::string_view b) noexcept;

}  // namespace hexhex
