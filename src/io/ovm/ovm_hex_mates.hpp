// Which sides of hexahedra are the same face.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex {

/// A side of a cell by its number, 8 * cell + face: face 2 * axis is at corner 0, face 2 * axis + 1
/// across from it, as in kHexFaces.
constexpr Index sideOf(std::size_t cell, std::size_t face) noexcept {
  return static_cast<Index>(8 * cell + face);
}
constexpr std::size_t cellOf(Index side) noexcept { return side / 8; }
constexpr std::size_t faceOf(Index side) noexcept { return side % 8; }

/// By axis: the corner next to corner 0.
inline constexpr std::array<std::size_t, 3> kNextCorner = {1, 3, 4};

/// *Seams* are the faces whose two cells do not number their corners alike (aligned_cells.hpp), and
/// the boundary. A vertex that is on no seam has eight cells, each of which has it at another
/// corner: to go from one to the next is to look up a mate.
struct HexMates {
  /// Per cell and face: the side that is the same face in the other cell, else the side itself.
  Array<Index> mates;
  Array<std::uint8_t> seamCorners;  ///< per cell: bit k if corner k is on a seam
};

/// @param cells  fewer than 2^32 / 12, with vertices in range
/// @return nothing if a face has more than two cells, or two that do not pass it in opposite
///         directions, if a cell has a vertex twice, or two edges have the same two vertices: at
///         least if this happens away from seams
[[nodiscard]] std::optional<HexMates> findHexMates(std::size_t vertexCount,
                                                   std::span<const Hex> cells, Stage& stage);

}  // namespace hexhex
