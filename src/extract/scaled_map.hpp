// The steps of an extraction, for those who go on with the map.
#pragma once

#include <cstdint>
#include <functional>

#include <hexhex/extract.hpp>

#include <map/prepare.hpp>

namespace hexhex {

/// A map that is ready for either engine.
struct ScaledMap {
  PreparedMap map;
  std::uint64_t expectedCells = 0;
};

struct ScaleLimits {
  int furtherScale = 1;  ///< the map is going to be scaled by this again
  double cells = kNone;  ///< the mesh has fewer cells
};

/// Prepares a map and scales it.
/// @throws Error  for every violated condition; TooLarge
[[nodiscard]] ScaledMap prepareScaled(const TetMapView& map, const ExtractOptions& options,
                                      const ScaleLimits& limits, Context& context,
                                      ExtractStatistics& statistics);

/// Extracts with the engine of the options.
[[nodiscard]] HexMesh extractScaled(ScaledMap& scaled, const ExtractOptions& options,
                                    Context& context, ExtractStatistics& statistics);

/// Runs work with the context's threads; translates what may escape from it, and notes the time.
/// @param statistics  filled if not null
void runExtraction(const ExtractOptions& options, Context& context, ExtractStatistics* statistics,
                   const std::function<void(ExtractStatistics&)>& work);

}  // namespace hexhex
