// Edges of an object, and which of them are edges of its map.
#pragma once

#include <cstddef>
#include <vector>

#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex::shape {

struct FoundFeatures {
  std::size_t count = 0;  ///< edges of the tet mesh where its surface turns
  std::vector<FeatureEdge>
      aligned;                 ///< those between triangles of the map on different axes, ascending
  std::size_t innerFaces = 0;  ///< with a tag, or between regions
  std::size_t alignedFaces = 0;  ///< of these: those that quantize() takes for planes
  double alignedArea = 1;        ///< their share of the area
};

/// @param map    whose boundary triangles are perpendicular to axes
/// @param angle  in radians, that the surface turns by at a feature
/// @param areAligned  whether all are edges of the map
[[nodiscard]] FoundFeatures featuresOf(const TetMap& map, double angle, bool areAligned,
                                       Stage& stage);

}  // namespace hexhex::shape
