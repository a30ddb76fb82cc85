// What a hexahedral mesh is made of: sheets and chords, the blocks of its base complex, and the
// graph of its singular edges.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <hexhex/context.hpp>
#include <hexhex/export.h>
#include <hexhex/types.hpp>

namespace hexhex HEXHEX_API_NAMESPACE {

/// A piece of the mesh without singular edges inside, bounded by the boundary and by walls: the
/// faces that go straight on from singular edges.
struct MeshBlock {
  std::uint64_t cells = 0;
  /// Cells along each axis, those of the corners 0, 1, 3 and 4 of the first cell; an axis that
  /// closes to a ring has as many as the ring. 0, 0, 0 for a block that is no box: a ring that is
  /// closed with a twist, for instance.
  std::array<std::uint64_t, 3> size{};
};

/// A chain of singular edges of one valence, all inside or all on the boundary, between vertices
/// where others meet it or where it ends; or closed: its last vertex is its first one.
struct SingularCurve {
  std::vector<Index> vertices;
  std::uint32_t valence = 0;  ///< number of cells around each edge
  bool boundary = false;
};

/// Vertices with the same singular edges.
struct IrregularVertices {
  bool boundary = false;                        ///< whether they are on the boundary
  std::vector<std::uint32_t> innerValences;     ///< of their singular edges inside, ascending
  std::vector<std::uint32_t> boundaryValences;  ///< and on the boundary
  std::vector<Index> vertices;                  ///< ascending
};

/// Sheets, chords and blocks are numbered in order of their first cells.
struct BaseComplex {
  /// Per cell, the sheets of its edges from corner 0 to 1, 3 and 4. Edges are in one sheet if they
  /// are across from each other in a face.
  Array<std::array<Index, 3>> cellSheets;
  Index sheets = 0;
  /// Per cell, the chords that pass it along these axes. Faces are in one chord if they are across
  /// from each other in a cell.
  Array<std::array<Index, 3>> cellChords;
  Index chords = 0;
  Array<Index> cellBlocks;
  std::vector<MeshBlock> blocks;
  std::vector<SingularCurve> curves;         ///< those with ends first
  std::vector<IrregularVertices> irregular;  ///< inside first, then by valences
};

/// Finds all of it, in linear time but for the singular edges, with about 100 bytes per cell. Cells
/// go together through faces: what shares an edge or a vertex alone does not.
/// @throws Error InvalidArgument for cells that findCellFaults() faults, if not mirrored as a
/// whole,
///         or with a vertex that does not exist; TooLarge for 7e8 cells or more
[[nodiscard]] BaseComplex findBaseComplex(const HexMesh& mesh, Context& context);

}  // namespace HEXHEX_API_NAMESPACE
