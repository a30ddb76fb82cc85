// The quick way to the edges, faces and half-faces of tets.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <io/ovm/ovm_mesh.hpp>

namespace hexhex {

/// The same as buildOvmTopology(), for meshes without faults.
/// @param tets  fewer than 2^30, with vertices in range, of which there are fewer than 2^31
/// @return nothing if there are too many elements, a vertex has more than 256 edges to larger
///         vertices, or something is wrong with the mesh
[[nodiscard]] std::optional<OvmTopology> buildOvmTetTopology(std::size_t vertexCount,
                                                             std::span<const Tet> tets,
                                                             Stage& stage);

}  // namespace hexhex
