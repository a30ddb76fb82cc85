// Feature edges of an object, and which of them are edges of its polycube.
#pragma once

#include <cstddef>
#include <vector>

#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex::shape {

struct FoundFeatures {
  std::size_t count = 0;    ///< number of feature edges of the tet mesh
  std::size_t aligned = 0;  ///< those between triangles perpendicular to different axes in the map
  std::vector<FeatureEdge> tagged;  ///< those of them that do not fade out, ascending
  std::size_t innerFaces = 0;       ///< tagged faces, and those between regions
  std::size_t alignedFaces = 0;     ///< of these: those that quantize() takes for planes
  double alignedArea = 1;           ///< fraction of their area
};

/// @param map  boundary triangles must be perpendicular to axes
/// @param angle  minimum angle between normals at a feature, in radians
/// @param areAligned  whether all features are edges of the map
[[nodiscard]] FoundFeatures featuresOf(const TetMap& map, double angle, bool areAligned,
                                       Stage& stage);

}  // namespace hexhex::shape
