// A map with tets and corners in an order that depends on vertices alone: so that the outcome does
// not depend on the caller's.
#pragma once

#include <vector>

#include <hexhex/error.hpp>
#include <hexhex/types.hpp>

namespace hexhex::quantization {

/// @param map  whose tets name points that exist
/// @param[out] order  whose number each tet had
[[nodiscard]] TetMap inCanonicalOrder(const TetMapView& map, std::vector<Index>& order);

/// An error that names a tet of the sorted map, by the caller's number.
[[nodiscard]] Error inCallersTerms(const Error& error, const TetMapView& map,
                                   const std::vector<Index>& order);

/// Gives tets the caller's numbers; parts that were split off come behind.
void restoreOrder(const std::vector<Index>& order, TetMap& map);

}  // namespace hexhex::quantization
