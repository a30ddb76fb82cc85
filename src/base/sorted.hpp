// The vertices of an edge, a face or a cell in an order that does not depend on who lists them.
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

}  // namespace hexhex
