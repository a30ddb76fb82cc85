// The map of the comparisons, prepared and scaled.
#pragma once

#include <array>

#include <igm/igm.hpp>

#include "bench_maps.hpp"

namespace hexhex::bench {

/// Cells grow with the cube.
inline constexpr std::array<int, 6> kScales = {1, 2, 4, 6, 8, 12};

/// sphereMap() as the extraction sees it after preprocessing. The last one stays in memory; the
/// reference is valid until the next call with another scale.
[[nodiscard]] const igm::PreparedMap& scaledMap(int scale);

}  // namespace hexhex::bench
