// Labels an object as a polycube, and maps it.
#pragma once

#include <cstddef>
#include <cstdint>

#include <shape/positive_tets.hpp>
#include <shape/surface.hpp>

#include <hexhex/shape.hpp>

namespace hexhex::shape {

/// Maximum number of labellings to try, each with its own seed.
inline constexpr std::uint64_t kMostAttempts = 8;

/// The budget for a part with this many tets, as in quantization::mapFromLabels().
[[nodiscard]] double workFor(std::size_t tets);

/// Labels the boundary and makes a map from the labels.
/// @param workLeft  budget; no further labelling starts once it is used up
/// @param[out] report  rotation, labels and number of moves
/// @return a map; vertices added to the mesh are in the object's own position
/// @throws Error NotMeshable, as mapFromTets() does
[[nodiscard]] TetMap polycubeMap(PositiveTets tets, Surface surface, std::uint64_t seed,
                                 double workLeft, ShapeReport& report, Context& context);

}  // namespace hexhex::shape
