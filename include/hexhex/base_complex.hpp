// Decomposition of a hexahedral mesh: sheets and chords, the blocks of its base complex, and its
// singular graph.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <hexhex/context.hpp>
#include <hexhex/export.h>
#include <hexhex/types.hpp>

namespace hexhex HEXHEX_API_NAMESPACE {

/// A piece of the mesh without interior singular edges, bounded by the boundary and by walls: the
/// faces that extend straight from singular edges.
struct MeshBlock {
  std::uint64_t cells = 0;
  /// Cells along each axis: from corner 0 to corners 1, 3 and 4 of the first cell. If an axis forms
  /// a closed ring, the number of cells in the ring. 0, 0, 0 for a block that is not a box, such as
  /// a ring that is closed with a twist.
  std::array<std::uint64_t, 3> size{};
};

/// A chain of singular edges of the same valence, entirely inside or entirely on the boundary, that
/// ends where other chains meet it or where it stops; or a closed chain, whose last vertex is its
/// first.
struct SingularCurve {
  std::vector<Index> vertices;
  std::uint32_t valence = 0;  ///< number of cells around each edge
  bool boundary = false;
};

/// Vertices with the same configuration of singular edges.
struct IrregularVertices {
  bool boundary = false;                        ///< whether they are on the boundary
  std::vector<std::uint32_t> innerValences;     ///< of their interior singular edges, ascending
  std::vector<std::uint32_t> boundaryValences;  ///< of their boundary singular edges, ascending
  std::vector<Index> vertices;                  ///< ascending
};

/// Sheets, chords and blocks are numbered in order of their first cells.
struct BaseComplex {
  /// Per cell: the sheets of its edges from corner 0 to 1, 3 and 4. Opposite edges of a face belong
  /// to the same sheet.
  Array<std::array<Index, 3>> cellSheets;
  Index sheets = 0;
  /// Per cell: the chords through it along these axes. Opposite faces of a cell belong to the same
  /// chord.
  Array<std::array<Index, 3>> cellChords;
  Index chords = 0;
  Array<Index> cellBlocks;
  std::vector<MeshBlock> blocks;
  std::vector<SingularCurve> curves;         ///< chains with ends first
  std::vector<IrregularVertices> irregular;  ///< interior first, then sorted by valences
};

/// Finds all of it, in linear time except for the singular edges, using about 100 bytes per cell.
/// Cells are connected through faces; a shared edge or vertex alone does not connect them.
/// @throws Error InvalidArgument for cells with faults according to findCellFaults(), unless the
///         mesh is mirrored as a whole, or with a vertex that does not exist; TooLarge for 7e8
///         cells or more
[[nodiscard]] BaseComplex findBaseComplex(const HexMesh& mesh, Context& context);

}  // namespace HEXHEX_API_NAMESPACE
