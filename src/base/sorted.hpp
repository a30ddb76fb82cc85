// Sorted lists: those of vertices do not depend on who lists them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include <hexhex/types.hpp>

namespace hexhex {

/// Ascending.
template <std::size_t n>
[[nodiscard]] std::array<Index, n> sorted(std::array<Index, n> vertices) {
  std::sort(vertices.begin(), vertices.end());
  return vertices;
}

/// Sorts a list and removes duplicates.
template <class List>
void sortUnique(List& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

}  // namespace hexhex
