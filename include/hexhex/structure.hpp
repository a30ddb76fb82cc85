// Structure of a hexahedral mesh: its singular edges, its numbers of elements, and cells that list
// their corners incorrectly.
#pragma once

#include <array>
#include <cstdint>

#include <hexhex/context.hpp>
#include <hexhex/export.h>
#include <hexhex/types.hpp>

namespace hexhex HEXHEX_API_NAMESPACE {

/// An edge of a hex mesh whose number of cells is not 4 (inside) or 2 (on the boundary).
struct SingularHexEdge {
  Index vertex0 = 0;  ///< smaller than vertex1
  Index vertex1 = 0;
  std::uint32_t valence = 0;  ///< number of cells around the edge
  bool boundary = false;      ///< whether it is an edge of a boundary quad
  bool operator==(const SingularHexEdge&) const = default;
};

struct MeshStructure {
  Array<SingularHexEdge> singularEdges;  ///< sorted by vertex0, then vertex1
  std::uint64_t faces = 0;               ///< number of distinct faces
  std::uint64_t edges = 0;               ///< number of distinct edges
  std::uint64_t boundaryQuads = 0;
  std::uint64_t components = 0;          ///< of cells, connected through faces
  std::uint64_t boundaryComponents = 0;  ///< of boundary quads, connected through edges
  std::int64_t eulerCharacteristic = 0;  ///< used vertices - edges + faces - cells
};

/// Finds all of it, in linear time, using about 60 bytes of working memory per cell.
/// @throws Error InvalidArgument for a cell with a vertex that does not exist; TooLarge for
///         2^32 - 1 cells or boundary quads or more
[[nodiscard]] MeshStructure findStructure(const HexMesh& mesh, Context& context);

/// An impossible face: both its cells are on the same side, or there are more than two.
struct FaceConflict {
  std::array<Index, 4> vertices{};  ///< in the order in which `cell` lists them
  std::uint64_t cell = 0;
  std::uint64_t other = 0;  ///< the next cell with this face
  std::uint64_t cells = 0;  ///< number of cells with it; 2: both list it in the same direction
};

/// Faults in the corner lists of cells. Such cells cannot all be positive without overlap, wherever
/// their vertices are.
struct CellFaults {
  Array<std::uint64_t> repeated;  ///< cells that name a vertex twice, ascending; not in the rest
  /// Cells that list their corners in reverse orientation, ascending. Once they are reversed, all
  /// cells of a component list common faces in opposite directions, and its volume is not negative.
  Array<std::uint64_t> mirrored;
  std::uint64_t sameDirectionFaces = 0;  ///< faces that two cells list in the same direction
  std::uint64_t overfullFaces = 0;       ///< faces of more than two cells
  FaceConflict firstSameDirection;       ///< the one with the smallest vertex, like the next
  FaceConflict firstOverfull;
  /// The first cell of a component that cannot be oriented in this way, like cells along a Moebius
  /// band; or kNone. None of its cells counts as mirrored.
  Index notOrientable = kNone;

  [[nodiscard]] bool any() const noexcept {
    return !repeated.empty() || !mirrored.empty() || sameDirectionFaces + overfullFaces > 0;
  }
};

/// Finds these faults in linear time, using about 50 bytes of working memory per cell.
/// @throws Error InvalidArgument for a cell with a vertex that does not exist; TooLarge for 2^31
///         cells or more
[[nodiscard]] CellFaults findCellFaults(const HexMesh& mesh, Context& context);

/// Reverses mirrored cells: lists their corners 4 to 7 before 0 to 3. Preserves faces, tags and
/// regions.
/// @return the number of reversed cells
/// @throws Error  as findCellFaults()
std::uint64_t reorient(HexMesh& mesh, Context& context);

}  // namespace HEXHEX_API_NAMESPACE
