// What keeps the worst cell of a mesh from being better.
#pragma once

#include <hexhex/improve.hpp>

#include <improve/moving.hpp>
#include <improve/vertex_places.hpp>

namespace hexhex::improvement {

/// @param report  knows `after` and `cannotBePositive`
[[nodiscard]] WorstCell worstCell(const Subject& subject, const Boundary& boundary,
                                  const VertexPlaces& places, const ImproveReport& report);

}  // namespace hexhex::improvement
