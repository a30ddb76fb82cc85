// Faces, edges and connected components of a hexahedral mesh, however broken, in linear time and
// without hashing: everything that shares a face or an edge also shares its smallest vertex, so it
// suffices to sort the few faces and edges around each vertex.
//
// Faces are the same if they have the same four vertices, edges if they have the same two.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include <adjacency/cell_faces.hpp>
#include <adjacency/vertex_lists.hpp>

#include <hexhex/structure.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex::adjacency {

/// The cells around each vertex, ascending. A cell is listed once for each corner that has the
/// vertex, so a cell with repeated vertices is listed repeatedly. 32 bytes per cell plus 8 per
/// vertex.
using VertexCells = VertexLists<Index, std::uint64_t>;

/// @throws Error InvalidArgument for a corner that is not a vertex of the mesh; TooLarge for
///         2^32 - 1 cells or more
[[nodiscard]] VertexCells cellsAroundVertices(const HexMesh& mesh, Stage& stage);

/// How often a fault occurs, and where first (by smallest vertex, then cell).
struct FaceFault {
  std::uint64_t count = 0;
  CellFace<Hex> first;
};

/// What the cells share with each other.
struct HexFaces {
  Array<std::uint8_t> boundary;  ///< per cell: bit f is set if face f belongs to this cell alone
  std::uint64_t count = 0;       ///< distinct faces
  std::uint64_t boundaryCount = 0;
  FaceFault overfull;               ///< faces shared by more than two cells
  FaceFault sameDirection;          ///< faces that two cells do not traverse in opposite directions
  std::uint64_t components = 0;     ///< of cells, connected through faces
  std::uint64_t usedVertices = 0;   ///< vertices of at least one cell
  Index firstUnusedVertex = kNone;  ///< kNone if all are used
};

/// Finds all faces. @param around  of the same mesh
[[nodiscard]] HexFaces findFaces(const HexMesh& mesh, const VertexCells& around, Stage& stage);

/// Per cell and face (row of kHexFaces): the cell on the other side, kNone on the boundary.
using FaceNeighbours = Array<std::array<Index, 6>>;

/// @throws Error InvalidArgument for a face with more than two cells, and as cellsAroundVertices()
[[nodiscard]] FaceNeighbours findFaceNeighbours(const HexMesh& mesh, Stage& stage);

/// Per axis: the corner next to corner 0.
inline constexpr std::array<std::size_t, 3> kNextCorner = {1, 3, 4};

/// Half-faces are numbered 6 * cell + face (row of kHexFaces).
///
/// *Seams* are the faces whose two cells do not number their corners alike, and the boundary. A
/// vertex on no seam has eight cells, each of which has it at a different corner: going from one to
/// the next takes one look-up of a mate.
struct HexMates {
  Array<Index> mates;               ///< per half-face: the same face in the other cell, or kNone
  Array<std::uint8_t> seamCorners;  ///< per cell: bit k if corner k is on a seam
};

/// @param cells  fewer than 2^32 / 6, each with distinct vertices, all in range
/// @return nothing if a face has more than two cells, or two that do not traverse it in opposite
///         directions
[[nodiscard]] std::optional<HexMates> matchHexFaces(std::size_t vertexCount,
                                                    std::span<const Hex> cells, Stage& stage);

/// The faces that belong to one cell only, by their places in the mesh: 8 * cell + face, ascending.
/// The mesh may have any fault except corners out of range.
[[nodiscard]] std::vector<std::uint64_t> boundaryPlaces(const HexMesh& mesh, Stage& stage);

/// The vertices of faces given by their places, facing outwards.
[[nodiscard]] Array<Quad> quadsAt(const HexMesh& mesh, std::span<const std::uint64_t> places);

/// An edge of the mesh by its vertices, vertex0 <= vertex1.
struct MeshEdge {
  Index vertex0 = kNone;
  Index vertex1 = kNone;
};

/// Numbers and lists of edges.
struct HexEdges {
  std::uint64_t count = 0;          ///< distinct edges
  std::uint64_t boundaryCount = 0;  ///< edges of boundary quads
  /// Number of edges by number of cells around them, without the regular ones (4 inside, 2 on the
  /// boundary).
  std::map<int, std::uint64_t> innerSingular;
  std::map<int, std::uint64_t> boundarySingular;
  Array<SingularHexEdge> singular;       ///< the same edges individually, in lexicographic order
  std::uint64_t openCount = 0;           ///< boundary edges not in exactly two boundary quads
  MeshEdge firstOpen;                    ///< the lexicographically first of them
  std::uint64_t boundaryComponents = 0;  ///< of boundary quads, connected through edges
};

/// Finds all edges. @param around, faces  of the same mesh
/// @throws Error TooLarge for 2^32 - 1 boundary quads or more
[[nodiscard]] HexEdges findEdges(const HexMesh& mesh, const VertexCells& around,
                                 const HexFaces& faces, Stage& stage);

/// V - E + F - C.
[[nodiscard]] inline std::int64_t eulerCharacteristic(const HexMesh& mesh, const HexFaces& faces,
                                                      const HexEdges& edges) noexcept {
  return static_cast<std::int64_t>(faces.usedVertices + faces.count) -
         static_cast<std::int64_t>(edges.count + mesh.cells.size());
}

}  // namespace hexhex::adjacency
