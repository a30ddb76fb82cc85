// Any map that a campaign may draw.
#pragma once

#include "campaign/block_map.hpp"

namespace hexhex::campaign {

[[nodiscard]] DrawnMap drawMap(Random& random);

}  // namespace hexhex::campaign
