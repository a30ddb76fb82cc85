// The properties at the end of an `.ovm` file.
#pragma once

#include <string_view>

#include <base/stage.hpp>
#include <io/core/text_scanner.hpp>
#include <io/ovm/ovm_mesh.hpp>

namespace hexhex {

/// Reads the properties that this library knows and skips all others.
/// @param scanner  behind the last cell
/// @param index    of its text
/// @param mesh     with complete topology
/// @throws Error FileSyntax, FileUnsupported
void readOvmTextProperties(const TextScanner& scanner, const TokenIndex& index, OvmMesh& mesh,
                           Stage& stage);

/// Whether two words are the same but for the case of their letters.
[[nodiscard]] bool equalsIgnoringCase(std::string_view a, std::string_view b) noexcept;

}  // namespace hexhex
