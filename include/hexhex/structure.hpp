// The structure of a hexahedral mesh: its singular edges, what its cells, faces and edges add up
// to, and cells that list their corners wrongly.
#pragma once

#include <array>
#include <cstdint>

#include <hexhex/context.hpp>
#include <hexhex/export.h>
#include <hexhex/types.hpp>

namespace hexhex HEXHEX_API_NAMESPACE {

/// An edge of a hex mesh with another number of cells around than 4 inside, or 2 on the boundary.
struct SingularHexEdge {
  Index vertex0 = 0;  ///< smaller than vertex1
  Index vertex1 = 0;
  std::uint32_t valence = 0;  ///< number of cells around
  bool boundary = false;      ///< an edge of a boundary quad
  bool operator==(const SingularHexEdge&) const = default;
};

struct MeshStructure {
  Array<SingularHexEdge> singularEdges;  ///< by vertex0, then vertex1
  std::uint64_t faces = 0;               ///< all different faces
  std::uint64_t edges = 0;               ///< all different edges
  std::uint64_t boundaryQuads = 0;
  std::uint64_t components = 0;          ///< of cells, connected through faces
  std::uint64_t boundaryComponents = 0;  ///< of boundary quads, connected through edges
  std::int64_t eulerCharacteristic = 0;  ///< used vertices - edges + faces - cells
};

/// Finds all of it, in linear time. About 60 bytes per cell of working memory.
/// @throws Error InvalidArgument for a cell with a vertex that does not exist; TooLarge for
///         2^32 - 1 cells or boundary quads or more
[[nodiscard]] MeshStructure findStructure(const HexMesh& mesh, Context& context);

/// A face that cannot be where it is: both cells are on one side of it, or there are more than two.
struct FaceConflict {
  std::array<Index, 4> vertices{};  ///< as `cell` passes them
  std::uint64_t cell = 0;
  std::uint64_t other = 0;  ///< the next cell that has it
  std::uint64_t cells = 0;  ///< that have it; 2: both pass it in the same direction
};

/// What is wrong with the lists of corners. Such cells cannot all be positive without an overlap,
/// wherever vertices are.
struct CellFaults {
  Array<std::uint64_t> repeated;  ///< cells that name a vertex twice, ascending; not in the rest
  /// Cells that list their corners the other way round, ascending: turned, all cells of a component
  /// pass common faces in opposite directions, and its volume is not negative.
  Array<std::uint64_t> mirrored;
  std::uint64_t sameDirectionFaces = 0;  ///< that two cells pass in the same direction
  std::uint64_t overfullFaces = 0;       ///< of more than two cells
  FaceConflict firstSameDirection;       ///< by the smallest vertex, as the next
  FaceConflict firstOverfull;
  /// The first cell of a component whose cells cannot be turned so, like those along a Moebius
  /// band; or kNone. None of its cells counts as mirrored.
  Index notOrientable = kNone;

  [[nodiscard]] bool any() const noexcept {
    return !repeated.empty() || !mirrored.empty() || sameDirectionFaces + overfullFaces > 0;
  }
};

/// Finds them in linear time, with about 50 bytes per cell of working memory.
/// @throws Error InvalidArgument for a cell with a vertex that does not exist; TooLarge for 2^31
///         cells or more
[[nodiscard]] CellFaults findCellFaults(const HexMesh& mesh, Context& context);

/// Turns the cells that are mirrored: lists their corners 4 to 7 before 0 to 3. Faces, tags and
/// regions stay as they are.
/// @return how many
/// @throws Error  as findCellFaults()
std::uint64_t reorient(HexMesh& mesh, Context& context);

}  // namespace HEXHEX_API_NAMESPACE
