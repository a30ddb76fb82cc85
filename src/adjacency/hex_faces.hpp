// Which faces of hexahedra are the same, for most of them without sorting (see hex_topology.hpp for
// all that follows from a whole mesh, and for meshes with faults).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex {

/// By axis: the corner next to corner 0.
inline constexpr std::array<std::size_t, 3> kNextCorner = {1, 3, 4};

/// A half-face by its number is 6 * cell + face (row of kHexFaces).
///
/// *Seams* are the faces whose two cells do not number their corners alike, and the boundary. A
/// vertex that is on no seam has eight cells, each of which has it at another corner: to go from
/// one to the next is to look up a mate.
struct HexMates {
  Array<Index> mates;               ///< per half-face: the same face in the other cell, or kNone
  Array<std::uint8_t> seamCorners;  ///< per cell: bit k if corner k is on a seam
};

/// @param cells  fewer than 2^32 / 6, with vertices in range, and different ones in each
/// @return nothing if a face has more than two cells, or two that do not pass it in opposite
///         directions
[[nodiscard]] std::optional<HexMates> matchHexFaces(std::size_t vertexCount,
                                                    std::span<const Hex> cells, Stage& stage);

/// The faces that belong to one cell only, by their places in the mesh: 8 * cell + face, ascending.
/// The mesh may have any faults, but corners out of range.
[[nodiscard]] Array<std::uint64_t> boundaryPlaces(const HexMesh& mesh, Stage& stage);

/// The vertices of faces that are given in this way, facing outwards.
[[nodiscard]] Array<Quad> quadsAt(const HexMesh& mesh, std::span<const std::uint64_t> places);

}  // namespace hexhex
