// How many random cases tests draw: HEXHEX_TEST_EFFORT times as many as usual; builds with
// sanitizers set 0.05 or the like.
#pragma once

#include <algorithm>
#include <cstdlib>

namespace hexhex::test {

inline double effort() {
  const char* const factor = std::getenv("HEXHEX_TEST_EFFORT");
  return factor == nullptr ? 1.0 : std::atof(factor);
}

/// @return count times the effort, but at least 1
inline int cases(int count) { return std::max(1, static_cast<int>(count * effort())); }

}  // namespace hexhex::test
