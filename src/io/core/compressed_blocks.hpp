// Blocks compressed with zlib, LZ4 and LZMA, and gzip files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include <hexhex/types.hpp>

namespace hexhex::io {

// All readers of blocks: @return whether the block is complete and fills `bytes`.

/// Decompresses a block of LZ4 (github.com/lz4/lz4, doc/lz4_Block_format.md).
[[nodiscard]] bool decodeLz4Block(std::string_view compressed, std::span<char> bytes) noexcept;

/// Loads liblzma.
/// @throws Error FileUnsupported if it is not installed
void requireLzma(const std::filesystem::path& file);
/// Decompresses a stream of the `.xz` format. @pre requireLzma() was called
[[nodiscard]] bool decodeLzmaBlock(std::string_view compressed, std::span<char> bytes) noexcept;

/// Whether this build has zlib, without which the functions below fail.
[[nodiscard]] bool hasZlib() noexcept;
/// @param work, instead  as for failWithoutLibrary()
/// @throws Error FileUnsupported in a build without zlib
void requireZlib(const std::filesystem::path& file, std::string_view work,
                 std::string_view instead);

// Maximum compression ratios: a file that claims more is invalid.
inline constexpr std::size_t kLargestZlibRatio = 1032;
inline constexpr std::size_t kLargestLz4Ratio = 255;
inline constexpr std::size_t kLargestLzmaRatio = 8192;  // zeros reach 7,000

/// Decompresses a block of zlib.
[[nodiscard]] bool inflateBlock(std::string_view compressed, std::span<char> bytes) noexcept;

/// The bytes of a gzip file of one or more members.
/// @param name  for error messages
/// @throws Error FileSyntax for a file that is damaged or incomplete; FileUnsupported without zlib
[[nodiscard]] Array<char> inflateGzip(std::string_view compressed, const std::string& name);

/// Appends a compressed block, favouring speed over size.
/// @throws std::bad_alloc
void deflateByZlib(std::span<const char> bytes, Array<char>& compressed);
/// The same, by libdeflate where that is installed.
/// @throws Error FileWrite if it is, but cannot be loaded
void deflateBlock(std::span<const char> bytes, Array<char>& compressed);

/// Loads liblz4.
/// @throws Error FileUnsupported if it is not installed
void requireLz4(const std::filesystem::path& file);
/// Appends a block of LZ4. @pre requireLz4() was called
/// @param bytes  at most 2^30
void compressByLz4(std::span<const char> bytes, Array<char>& compressed);

}  // namespace hexhex::io
