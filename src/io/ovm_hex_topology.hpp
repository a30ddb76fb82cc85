// The quick way to the edges, faces and half-faces of hexahedra.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <io/ovm_mesh.hpp>

namespace hexhex {

/// The same as buildOvmTopology(), for meshes as they nearly always are. Faces are numbered by
/// their smallest vertices, then by the smaller and the larger one of its two neighbours;
/// half-face 2f passes the smaller one first.
/// @param cells  fewer than 2^32 / 6, with vertices in range, of which there are fewer than 2^31
/// @return nothing if a vertex has more than eight edges to larger vertices, two faces have three
///         vertices in common, or anything is wrong with the mesh
[[nodiscard]] std::optional<OvmTopology> buildOvmHexTopology(std::size_t vertexCount,
                                                             std::span<const Hex> cells,
                                                             Stage& stage);

}  // namespace hexhex
