// Labels of a polycube that every part has: a prism with as many holes as the part has handles.
#pragma once

#include <optional>

#include <shape/label_costs.hpp>
#include <shape/positive_tets.hpp>

#include <base/stage.hpp>

namespace hexhex::shape {

struct LoopLabels {
  PositiveTets tets;  ///< the given ones, split where loops need room
  Surface surface;
  Labels labels;
};

/// Each component of the boundary becomes a prism along the same axis, the one whose labels fit
/// best. Its faces meet as those of a polycube do; in space, edges between them may turn back.
/// @return nothing if there is no room, though each edge of the boundary was split twice
[[nodiscard]] std::optional<LoopLabels> labelsByLoops(PositiveTets tets, Surface surface,
                                                      Stage& stage);

}  // namespace hexhex::shape
