// A canonical order of tets and corners, so that results do not depend on the input's order.
#pragma once

#include <vector>

#include <hexhex/error.hpp>
#include <hexhex/types.hpp>

namespace hexhex::quantization {

/// @param map  vertices of tets must be in range
/// @param[out] order  the caller's number of each sorted tet
[[nodiscard]] TetMap inCanonicalOrder(const TetMapView& map, std::vector<Index>& order);

/// Translates the place of an error from the sorted map to the caller's numbers.
[[nodiscard]] Error inCallersTerms(const Error& error, const TetMapView& map,
                                   const std::vector<Index>& order);

/// Restores the caller's order of tets; tets added by splits stay behind the others.
void restoreOrder(const std::vector<Index>& order, TetMap& map);

}  // namespace hexhex::quantization
