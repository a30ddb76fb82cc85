// Types of elements in `.msh` files of all versions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include <hexhex/error.hpp>

namespace hexhex {

inline constexpr unsigned kGmshLine = 1;
inline constexpr unsigned kGmshQuad = 3;
inline constexpr unsigned kGmshHexahedron = 5;
inline constexpr unsigned kGmshPoint = 15;

/// The number of nodes, or 0 if it is not known.
[[nodiscard]] constexpr std::size_t nodesOfGmshType(std::int64_t type) noexcept {
  // By type; 0 for types without a fixed number. From Gmsh's documentation.
  constexpr std::array<std::uint8_t, 32> kNodes = {0,  2,  3,  4,  4, 8, 6,  5,  3,  6, 9,
                                                   10, 27, 18, 14, 1, 8, 20, 15, 13, 9, 10,
                                                   12, 15, 15, 21, 4, 5, 6,  20, 35, 56};
  constexpr std::int64_t kHexahedronOf64 = 92;
  constexpr std::int64_t kHexahedronOf125 = 93;
  if (type == kHexahedronOf64) return 64;
  if (type == kHexahedronOf125) return 125;
  const bool known = type > 0 && type < static_cast<std::int64_t>(kNodes.size());
  return known ? kNodes[static_cast<std::size_t>(type)] : 0;
}

/// The same, of elements that are read.
template <class Source>
[[nodiscard]] std::size_t requireGmshType(const Source& source, std::int64_t type) {
  const std::size_t nodes = nodesOfGmshType(type);
  if (nodes > 0) return nodes;
  source.fail(
      ErrorCode::FileUnsupported,
      "elements of type " + std::to_string(type) +
          " have a number of nodes that is not known here, so that they cannot be skipped.");
}

/// The dimension of elements that may be cells or features.
[[nodiscard]] constexpr std::int64_t dimensionOfGmshType(std::int64_t type) noexcept {
  if (type == kGmshPoint) return 0;
  if (type == kGmshLine) return 1;
  return type == kGmshQuad ? 2 : 3;
}

}  // namespace hexhex
