// Blocks of bytes, compressed with zlib; only if the library was built with it.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include <hexhex/types.hpp>

namespace hexhex::io {

/// Whether the functions below work.
[[nodiscard]] bool hasZlib() noexcept;

/// What zlib can make of a compressed byte at most: a file that promises more is wrong.
inline constexpr std::size_t kLargestZlibRatio = 1032;

/// Whether `compressed` is a whole block of exactly so many bytes, which then are at their place.
[[nodiscard]] bool inflateBlock(std::string_view compressed, std::span<char> bytes) noexcept;

/// Appends a block, compressed fast rather than small.
/// @throws std::bad_alloc
void deflateBlock(std::span<const char> bytes, Array<char>& compressed);

}  // namespace hexhex::io
