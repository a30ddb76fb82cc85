// Decides which sharp edges of a mesh's own boundary are creases of the object.
//
// At bad cells, the boundary is folded and jagged, and turns by any angle. So angles only count
// beside quads that are not folded; edges form chains, which continue straight across folds; and
// short chains that touch bad cells are no creases.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <improve/reference_surface.hpp>

namespace hexhex::improvement {

/// @param parts    with two consecutive triangles per quad, which form a group; without `sharp`
/// @param isAtBad  per point: 1 if a cell there is not positive
/// @return the creases, sorted, each with ascending vertices; without edges that are curves anyway
[[nodiscard]] std::vector<std::array<Index, 2>> creaseChains(const SurfaceParts& parts,
                                                             std::span<const std::uint8_t> isAtBad,
                                                             Stage& stage);

}  // namespace hexhex::improvement
