// All vertices around some cells at once, where one after the other is in the way of the next.
//
// The foldover-free energy (untangle/untangle.hpp) of the eight corners of each cell, relative to
// corners with right angles and edges as long as they are. So these follow the mesh from round to
// round, and what counts in the end are angles.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <improve/vertex_energy.hpp>
#include <improve/vertex_places.hpp>

namespace hexhex::improvement {

/// What moves at once.
struct MovingCells {
  std::span<const Index> vertices;  ///< those that move, unless their place is Fixed
  std::span<const Index> cells;     ///< all that these have
  const Array<IdealBox>& boxes;     ///< per cell of the mesh
};

/// Whether this build has the solver. Without it, vertices only move one by one.
[[nodiscard]] bool canMoveAtOnce() noexcept;

/// Moves free vertices to the means of their neighbours, from wherever they are.
void spreadAtOnce(HexMesh& mesh, const VertexPlaces& places, const MovingCells& moving,
                  Stage& stage);

/// Untangles cells and brings their angles nearer to right ones. Vertices on the surface move in
/// its tangents, then back onto it, which may fold a few cells again.
/// @param isFolded  whether most cells may be inside out
/// @param isHeld    per vertex: 1 if it stays
void moveAtOnce(HexMesh& mesh, VertexPlaces& places, const MovingCells& moving, bool isFolded,
                const std::vector<std::uint8_t>& isHeld, Stage& stage);

}  // namespace hexhex::improvement
