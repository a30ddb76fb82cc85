// Along which coordinates the vertices of a patch may move: the constraints of Section 5.1.3, read
// off the patch's own charts.
#pragma once

#include <vector>

#include <hexhex/types.hpp>

#include <repair/patch_charts.hpp>

namespace hexhex {

/// A vertex of a patch. Its parameter in the chart of its first corner stands for all.
struct PatchVertex {
  Index vertex = 0;
  Vec3 parameter{};   ///< in the chart of corners.front(); integers where it is fixed
  AxisSet fixed = 0;  ///< axes of that chart along which it must stay
  bool singular = false;
  bool boundary = false;
  double off = 0;  ///< how far the fixed coordinates were from integers
  struct Copy {
    CornerIndex corner;
    Transition fromFirst;
  };
  std::vector<Copy> corners;  ///< all corners at the vertex
};

/// One entry per vertex of the patch.
[[nodiscard]] std::vector<PatchVertex> findFreedom(const LocalParameters& parameters,
                                                   const Patch& patch, const PatchCharts& charts);

}  // namespace hexhex
