// Which sharp edges of a mesh's own boundary are creases of the object.
//
// Where cells are bad, the boundary is folded and jagged, and turns by any angle. Angles count
// beside quads that are not folded; edges form chains, which go on over folds where they are
// straight; and what soon ends at bad cells is no crease.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <improve/reference_surface.hpp>

namespace hexhex::improvement {

/// @param parts   with triangles two by two, those of one quad; without `sharp`
/// @param isAtBad  per point: 1 if a cell there is not positive
/// @return edges, each ascending and all of them, too; without those that are curves anyway
[[nodiscard]] std::vector<std::array<Index, 2>> creaseChains(const SurfaceParts& parts,
                                                             std::span<const std::uint8_t> isAtBad,
                                                             Stage& stage);

}  // namespace hexhex::improvement
