// Patches of boundary quads between sharp edges: boundaryPatches() for quads that are already
// known.
#pragma once

#include <span>

#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex::mesh {

struct SmoothPatches {
  Array<Index> patchOf;  ///< per quad: numbered from 0 in the order of the patches' first quads
  Index count = 0;
};

/// @param quads  facing outward
/// @param angle  in degrees, from 0 to 180
/// @param seams  edges that separate patches whatever the angle; those with tag 0 do not
[[nodiscard]] SmoothPatches findSmoothPatches(std::span<const Vec3> points,
                                              std::span<const Quad> quads, double angle,
                                              std::span<const FeatureEdge> seams, Stage& stage);

/// @throws Error InvalidArgument for an angle outside 0 to 180
void requirePatchAngle(double angle);

}  // namespace hexhex::mesh
