// Moves all vertices around some cells at once, where moving them one by one gets stuck.
//
// Minimizes the foldover-free energy (untangle/untangle.hpp) of the eight corners of each cell,
// relative to corners with right angles and current edge lengths. As these lengths are updated from
// round to round, only angles count in the end. Cells that are not positive inside are left to the
// steps of single vertices: elements there take up to 4.6 times as long and gain nothing
// (docs/user/improve.md).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <improve/vertex_energy.hpp>
#include <improve/vertex_places.hpp>

namespace hexhex::improvement {

/// The vertices to move at once, and their cells.
struct MovingCells {
  std::span<const Index> vertices;  ///< those that move, unless their place is Fixed
  std::span<const Index> cells;     ///< all cells at these vertices
  const Array<IdealBox>& boxes;     ///< per cell of the mesh
};

/// Whether this build has the solver. Without it, vertices only move one by one.
[[nodiscard]] bool canMoveAtOnce() noexcept;

/// Moves free vertices to the averages of their neighbours, regardless of their current positions.
void spreadAtOnce(HexMesh& mesh, const VertexPlaces& places, const MovingCells& moving,
                  Stage& stage);

/// Untangles cells and brings their angles closer to right angles. Vertices on the surface move
/// along its tangents, then return to it, which may fold a few cells again.
/// @param isFolded  whether most cells may be inverted
/// @param isHeld    per vertex: 1 if it stays
void moveAtOnce(HexMesh& mesh, VertexPlaces& places, const MovingCells& moving, bool isFolded,
                const std::vector<std::uint8_t>& isHeld, Stage& stage);

}  // namespace hexhex::improvement
