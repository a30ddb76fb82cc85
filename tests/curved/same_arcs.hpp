// Arcs that are to be the same, bit for bit.
#pragma once

#include <gtest/gtest.h>

#include <hexhex/curved.hpp>

namespace hexhex::test {

inline void expectSameBits(const Arcs& a, const Arcs& b) {
  EXPECT_EQ(a.ends, b.ends);
  EXPECT_EQ(a.pointBegin, b.pointBegin);
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.parameters, b.parameters);
  EXPECT_EQ(a.generatorTet, b.generatorTet);
  EXPECT_EQ(a.generatorCorners, b.generatorCorners);
  EXPECT_EQ(a.segmentTet, b.segmentTet);
  EXPECT_EQ(a.segmentCorners, b.segmentCorners);
}

}  // namespace hexhex::test
