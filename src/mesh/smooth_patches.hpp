// Patches of boundary quads between sharp edges: what boundaryPatches() says, for quads that are
// known already.
#pragma once

#include <span>

#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex::mesh {

struct SmoothPatches {
  Array<Index> patchOf;  ///< per quad: from 0 on, in order of the patches' first quads
  Index count = 0;
};

/// @param quads  facing outwards
/// @param angle  in degrees, from 0 to 180
/// @param seams  edges that separate whatever the angle; those with tag 0 do not
[[nodiscard]] SmoothPatches findSmoothPatches(std::span<const Vec3> points,
                                              std::span<const Quad> quads, double angle,
                                              std::span<const FeatureEdge> seams, Stage& stage);

/// @throws Error InvalidArgument for an angle that is not from 0 to 180
void requirePatchAngle(double angle);

}  // namespace hexhex::mesh
