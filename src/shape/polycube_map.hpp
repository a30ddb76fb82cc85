// A polycube of an object, and its map.
#pragma once

#include <shape/positive_tets.hpp>
#include <shape/surface.hpp>

#include <hexhex/shape.hpp>

namespace hexhex::shape {

/// Labels for the boundary, and a map from these.
/// @param[out] report  rotation, labels and their moves
/// @return with the points that are not given in the object's own position
/// @throws Error NotMeshable, as mapFromTets() does
[[nodiscard]] TetMap polycubeMap(PositiveTets tets, Surface surface, std::uint64_t seed,
                                 ShapeReport& report, Context& context);

}  // namespace hexhex::shape
