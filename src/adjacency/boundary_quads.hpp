// The boundary of a hexahedral mesh, with little memory and in half the time that the whole
// topology takes (hex_topology.hpp), since nothing else is asked.
#pragma once

#include <cstdint>
#include <span>

#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex {

/// The faces that belong to one cell only, facing outwards, in order of (cell, face of the cell).
/// @param mesh  whose corners are vertices of the mesh
[[nodiscard]] Array<Quad> boundaryQuads(const HexMesh& mesh, Stage& stage);

/// The same faces by their places in the mesh: 8 * cell + face (row of kHexFaces), ascending.
[[nodiscard]] Array<std::uint64_t> boundaryPlaces(const HexMesh& mesh, Stage& stage);

/// The vertices of faces that are given in this way.
[[nodiscard]] Array<Quad> quadsAt(const HexMesh& mesh, std::span<const std::uint64_t> places);

}  // namespace hexhex
