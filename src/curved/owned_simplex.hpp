// Simplices by the smallest tet that contains them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include <map/tet_topology.hpp>

namespace hexhex {

struct OwnedSimplex {
  Index tet;
  CornerMask corners;
};

/// A simplex of a tet, by its owner.
[[nodiscard]] inline OwnedSimplex ownedBy(const TetTopology& topology, Index tet,
                                          CornerMask simplex) {
  const Index owner = ownerTet(topology, tet, simplex);
  return {owner, owner == tet ? simplex : topology.translated(simplex, tet, owner)};
}

/// The vertices of a simplex of less than four, ascending; kNone behind them.
using SimplexVertices = std::array<Index, 3>;

[[nodiscard]] inline SimplexVertices verticesOf(const Tet& tet, CornerMask simplex) noexcept {
  // Without branches, as the order of vertices is as good as random.
  std::array<Index, 4> found{};
  std::size_t count = 0;
  for (int i = 0; i < 4; ++i) {
    found[count] = tet[static_cast<std::size_t>(i)];
    count += contains(simplex, i) ? 1 : 0;
  }
  const Index a = found[0];
  const Index b = count > 1 ? found[1] : kNone;
  const Index c = count > 2 ? found[2] : kNone;
  const Index low = std::min(a, b);
  const Index high = std::max(a, b);
  return {std::min(low, c), std::max(low, std::min(high, c)), std::max(high, c)};
}

/// Whether two simplices are the same; unlike ==, which compares memory, this takes no call.
[[nodiscard]] inline bool sameVertices(const SimplexVertices& a,
                                       const SimplexVertices& b) noexcept {
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

}  // namespace hexhex
