// Simplices by the smallest tet that contains them.
#pragma once

#include <array>
#include <utility>

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
  SimplexVertices vertices = {kNone, kNone, kNone};
  std::size_t count = 0;
  for (int i = 0; i < 4; ++i) {
    if (contains(simplex, i)) vertices[count++] = tet[static_cast<std::size_t>(i)];
  }
  if (vertices[1] < vertices[0]) std::swap(vertices[0], vertices[1]);
  if (vertices[2] < vertices[1]) std::swap(vertices[1], vertices[2]);
  if (vertices[1] < vertices[0]) std::swap(vertices[0], vertices[1]);
  return vertices;
}

/// Whether two simplices are the same; unlike ==, which compares memory, this takes no call.
[[nodiscard]] inline bool sameVertices(const SimplexVertices& a,
                                       const SimplexVertices& b) noexcept {
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

}  // namespace hexhex
