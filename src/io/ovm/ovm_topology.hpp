// Edges, faces and half-faces of cells that are given by their corners.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <adjacency/hex_faces.hpp>

#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <io/ovm/ovm_mesh.hpp>

namespace hexhex {

/// Faces of a tet as lists of its corners, in the order in which tools of the field list them.
/// Counter-clockwise seen from inside, if det(v1 - v0, v2 - v0, v3 - v0) > 0.
inline constexpr std::array<std::array<std::uint8_t, 3>, 4> kOvmTetFaces = {
    {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}};
/// The corner opposite each of them, and the face opposite each corner.
inline constexpr std::array<std::uint8_t, 4> kOvmTetOpposite = {3, 1, 2, 0};

/// Faces of a hexahedron in VTK's order: three pairs of opposite faces, counter-clockwise seen from
/// inside.
inline constexpr std::array<std::array<std::uint8_t, 4>, 6> kOvmHexFaces = {
    {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1}, {3, 2, 6, 7}, {1, 5, 6, 2}, {0, 3, 7, 4}}};

/// Finds the faces and edges of cells. Half-face 2f begins with the first corner of the slot of the
/// cell that it points into; that is a cell that has the face in the first slot of its list, if
/// there is one.
///
/// Of tets, edges go from the smaller to the larger vertex. Edges and faces come in the order of
/// their smallest vertices, and those of a vertex in the order in which its tets have them.
///
/// Of hexahedra, edges along seams (HexMates) come first, from the smaller to the larger vertex and
/// in lexicographic order; then the others, cell by cell, away from the cell's corner 0. Faces are
/// numbered cell by cell, slot by slot.
/// @param cells  corners of tets or hexahedra, vertices in range
/// @throws Error NonManifoldFace, Orientation if a face is shared by more than two cells, or by two
///         that do not run in opposite directions; RepeatedVertex; TooLarge
[[nodiscard]] OvmTopology buildOvmTopology(std::size_t vertexCount, std::span<const Tet> cells,
                                           Stage& stage);
[[nodiscard]] OvmTopology buildOvmTopology(std::size_t vertexCount, std::span<const Hex> cells,
                                           Stage& stage);

/// The part of buildOvmTopology() that numbers hexahedra, once their faces are matched.
/// @return nothing if a cell has a vertex twice
[[nodiscard]] std::optional<OvmTopology> numberHexes(std::size_t vertexCount,
                                                     std::span<const Hex> cells, HexMates mates,
                                                     Stage& stage);

/// @param what  e.g. "edges"
/// @throws Error TooLarge if there are more than the format can hold
void requireOvmCount(std::uint64_t limit, std::uint64_t count, const char* what);

/// Finds edges that are listed in the order of their smaller vertices, which come first.
class OvmEdgeFinder {
 public:
  /// @param edges  those of tets, or those of hexahedra along seams
  OvmEdgeFinder(std::size_t vertexCount, std::span<const std::array<Index, 2>> edges);
  /// The edge between two vertices, or kNone.
  [[nodiscard]] Index find(Index a, Index b) const noexcept;
  /// The half-edge of an edge that there is.
  [[nodiscard]] Index halfEdge(Index from, Index to) const noexcept {
    return 2 * find(from, to) + (from < to ? 0U : 1U);
  }

 private:
  std::span<const std::array<Index, 2>> edges_;
  Array<Index> begins_;  ///< per vertex (+1): its edges to larger vertices
};

}  // namespace hexhex
