// Finds what limits the quality of the worst cell of a mesh.
#pragma once

#include <hexhex/improve.hpp>

#include <improve/moving.hpp>
#include <improve/vertex_places.hpp>

namespace hexhex::improvement {

/// @param report  with `after` and `cannotBePositive`
[[nodiscard]] WorstCell worstCell(const Subject& subject, const Boundary& boundary,
                                  const VertexPlaces& places, const ImproveReport& report);

}  // namespace hexhex::improvement
