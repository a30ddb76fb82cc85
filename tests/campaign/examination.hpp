// What must hold for every map of a campaign.
#pragma once

#include <filesystem>
#include <string>

#include "campaign/block_map.hpp"

namespace hexhex::campaign {

struct ExaminedSizes {
  std::uint64_t tets = 0;
  std::uint64_t cells = 0;
  bool isQuantized = false;       ///< the map was quantized, too
  std::string notQuantized = {};  ///< why it could not be
  double quantizationSeconds = 0;
};

/// Extracts a map in all ways, which must agree in every bit with each other and with its answer,
/// verifies the mesh, and sends both through files. Draws the scale, formats and numbers of
/// threads.
/// @param quantizedOneIn  so many maps; 0 for none
/// @param folder  for files
/// @throws std::exception  at the first disagreement, also as a failed expectation of GoogleTest
ExaminedSizes examine(const DrawnMap& drawn, Random& random, std::uint64_t quantizedOneIn,
                      const std::filesystem::path& folder);

}  // namespace hexhex::campaign
