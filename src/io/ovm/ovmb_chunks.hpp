// The frame of an `.ovmb` file: its header, and the chunks behind it.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <io/core/bytes.hpp>

namespace hexhex {

inline constexpr std::string_view kOvmbMagic = "OVMB\n\r\n\xff";
inline constexpr std::size_t kOvmbHeaderBytes = 48;

/// The chunk types that are known.
enum class OvmbChunkType : std::uint8_t { Vertices, Topology, Directory, Property };

struct OvmbChunk {
  OvmbChunkType type = OvmbChunkType::Vertices;
  std::string_view payload;  ///< without padding
};

/// A file that was cut into its pieces; refers to the bytes.
struct OvmbFrame {
  std::string_view bytes;
  const std::string& fileName;
  std::array<std::uint64_t, 4> counts{};  ///< of vertices, edges, faces, cells, as announced
  std::vector<OvmbChunk> chunks;          ///< in order, without unknown and end chunks

  [[nodiscard]] ByteCursor cursor(std::string_view part) const { return {part, bytes, fileName}; }
};

/// Whether a file begins like an `.ovmb` file.
[[nodiscard]] inline bool isOvmb(std::string_view bytes) noexcept {
  return bytes.starts_with(kOvmbMagic);
}

/// @param bytes, fileName  must outlive the frame
/// @throws Error FileSyntax, also if the end chunk is missing; FileUnsupported; TooLarge
[[nodiscard]] OvmbFrame splitOvmb(std::string_view bytes, const std::string& fileName);

}  // namespace hexhex
