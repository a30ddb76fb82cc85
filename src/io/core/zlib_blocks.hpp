// zlib-compressed blocks and gzip files; available only if built with zlib.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include <hexhex/types.hpp>

namespace hexhex::io {

/// Whether this build has zlib, without which the functions below fail.
[[nodiscard]] bool hasZlib() noexcept;
/// @param work, instead  as for failWithoutLibrary()
/// @throws Error FileUnsupported in a build without zlib
void requireZlib(const std::filesystem::path& file, std::string_view work,
                 std::string_view instead);

/// Maximum compression ratio of zlib: a file that claims more is invalid.
inline constexpr std::size_t kLargestZlibRatio = 1032;

/// Decompresses a block into `bytes`. @return whether it is complete and has exactly this size
[[nodiscard]] bool inflateBlock(std::string_view compressed, std::span<char> bytes) noexcept;

/// The bytes of a gzip file of one or more members.
/// @param name  for error messages
/// @throws Error FileSyntax for a file that is damaged or incomplete; FileUnsupported without zlib
[[nodiscard]] Array<char> inflateGzip(std::string_view compressed, const std::string& name);

/// Appends a compressed block, favouring speed over size.
/// @throws std::bad_alloc
void deflateBlock(std::span<const char> bytes, Array<char>& compressed);

}  // namespace hexhex::io
