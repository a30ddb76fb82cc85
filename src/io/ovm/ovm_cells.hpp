// Maps and hex meshes, whose cells are lists of corners, from and to polyhedral meshes, whose cells
// are lists of half-faces.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include <adjacency/hex_topology.hpp>

#include <hexhex/types.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/cell_mesh.hpp>
#include <io/ovm/ovm_mesh.hpp>

namespace hexhex::io {

/// The map of a tet mesh.
/// @param fileName  for error messages
/// @throws Error FileUnsupported if a cell is no tet or there is no map; FileSyntax if cells are
///         wrong; NotFinite
[[nodiscard]] TetMap toTetMap(OvmMesh&& mesh, const std::string& fileName, Stage& stage);

/// The same tets without a map, whether there is one or not.
[[nodiscard]] TetCells toTetCells(OvmMesh&& mesh, const std::string& fileName, Stage& stage);

/// The cells of a hex mesh. Half-faces may come in any order; if most cells are inside out, all are
/// turned.
/// @throws Error FileUnsupported if a cell is no hexahedron; FileSyntax if cells are wrong
[[nodiscard]] HexMesh toHexMesh(OvmMesh&& mesh, const std::string& fileName, Stage& stage);

/// What a file holds. Half-faces point into their cells, and the first slots of cells begin with
/// the cells' corners where neighbours allow it; elsewhere, the property CornerOrder tells the
/// order.
/// @param mesh  with corners and generators in range
/// @throws Error InvalidArgument if arrays disagree, or features and valences name what is not in
///         the mesh; IndexOutOfRange, RepeatedVertex, NotFinite, NonManifoldFace, Orientation,
///         TooLarge
[[nodiscard]] OvmOutput toOvm(const TetMap& map, Stage& stage);
[[nodiscard]] OvmOutput toOvm(const HexMesh& mesh, Stage& stage);

/// The topology of a map's file.
/// @param tets  with vertices in range
[[nodiscard]] OvmTopology ovmTopologyOf(std::span<const Vec3> points, std::span<const Tet> tets,
                                        Stage& stage);

/// Whether valueOf(i) is negative for more of the i in [0, n) than it is positive.
template <class F>
[[nodiscard]] bool areMostlyNegative(Stage& stage, std::size_t n, const F& valueOf) {
  constexpr std::size_t kGrain = 4096;
  std::atomic<std::int64_t> balance{0};
  parallelBlocks(stage, n, kGrain, [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
    std::int64_t local = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const double value = valueOf(i);
      local += value > 0 ? 1 : (value < 0 ? -1 : 0);
    }
    balance.fetch_add(local, std::memory_order_relaxed);
  });
  return balance.load() < 0;
}

/// Whether two corners are the same vertex.
template <std::size_t corners>
[[nodiscard]] bool hasVertexTwice(const std::array<Index, corners>& cell) noexcept {
  Index alike = 0;  // pairs of corners, each with itself among them
  for (const Index a : cell) {
    for (const Index b : cell) alike += a == b ? 1U : 0U;
  }
  return alike > corners;
}

/// Orders of a hexahedron's corners, which the property CornerOrder numbers. The first face is
/// always the same: 0 to 3 begin with that corner of it, 4 to 7 go round in the other direction.
inline constexpr std::size_t kHexOrders = 8;
[[nodiscard]] Hex inHexOrder(const Hex& assembled, std::size_t order) noexcept;

/// The n vertices of a face, in loop order; all are kNone if it has no closed loop of n half-edges.
template <std::size_t n>
[[nodiscard]] std::array<Index, n> loopOfFace(const OvmTopology& topology, std::size_t face) {
  const std::span<const Index> halfEdges = topology.faces[face];
  std::array<Index, n> loop;
  bool closed = halfEdges.size() == n;
  for (std::size_t i = 0; closed && i < n; ++i) {
    loop[i] = topology.from(halfEdges[i]);
    closed = topology.to(halfEdges[i]) == topology.from(halfEdges[(i + 1) % n]);
  }
  if (!closed) loop.fill(kNone);
  return loop;
}

/// The same of a half-face, given the loop of its face.
template <std::size_t n>
[[nodiscard]] std::array<Index, n> loopOfHalfFace(const std::array<Index, n>& ofFace,
                                                  Index halfFace) noexcept {
  if (halfFace % 2 == 0) return ofFace;
  std::array<Index, n> reversed;
  for (std::size_t i = 0; i < n; ++i) reversed[i] = ofFace[(n - i) % n];
  return reversed;
}

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
                                                     std::span<const Hex> cells,
                                                     adjacency::HexMates mates, Stage& stage);

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

}  // namespace hexhex::io
