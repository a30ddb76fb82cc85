// Blocks of bytes, and files, compressed with zlib; only if the library was built with it.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include <hexhex/types.hpp>

namespace hexhex::io {

/// Whether the functions below work.
[[nodiscard]] bool hasZlib() noexcept;

/// What zlib can make of a compressed byte at most: a file that promises more is wrong.
inline constexpr std::size_t kLargestZlibRatio = 1032;

/// Whether `compressed` is a whole block of exactly so many bytes, which then are at their place.
[[nodiscard]] bool inflateBlock(std::string_view compressed, std::span<char> bytes) noexcept;

/// The bytes of a gzip file of one or more members.
/// @param name  for errors
/// @throws Error FileSyntax for a file that is damaged or incomplete; FileUnsupported without zlib
[[nodiscard]] Array<char> inflateGzip(std::string_view compressed, const std::string& name);

/// Appends a block, compressed fast rather than small.
/// @throws std::bad_alloc
void deflateBlock(std::span<const char> bytes, Array<char>& compressed);

}  // namespace hexhex::io
