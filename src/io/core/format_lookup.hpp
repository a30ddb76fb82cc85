// Finds the formats of files in the table of registry.hpp, by their names or by the files'
// extensions.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <io/core/registry.hpp>

namespace hexhex {

/// The format of a file that holds, or will hold, a map or a hex mesh: the one of this name or, if
/// it is empty, what the extension means. It reads or writes such files, if not both.
/// @throws Error FileUnsupported, naming the extensions or the formats that are known
[[nodiscard]] const Format& mapFormat(const std::filesystem::path& file,
                                      std::string_view name = {});
/// @throws Error  the same, also for a format that this build cannot write
[[nodiscard]] const Format& hexMeshFormat(const std::filesystem::path& file,
                                          std::string_view name = {});
/// The same of a file that may hold either.
[[nodiscard]] const Format& mapOrHexMeshFormat(const std::filesystem::path& file,
                                               std::string_view name);
/// The same of a file whose tets can be read.
[[nodiscard]] const Format& tetFormat(const std::filesystem::path& file, std::string_view name);

/// "mesh, meshb": the names of all formats that fit.
[[nodiscard]] std::string listFormatNames(bool (*fits)(const Format& format));

}  // namespace hexhex
