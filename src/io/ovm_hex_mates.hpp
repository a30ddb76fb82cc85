// Which sides of hexahedra are the same face.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex {

/// Side 6 * cell + face stands for a row of kHexFaces of a cell: face 2 * axis at corner 0, face
/// 2 * axis + 1 across from it.
///
/// *Seams* are the faces whose two cells do not number their corners alike (aligned_cells.hpp), and
/// the boundary. A vertex that is on no seam has eight cells, each of which has it at another
/// corner: to go from one to the next is to look up a mate.
struct HexMates {
  Array<Index> mates;  ///< per side: the same face in the other cell, else the side itself
  Array<std::uint8_t> seamCorners;  ///< per cell: bit k if corner k is on a seam
};

/// @param cells  fewer than 2^32 / 12, with vertices in range
/// @return nothing if a face has more than two cells, or two that do not pass it in opposite
///         directions, if a cell has a vertex twice, or two edges have the same two vertices: at
///         least if this happens away from seams
[[nodiscard]] std::optional<HexMates> findHexMates(std::size_t vertexCount,
                                                   std::span<const Hex> cells, Stage& stage);

}  // namespace hexhex
