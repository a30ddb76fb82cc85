// Sizes in `.meshb` files, which decide on the version of the format.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

namespace hexhex {

/// Sizes of numbers in a version.
struct MeshbWidths {
  std::uint64_t position;
  std::uint64_t integer;

  explicit MeshbWidths(std::uint32_t version)
      : position(version >= 3 ? 8 : 4), integer(version >= 4 ? 8 : 4) {}

  /// Bytes of a section of n elements, with its head.
  [[nodiscard]] std::uint64_t section(std::uint64_t n, std::uint64_t integers,
                                      std::uint64_t doubles) const {
    return 4 + position + integer + n * (integers * integer + 8 * doubles);
  }
};

struct MeshbCounts {
  std::uint64_t vertices = 0;
  std::uint64_t edges = 0;
  std::uint64_t quads = 0;
  std::uint64_t hexahedra = 0;
};

/// The smallest version that holds such a mesh (see writeMeshb()).
[[nodiscard]] inline std::uint32_t meshbVersionFor(const MeshbCounts& counts) {
  constexpr std::uint64_t kMost = std::numeric_limits<std::int32_t>::max();
  if (std::max({counts.vertices, counts.quads, counts.hexahedra}) > kMost) return 4;
  const MeshbWidths widths(2);
  const std::uint64_t bytes =
      64 + widths.section(counts.vertices, 1, 3) + widths.section(counts.edges, 3, 0) +
      widths.section(counts.quads, 5, 0) + widths.section(counts.hexahedra, 9, 0);
  return bytes > kMost ? 3 : 2;
}

}  // namespace hexhex
