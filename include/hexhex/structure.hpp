// The structure of a hexahedral mesh: its singular edges, and what its cells, faces and edges add
// up to.
#pragma once

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

}  // namespace HEXHEX_API_NAMESPACE
