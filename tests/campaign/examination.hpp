// What must hold for every map of a campaign.
#pragma once

#include <filesystem>

#include "campaign/block_map.hpp"

namespace hexhex::campaign {

struct ExaminedSizes {
  std::uint64_t tets = 0;
  std::uint64_t cells = 0;
};

/// Extracts a map in all ways, which must agree in every bit with each other and with its answer,
/// verifies the mesh, and sends both through files. Draws the scale, formats and numbers of
/// threads.
/// @param folder  for files
/// @throws std::exception  at the first disagreement, also as a failed expectation of GoogleTest
ExaminedSizes examine(const DrawnMap& drawn, Random& random, const std::filesystem::path& folder);

}  // namespace hexhex::campaign
