// Which vertices of a MEDIT file have a tag, that is, are corners of the object.
//
// Files list corners in the sections Corners and RequiredVertices. Where there is none, references
// may name corners, but also the curve, surface or part that each vertex is on, or nothing at all.
// Corners are few and apart: a reference names them unless all vertices have it, or one of them has
// two neighbours with it.
#pragma once

#include <cstdint>
#include <vector>

#include <hexhex/types.hpp>

namespace hexhex::io {

/// @param corners     vertices in those sections, in any order; empty: there are none
/// @param references  per vertex; or empty: they say nothing
/// @param cells       with vertices that exist
/// @return by vertex; tags are the references, 1 for corners whose reference is 0
[[nodiscard]] std::vector<FeatureVertex> vertexTags(std::vector<Index> corners,
                                                    const Array<std::int32_t>& references,
                                                    const Array<Hex>& cells);

}  // namespace hexhex::io
