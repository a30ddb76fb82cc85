// How do two meshes differ that should agree up to the numbering of vertices, the numbering of
// cells, and the orientation of each cell?
//
// Cells are matched by their places in space, and vertices by their cells, since several vertices
// may be at one place, e.g. on both sides of a slit. Where even several cells are at one place,
// their neighbours decide.
#pragma once

#include <cstdint>

#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex::verification {

/// Their number, and the smallest.
struct Odd {
  std::uint64_t count = 0;
  std::size_t first = 0;
};

struct Mismatch {
  Odd strangeVertices;  ///< where the right mesh has no vertex
  Odd gluedVertices;    ///< a single one where the right mesh has several
  Odd splitVertices;    ///< several where the right mesh has one: all but one of them
  Odd unusedVertices;   ///< in no cell
  Odd strangeCells;     ///< absent from the right mesh, or duplicates
  Odd missingCells;     ///< cells of the right mesh, by its numbers
};

/// @param right  the reference
/// @param found  the mesh to compare; corners of both are in range
/// @param tolerance  maximum distance between matching vertices, along each axis
[[nodiscard]] Mismatch matchMeshes(const HexMesh& right, const HexMesh& found, double tolerance,
                                   Stage& stage);

}  // namespace hexhex::verification
