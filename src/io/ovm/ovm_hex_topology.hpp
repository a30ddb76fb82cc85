// The quick way to the edges, faces and half-faces of hexahedra.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <io/ovm/ovm_mesh.hpp>

namespace hexhex {

/// The same as buildOvmTopology(), for meshes without faults. Edges along seams (HexMates) come
/// first, from the smaller to the larger vertex and in lexicographic order; then the others, cell
/// by cell, away from the cell's corner 0. Faces are numbered cell by cell, slot by slot.
/// @param cells  fewer than 2^32 / 12, with vertices in range
/// @return nothing if there are too many elements, or something is wrong with the mesh
[[nodiscard]] std::optional<OvmTopology> buildOvmHexTopology(std::size_t vertexCount,
                                                             std::span<const Hex> cells,
                                                             Stage& stage);

}  // namespace hexhex
