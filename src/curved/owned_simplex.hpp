// Simplices by the smallest tet that contains them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include <adjacency/tet_topology.hpp>

namespace hexhex {

struct OwnedSimplex {
  Index tet;
  CornerMask corners;
};

/// A face of a tet, by its owner.
[[nodiscard]] inline OwnedSimplex ownedFace(const TetTopology& topology, Index tet, int face) {
  const HalfFace mate = topology.mate[halfFaceOf(tet, face)];
  if (mate == kNone || tet < tetOf(mate)) return {tet, faceMask(face)};
  return {tetOf(mate), faceMask(localOf(mate))};
}

/// A simplex of a tet, by its owner.
[[nodiscard]] inline OwnedSimplex ownedBy(const TetTopology& topology, Index tet,
                                          CornerMask simplex) {
  if (simplex == kWholeTet) return {tet, simplex};
  if (dimension(simplex) == 2) return ownedFace(topology, tet, oppositeCorner(simplex));
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

/// Tells a simplex of less than four corners from others that are given by their owners.
class SimplexMatcher {
 public:
  SimplexMatcher(const TetTopology& topology, Index tet, CornerMask simplex)
      : topology_(topology), isFace_(dimension(simplex) == 2) {
    // The owner of an edge is found by a walk around it only, so edges are known by their vertices.
    if (isFace_) {
      face_ = ownedFace(topology, tet, oppositeCorner(simplex));
    } else {
      vertices_ = verticesOf(topology.tets[tet], simplex);
    }
  }

  [[nodiscard]] bool operator()(const OwnedSimplex& other) const {
    if (isFace_) return other.tet == face_.tet && other.corners == face_.corners;
    const SimplexVertices v = verticesOf(topology_.tets[other.tet], other.corners);
    // Unlike ==, which compares memory, this takes no call.
    return v[0] == vertices_[0] && v[1] == vertices_[1] && v[2] == vertices_[2];
  }

 private:
  const TetTopology& topology_;
  bool isFace_;
  OwnedSimplex face_{};
  SimplexVertices vertices_{};
};

}  // namespace hexhex
