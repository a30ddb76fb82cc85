// Consecutive numbers for sets.
#pragma once

#include <cassert>
#include <cstddef>

#include <hexhex/types.hpp>

#include <base/disjoint_sets.hpp>

namespace hexhex {

struct NumberedSets {
  Array<Index> setOf;  ///< per element: from 0 on, in order of the sets' first elements
  Index count = 0;
};

[[nodiscard]] inline NumberedSets numberSets(DisjointSets& sets, std::size_t elements) {
  NumberedSets result;
  result.setOf.resize(elements);
  for (std::size_t i = 0; i < elements; ++i) {
    const Index first = sets.find(static_cast<Index>(i));
    assert(first <= i);  // so it already has its number
    result.setOf[i] = first == i ? result.count++ : result.setOf[first];
  }
  return result;
}

}  // namespace hexhex
