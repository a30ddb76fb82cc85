// Arcs that are to be the same, bit for bit, perhaps in another order.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

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

/// The same arcs in another order.
/// @param order  numbers of all arcs
inline Arcs reordered(const Arcs& arcs, std::span<const Index> order) {
  Arcs result;
  for (const Index arc : order) {
    result.ends.push_back(arcs.ends[arc]);
    result.pointBegin.push_back(result.points.size());
    for (std::uint64_t p = arcs.pointBegin[arc]; p < arcs.pointBegin[arc + 1]; ++p) {
      result.points.push_back(arcs.points[p]);
      result.parameters.push_back(arcs.parameters[p]);
      result.generatorTet.push_back(arcs.generatorTet[p]);
      result.generatorCorners.push_back(arcs.generatorCorners[p]);
    }
    for (std::uint64_t s = arcs.firstSegment(arc); s < arcs.firstSegment(arc + 1); ++s) {
      result.segmentTet.push_back(arcs.segmentTet[s]);
      result.segmentCorners.push_back(arcs.segmentCorners[s]);
    }
  }
  result.pointBegin.push_back(result.points.size());
  return result;
}

/// Numbers of arcs by their ends, then by what they go through: an order that both engines' arcs
/// have in common.
inline std::vector<Index> orderByWay(const Arcs& arcs) {
  std::vector<Index> order(arcs.count());
  std::iota(order.begin(), order.end(), Index{0});
  const auto segments = [&](Index arc) {
    return std::span(arcs.segmentTet)
        .subspan(arcs.firstSegment(arc), arcs.firstSegment(arc + 1) - arcs.firstSegment(arc));
  };
  const auto parameters = [&](Index arc) {
    return std::span(arcs.parameters)
        .subspan(arcs.pointBegin[arc], arcs.pointBegin[arc + 1] - arcs.pointBegin[arc]);
  };
  const auto points = [&](Index arc) {
    return std::span(arcs.points)
        .subspan(arcs.pointBegin[arc], arcs.pointBegin[arc + 1] - arcs.pointBegin[arc]);
  };
  std::sort(order.begin(), order.end(), [&](Index a, Index b) {
    if (arcs.ends[a] != arcs.ends[b]) return arcs.ends[a] < arcs.ends[b];
    if (!std::ranges::equal(segments(a), segments(b))) {
      return std::ranges::lexicographical_compare(segments(a), segments(b));
    }
    if (!std::ranges::equal(parameters(a), parameters(b))) {
      return std::ranges::lexicographical_compare(parameters(a), parameters(b));
    }
    return std::ranges::lexicographical_compare(points(a), points(b));
  });
  return order;
}

inline void expectSameInAnyOrder(const Arcs& a, const Arcs& b) {
  ASSERT_EQ(a.count(), b.count());
  expectSameBits(reordered(a, orderByWay(a)), reordered(b, orderByWay(b)));
}

}  // namespace hexhex::test
