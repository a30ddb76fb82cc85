// How the edges and faces of hexahedra are numbered.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <adjacency/hex_faces.hpp>

#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <io/ovm/ovm_mesh.hpp>

namespace hexhex {

/// The rest of buildOvmTopology(), once faces are matched.
[[nodiscard]] OvmTopology numberHexes(std::size_t vertexCount, std::span<const Hex> cells,
                                      HexMates mates, Stage& stage);

/// @param what  e.g. "edges"
/// @throws Error TooLarge if there are more than the format can hold
void requireOvmCount(std::uint64_t limit, std::uint64_t count, const char* what);

}  // namespace hexhex
