// How many random cases tests draw: HEXHEX_TEST_EFFORT times as many as usual; builds with
// sanitizers set 0.05 or the like.
#pragma once

#include <algorithm>
#include <cstdlib>

#include <gtest/gtest.h>

namespace hexhex::test {

inline double effort() {
  const char* const factor = std::getenv("HEXHEX_TEST_EFFORT");
  return factor == nullptr ? 1.0 : std::atof(factor);
}

/// @return count times the effort, but at least 1
inline int cases(int count) { return std::max(1, static_cast<int>(count * effort())); }

/// For tests that take long to call what others call, or differ from others by size alone: at
/// efforts this small they are left out.
constexpr double kEffortOfLargeTests = 0.1;

}  // namespace hexhex::test

/// The first line of such a test.
#define HEXHEX_LARGE_TEST()                                           \
  if (::hexhex::test::effort() < ::hexhex::test::kEffortOfLargeTests) \
  GTEST_SKIP() << "skipped: large, and HEXHEX_TEST_EFFORT is small"
