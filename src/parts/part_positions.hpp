// Where vertices lie in space that are known by global numbers alone.
#pragma once

#include <cstdint>
#include <span>

#include <hexhex/types.hpp>

#include <sweep/tet_counts.hpp>

namespace hexhex::parts {

/// Describes vertices in some places of mesh.points, mesh.generatorTet and mesh.generatorCorners.
/// @param numbers  of the vertices, ascending
/// @param first    the place of the first one
void describeVertices(const igm::PreparedMap& map, const sweep::ElementCounts& counts,
                      std::span<const std::uint64_t> numbers, std::size_t first, HexMesh& mesh,
                      Stage& stage);

}  // namespace hexhex::parts
