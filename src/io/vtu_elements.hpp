// Points and hexahedra of a `.vtu` file, a range at a time, checked.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>

#include <hexhex/types.hpp>

#include <io/vtu_file.hpp>

namespace hexhex {

inline constexpr std::int64_t kVtuHexahedron = 12;

/// Reads points from number `first` on.
/// @throws Error NotFinite
inline void readVtuPoints(const VtuFile& file, std::uint64_t first, std::span<Vec3> points) {
  file.copy(file.coordinates(), 3 * first, 3 * points.size(), points.data()->data());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (std::isfinite(points[i][0]) && std::isfinite(points[i][1]) && std::isfinite(points[i][2])) {
      continue;
    }
    file.fail(ErrorCode::NotFinite,
              "a coordinate of point " + std::to_string(first + i) + " is not finite.",
              Place{PlaceKind::Vertex, first + i});
  }
}

/// Number of hexahedra among `count` cells from number `first` on.
[[nodiscard]] std::size_t countVtuHexahedra(const VtuFile& file, std::uint64_t first,
                                            std::size_t count);

/// Reads the hexahedra among `count` cells from number `first` on.
/// @param hexahedra  room for as many as countVtuHexahedra() says
/// @throws Error FileSyntax, IndexOutOfRange
template <class Vertex>
void readVtuHexahedra(const VtuFile& file, std::uint64_t first, std::size_t count,
                      std::array<Vertex, 8>* hexahedra);

/// Throws the error of a file with cells but no hexahedra among them.
[[noreturn]] void failWithoutHexahedra(const VtuFile& file);

}  // namespace hexhex
