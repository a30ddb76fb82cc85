// Conversions between maps and hex meshes, whose cells are lists of corners, and polyhedral meshes,
// whose cells are lists of half-faces.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <io/core/cell_counts.hpp>
#include <io/formats/ovm_mesh.hpp>

namespace hexhex::io {

/// Converts a mesh of tets to a map.
/// @param fileName  for error messages
/// @throws Error FileUnsupported if a cell is no tet or there is no map; FileSyntax if cells are
///         invalid; NotFinite
[[nodiscard]] TetMap toTetMap(OvmMesh&& mesh, const std::string& fileName, Stage& stage);

/// Converts a mesh of tets, ignoring a map if there is one.
[[nodiscard]] TetCells toTetCells(OvmMesh&& mesh, const std::string& fileName, Stage& stage);

/// Converts a mesh of hexahedra. Half-faces may be in any order; if most cells are inverted, all
/// are reversed.
/// @throws Error FileUnsupported if a cell is no hexahedron; FileSyntax if cells are invalid
[[nodiscard]] HexMesh toHexMesh(OvmMesh&& mesh, const std::string& fileName, Stage& stage);

/// The content of a file. Half-faces point into their cells, and the loops of a cell's first slots
/// start at its first corner where neighbours allow it; elsewhere, the property CornerOrder gives
/// the order.
/// @param mesh  with corners and generators in range
/// @throws Error InvalidArgument if array sizes disagree, or features or valences refer to elements
///         that are not in the mesh; IndexOutOfRange, RepeatedVertex, NotFinite, NonManifoldFace,
///         Orientation, TooLarge
[[nodiscard]] OvmOutput toOvm(const TetMap& map, Stage& stage);
[[nodiscard]] OvmOutput toOvm(const HexMesh& mesh, Stage& stage);

/// The topology of a map's file.
/// @param tets  with vertices in range
[[nodiscard]] OvmTopology ovmTopologyOf(std::span<const Vec3> points, std::span<const Tet> tets,
                                        Stage& stage);

/// Whether two corners are the same vertex.
template <std::size_t corners>
[[nodiscard]] bool hasVertexTwice(const std::array<Index, corners>& cell) noexcept {
  Index alike = 0;  // pairs of equal corners, each paired with itself, too
  for (const Index a : cell) {
    for (const Index b : cell) alike += a == b ? 1U : 0U;
  }
  return alike > corners;
}

/// Assembles the hexahedron with these six faces in VTK order: the loop of the first one, then the
/// vertices joined to it by edges. Its volume is positive if loops are counter-clockwise seen from
/// inside.
/// @return false if they do not bound a hexahedron
using QuadLoops = std::array<std::array<Index, 4>, 6>;
[[nodiscard]] bool assembleHex(const QuadLoops& loops, Hex& hex);

/// Corner orders of a hexahedron, as numbered by the property CornerOrder. The first face is always
/// the same: orders 0 to 3 start at that corner of it, 4 to 7 run in the other direction.
inline constexpr std::size_t kHexOrders = 8;
[[nodiscard]] Hex inHexOrder(const Hex& assembled, std::size_t order) noexcept;

/// The n vertices of a face in loop order; all kNone if it is not a closed loop of n half-edges.
/// @pre  faces have n half-edges, or kNone
template <std::size_t n>
[[nodiscard]] std::array<Index, n> loopOfFace(const OvmTopology& topology, std::size_t face) {
  const std::span<const Index> halfEdges = topology.faces[face];
  std::array<Index, n> loop;
  bool closed = halfEdges[0] != kNone;
  for (std::size_t i = 0; closed && i < n; ++i) {
    loop[i] = topology.from(halfEdges[i]);
    closed = topology.to(halfEdges[i]) == topology.from(halfEdges[(i + 1) % n]);
  }
  if (!closed) loop.fill(kNone);
  return loop;
}

/// The same for a half-face, given the loop of its face.
template <std::size_t n>
[[nodiscard]] std::array<Index, n> loopOfHalfFace(const std::array<Index, n>& ofFace,
                                                  Index halfFace) noexcept {
  if (halfFace % 2 == 0) return ofFace;
  std::array<Index, n> reversed;
  for (std::size_t i = 0; i < n; ++i) reversed[i] = ofFace[(n - i) % n];
  return reversed;
}

/// Faces of a tet by corners, in the order that other tools use. Counter-clockwise seen from inside
/// if det(v1 - v0, v2 - v0, v3 - v0) > 0.
inline constexpr std::array<std::array<std::uint8_t, 3>, 4> kOvmTetFaces = {
    {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}};
/// The corner opposite each of them, and the face opposite each corner.
inline constexpr std::array<std::uint8_t, 4> kOvmTetOpposite = {3, 1, 2, 0};

/// Faces of a hexahedron in VTK order: three pairs of opposite faces, counter-clockwise seen from
/// inside.
inline constexpr std::array<std::array<std::uint8_t, 4>, 6> kOvmHexFaces = {
    {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1}, {3, 2, 6, 7}, {1, 5, 6, 2}, {0, 3, 7, 4}}};

/// Finds the faces and edges of cells. A face is owned by a cell that has it in the first slot of
/// its list, if there is one; half-face 2f points into the owner and starts at the first corner of
/// its slot.
///
/// For tets, edges run from the smaller to the larger vertex. Edges and faces are sorted by
/// smallest vertex; those of a vertex are in the order in which its tets have them.
///
/// For hexahedra, edges along seams (HexMates) come first, from the smaller to the larger vertex,
/// in lexicographic order; then the others, cell by cell, away from the cell's corner 0. Faces are
/// numbered cell by cell, slot by slot.
/// @param cells  corners of tets or hexahedra, vertices in range
/// @throws Error NonManifoldFace, Orientation if a face is shared by more than two cells, or by two
///         with the same orientation; RepeatedVertex; TooLarge
[[nodiscard]] OvmTopology buildOvmTopology(std::size_t vertexCount, std::span<const Tet> cells,
                                           Stage& stage);
[[nodiscard]] OvmTopology buildOvmTopology(std::size_t vertexCount, std::span<const Hex> cells,
                                           Stage& stage);

/// Finds edges in a list sorted by their smaller vertices, which come first.
class OvmEdgeFinder {
 public:
  /// @param edges  of tets, or of hexahedra along seams
  OvmEdgeFinder(std::size_t vertexCount, std::span<const std::array<Index, 2>> edges);
  /// The edge between two vertices, or kNone.
  [[nodiscard]] Index find(Index a, Index b) const noexcept;
  /// The half-edge between two vertices. @pre  the edge exists
  [[nodiscard]] Index halfEdge(Index from, Index to) const noexcept {
    return 2 * find(from, to) + (from < to ? 0U : 1U);
  }

 private:
  std::span<const std::array<Index, 2>> edges_;
  Array<Index> begins_;  ///< per vertex (+1): start of its edges to larger vertices
};

}  // namespace hexhex::io
