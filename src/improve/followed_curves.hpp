// How much of the object's curves the edges of a mesh follow.
#pragma once

#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <improve/vertex_places.hpp>

namespace hexhex::improvement {

struct FollowedCurves {
  double length = 0;  ///< of all curves
  double share = 1;   ///< of that length, from 0 to 1; 1 if there is none
};

/// A curve is followed where an edge of the mesh is near it, in about its direction, both ends of
/// which stay on curves.
/// @param surface    whose curves are meant: vertices may be on others
/// @param tolerance  near enough, however short the edge
[[nodiscard]] FollowedCurves followedCurves(const HexMesh& mesh, const VertexPlaces& places,
                                            const ReferenceSurface& surface, double tolerance,
                                            Stage& stage);

}  // namespace hexhex::improvement
