// The order of a tet's vertices. Two tets that share a face list its vertices in any order; in
// ascending order, they agree.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include <hexhex/types.hpp>

namespace hexhex::adjacency {

/// A number below kCornerOrders for each order of a tet's four distinct vertices: which corner has
/// the smallest, and so on.
using CornerOrder = std::uint8_t;
inline constexpr std::size_t kCornerOrders = 32;

[[nodiscard]] constexpr CornerOrder cornerOrder(const Tet& tet) noexcept {
  const unsigned is1Below0 = tet[1] < tet[0] ? 1 : 0;
  const unsigned rank0 = is1Below0 + (tet[2] < tet[0] ? 1 : 0) + (tet[3] < tet[0] ? 1 : 0);
  const unsigned above1 = is1Below0 + (tet[1] < tet[2] ? 1 : 0) + (tet[1] < tet[3] ? 1 : 0);
  return static_cast<CornerOrder>(rank0 + 4 * above1 + (tet[3] < tet[2] ? 16 : 0));
}

/// One T per order, made by make(tet) from a tet with that order.
template <class T, class F>
[[nodiscard]] constexpr std::array<T, kCornerOrders> byCornerOrder(const F& make) {
  std::array<T, kCornerOrders> table{};
  Tet tet = {0, 1, 2, 3};
  do {
    table[cornerOrder(tet)] = make(tet);
  } while (std::next_permutation(tet.begin(), tet.end()));
  return table;
}

/// Per order: the corners in ascending order of vertices.
inline constexpr auto kAscendingCorners =
    byCornerOrder<std::array<std::uint8_t, 4>>([](const Tet& tet) {
      std::array<std::uint8_t, 4> corners{0, 1, 2, 3};
      std::sort(corners.begin(), corners.end(),
                [&tet](std::uint8_t a, std::uint8_t b) { return tet[a] < tet[b]; });
      return corners;
    });

/// Per order, and per local number of a face: the face's corners in ascending order of vertices.
inline constexpr auto kAscendingFaceCorners =
    byCornerOrder<std::array<std::array<std::uint8_t, 3>, 4>>([](const Tet& tet) {
      std::array<std::array<std::uint8_t, 3>, 4> corners{};
      for (std::size_t face = 0; face < 4; ++face) {
        std::size_t rank = 0;
        for (const std::uint8_t corner : kAscendingCorners[cornerOrder(tet)]) {
          if (corner != face) corners[face][rank++] = corner;
        }
      }
      return corners;
    });

}  // namespace hexhex::adjacency
