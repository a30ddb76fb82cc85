// The lines of a `.mesh` file, for whoever writes one: at once or in pieces.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <io/core/line_writer.hpp>

namespace hexhex {

inline constexpr std::string_view kMeditHead = "MeshVersionFormatted 2\nDimension 3\nVertices\n";

/// Writes vertices: coordinates and a reference each.
/// @param references  empty: all are 0
inline void writeMeditVertices(LineWriter& lines, std::span<const Vec3> points,
                               LoopProgress* progress = nullptr,
                               std::span<const std::uint32_t> references = {}) {
  constexpr std::size_t kRoom = 4 * (kNumberRoom + 1);
  lines.write(
      points.size(), kRoom,
      [=](char* place, std::size_t i) {
        place = putNumbers(place, points[i]);
        if (references.empty()) return put(place, " 0\n");
        return put(put(put(place, ' '), references[i]), '\n');
      },
      progress);
}

/// Writes elements: 1-based vertices and a reference each.
/// @param references  empty: all are 1
template <class Vertex, std::size_t corners>
void writeMeditElements(LineWriter& lines, std::span<const std::array<Vertex, corners>> elements,
                        LoopProgress* progress = nullptr,
                        std::span<const std::uint32_t> references = {}) {
  constexpr std::size_t kRoom = (corners + 1) * (kNumberRoom + 1);
  lines.write(
      elements.size(), kRoom,
      [=](char* place, std::size_t i) {
        // 64 bits: 32 would wrap for the last vertex of the largest mesh.
        for (const Vertex vertex : elements[i]) {
          place = put(put(place, std::uint64_t{vertex} + 1), ' ');
        }
        if (references.empty()) return put(place, "1\n");
        return put(put(place, references[i]), '\n');
      },
      progress);
}

}  // namespace hexhex
