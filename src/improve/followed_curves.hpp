// Measures how much of the object's curves the edges of a mesh follow.
#pragma once

#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <improve/vertex_places.hpp>

namespace hexhex::improvement {

struct FollowedCurves {
  double length = 0;  ///< of all curves
  double share = 1;   ///< fraction of it that is followed; 1 without curves
};

/// A curve is followed where an edge of the mesh with both ends on curves is near and roughly
/// parallel.
/// @param surface    its curves count; vertices may be on those of another surface
/// @param tolerance  distance that is near enough, however short the edge
[[nodiscard]] FollowedCurves followedCurves(const HexMesh& mesh, const VertexPlaces& places,
                                            const ReferenceSurface& surface, double tolerance,
                                            Stage& stage);

}  // namespace hexhex::improvement
