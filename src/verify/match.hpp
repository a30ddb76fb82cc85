// What distinguishes two meshes that should agree up to the numbering of vertices, of cells, and
// the orientation of each cell?
//
// Places in space tell which cells are the same, and these tell which vertices are: there may be
// several vertices at one place, e.g. on both sides of a slit. Where there are even several cells,
// their neighbours tell.
#pragma once

#include <cstdint>

#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex::verification {

/// How many there are, and the smallest.
struct Odd {
  std::uint64_t count = 0;
  std::size_t first = 0;
};

struct Mismatch {
  Odd strangeVertices;  ///< where the right mesh has no vertex
  Odd gluedVertices;    ///< one where the right mesh has several
  Odd splitVertices;    ///< several where the right mesh has one: all but one
  Odd unusedVertices;   ///< of no cell
  Odd strangeCells;     ///< that the right mesh does not have, or not twice
  Odd missingCells;     ///< of the right mesh, by its numbers
};

/// @param right  a mesh
/// @param found  another one; corners of both in range
/// @param tolerance  how far apart, along each axis, a vertex may be in both
[[nodiscard]] Mismatch matchMeshes(const HexMesh& right, const HexMesh& found, double tolerance,
                                   Stage& stage);

}  // namespace hexhex::verification
