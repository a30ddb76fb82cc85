// Faces, edges and connected components of a hexahedral mesh, in linear time and without hashing:
// everything that shares a face or an edge also shares its smallest vertex, so it suffices to sort
// the few faces and edges around each vertex.
//
// Faces are the same if they have the same four vertices, edges if they have the same two.
#pragma once

#include <array>
#include <cstdint>
#include <map>

#include <adjacency/vertex_cells.hpp>

#include <hexhex/structure.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex {

/// Local corners of the six faces of a cell, counter-clockwise seen from outside, in VTK's order.
inline constexpr std::array<std::array<std::uint8_t, 4>, 6> kHexFaces = {
    {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}}};

/// Local corners of the twelve edges of a cell, in VTK's order.
inline constexpr std::array<std::array<std::uint8_t, 2>, 12> kHexEdges = {{{0, 1},
                                                                           {1, 2},
                                                                           {3, 2},
                                                                           {0, 3},
                                                                           {4, 5},
                                                                           {5, 6},
                                                                           {7, 6},
                                                                           {4, 7},
                                                                           {0, 4},
                                                                           {1, 5},
                                                                           {3, 7},
                                                                           {2, 6}}};

/// One side of one cell.
struct CellFace {
  Index cell = kNone;
  std::uint8_t face = 0;  ///< row of kHexFaces
};

/// The four vertices of a face of a cell, counter-clockwise seen from outside.
[[nodiscard]] constexpr Quad faceVertices(const Hex& cell, std::size_t face) noexcept {
  const auto& corners = kHexFaces[face];
  return {cell[corners[0]], cell[corners[1]], cell[corners[2]], cell[corners[3]]};
}

/// How often something wrong occurs, and where first (by smallest vertex, then cell).
struct FaceFault {
  std::uint64_t count = 0;
  CellFace first;
};

/// What the cells share with each other.
struct HexFaces {
  Array<std::uint8_t> boundary;  ///< per cell: bit f is set if face f belongs to this cell alone
  std::uint64_t count = 0;       ///< all different faces
  std::uint64_t boundaryCount = 0;
  FaceFault overfull;               ///< faces shared by more than two cells
  FaceFault sameDirection;          ///< faces of two cells that do not run in opposite directions
  std::uint64_t components = 0;     ///< of cells, connected through faces
  std::uint64_t usedVertices = 0;   ///< vertices of at least one cell
  Index firstUnusedVertex = kNone;  ///< kNone if all are used
};

/// Finds all faces. @param around  of the same mesh
[[nodiscard]] HexFaces findFaces(const HexMesh& mesh, const VertexCells& around, Stage& stage);

/// An edge of the mesh by its vertices, vertex0 <= vertex1.
struct MeshEdge {
  Index vertex0 = kNone;
  Index vertex1 = kNone;
};

/// What is known about the edges.
struct HexEdges {
  std::uint64_t count = 0;          ///< all different edges
  std::uint64_t boundaryCount = 0;  ///< edges of boundary quads
  /// Number of edges by number of cells around, without the regular ones (4 inside, 2 on the
  /// boundary).
  std::map<int, std::uint64_t> innerSingular;
  std::map<int, std::uint64_t> boundarySingular;
  Array<SingularHexEdge> singular;       ///< the same edges one by one, in lexicographic order
  std::uint64_t openCount = 0;           ///< boundary edges not in exactly two boundary quads
  MeshEdge firstOpen;                    ///< the lexicographically first of them
  std::uint64_t boundaryComponents = 0;  ///< of boundary quads, connected through edges
};

/// Finds all edges. @param around, faces  of the same mesh
/// @throws Error TooLarge for 2^32 - 1 boundary quads or more
[[nodiscard]] HexEdges findEdges(const HexMesh& mesh, const VertexCells& around,
                                 const HexFaces& faces, Stage& stage);

}  // namespace hexhex
