// `.ovmb` files: a header, and the chunks behind it, which hold vertices, edges, faces, cells and
// properties.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <base/vector3.hpp>
#include <io/core/bytes.hpp>
#include <io/core/checked_sink.hpp>
#include <io/ovm/ovm_mesh.hpp>

namespace hexhex::io {

inline constexpr std::string_view kOvmbMagic = "OVMB\n\r\n\xff";

struct OvmbChunk {
  std::string_view type;     ///< four characters
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

/// A range of elements, as VERT, TOPO and PROP chunks begin with.
struct OvmbSpan {
  std::uint64_t first = 0;
  std::uint64_t count = 0;
};
[[nodiscard]] OvmbSpan readOvmbSpan(ByteCursor& cursor);

/// Decodes points that are stored as three floats or doubles each.
/// @return the first that is not finite, or their number
template <class Stored>
std::size_t decodeOvmbPoints(const char* data, std::span<Vec3> points, Stage& stage) {
  return firstFault(
      stage, points.size(),
      [&](std::size_t i) {
        for (std::size_t k = 0; k < 3; ++k) {
          points[i][k] = double{loadLittle<Stored>(data + (3 * i + k) * sizeof(Stored))};
        }
        return isFinite(points[i]);
      },
      std::size_t{1} << 14);
}

/// Decodes all VERT and TOPO chunks: any encoding of numbers, handles and valences, any number of
/// spans. Handles are in range afterwards; nothing else about the topology is checked.
/// @throws Error FileSyntax, FileUnsupported, IndexOutOfRange, NotFinite
void readOvmbElements(const OvmbFrame& frame, OvmMesh& mesh, Stage& stage);

}  // namespace hexhex::io
