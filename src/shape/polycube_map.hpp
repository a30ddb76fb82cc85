// A polycube of an object, and its map.
#pragma once

#include <cstddef>
#include <cstdint>

#include <shape/positive_tets.hpp>
#include <shape/surface.hpp>

#include <hexhex/shape.hpp>

namespace hexhex::shape {

/// Labels of which a map is tried, one after the other, each with a seed of its own.
inline constexpr std::uint64_t kMostAttempts = 6;

/// What may be spent on a part of so many tets: see quantization::mapFromLabels().
[[nodiscard]] double workFor(std::size_t tets);

/// Labels for the boundary, and a map from these.
/// @param workLeft  at which no more labels are tried
/// @param[out] report  rotation, labels and their moves
/// @return with the points that are not given in the object's own position
/// @throws Error NotMeshable, as mapFromTets() does
[[nodiscard]] TetMap polycubeMap(PositiveTets tets, Surface surface, std::uint64_t seed,
                                 double workLeft, ShapeReport& report, Context& context);

}  // namespace hexhex::shape
