// A tet cut in two at the midpoint of an edge, and what becomes of the data attached to it.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include <adjacency/tet_topology.hpp>

#include <hexhex/types.hpp>

#include <base/sorted.hpp>

namespace hexhex::tetmap {

/// The vertices of an edge, in ascending order.
using VertexPair = std::array<Index, 2>;
[[nodiscard]] constexpr VertexPair pairOf(Index a, Index b) noexcept {
  return a < b ? VertexPair{a, b} : VertexPair{b, a};
}

/// An edge to be split, and a tet that has it.
struct EdgeInTet {
  VertexPair vertices;
  Index tet;

  friend bool operator<(const EdgeInTet& a, const EdgeInTet& b) noexcept {
    return a.vertices < b.vertices;
  }
  /// The same edge, whatever the tets.
  friend bool operator==(const EdgeInTet& a, const EdgeInTet& b) noexcept {
    return a.vertices == b.vertices;
  }
};

/// An edge by its vertices, of a tet that contains it.
[[nodiscard]] inline adjacency::TetEdge edgeOf(const std::vector<Tet>& tets, Index tet,
                                               const VertexPair& edge) noexcept {
  return {tet, static_cast<std::uint8_t>(adjacency::localCorner(tets[tet], edge[0])),
          static_cast<std::uint8_t>(adjacency::localCorner(tets[tet], edge[1]))};
}

/// The first part keeps the tet's number and all corners except b; the second part is appended, and
/// has all except a. The new vertex takes their places.
struct Cut {
  Index first;
  Index second;
  std::size_t a;
  std::size_t b;
};

inline Cut cutTet(std::vector<Tet>& tets, const adjacency::TetEdge& edge, Index middle) {
  const Cut cut{edge.tet, static_cast<Index>(tets.size()), edge.corner0, edge.corner1};
  const Tet whole = tets[cut.first];
  tets.push_back(whole);
  tets[cut.first][cut.b] = tets[cut.second][cut.a] = middle;
  return cut;
}

[[nodiscard]] inline Vec3 middleOf(const Vec3& a, const Vec3& b) noexcept {
  return {0.5 * a[0] + 0.5 * b[0], 0.5 * a[1] + 0.5 * b[1], 0.5 * a[2] + 0.5 * b[2]};
}

/// A value per tet: both parts have it. Empty lists stay empty, here and below.
template <class T>
void carryTet(const Cut& cut, std::vector<T>& ofTets) {
  if (ofTets.empty()) return;
  const T value = ofTets[cut.first];
  ofTets.push_back(value);
}

/// A value per corner.
/// @param middle  at the new vertex
template <class T>
void carryCorners(const Cut& cut, const T& middle, std::vector<std::array<T, 4>>& ofTets) {
  carryTet(cut, ofTets);
  ofTets[cut.first][cut.b] = ofTets[cut.second][cut.a] = middle;
}
/// Points: the new vertex gets the midpoint.
inline void carryCorners(const Cut& cut, std::vector<TetParameters>& ofTets) {
  if (ofTets.empty()) return;
  const TetParameters& whole = ofTets[cut.first];
  carryCorners(cut, middleOf(whole[cut.a], whole[cut.b]), ofTets);
}

/// A value per half-face.
/// @param inside  the value between the two parts, on both sides
template <class T>
void carryFaces(const Cut& cut, const T& inside, std::vector<T>& ofHalfFaces) {
  for (std::size_t face = 0; face < 4; ++face) {
    const T value = ofHalfFaces[4 * std::size_t{cut.first} + face];
    ofHalfFaces.push_back(value);
  }
  ofHalfFaces[4 * std::size_t{cut.first} + cut.a] = inside;
  ofHalfFaces[4 * std::size_t{cut.second} + cut.b] = inside;
}
template <class T>
void carryFaces(const Cut& cut, const T& inside, std::vector<std::array<T, 4>>& ofTets) {
  if (ofTets.empty()) return;
  carryTet(cut, ofTets);
  ofTets[cut.first][cut.a] = ofTets[cut.second][cut.b] = inside;
}

/// Calls visit(vertices, corners) for the six edges of a tet.
template <class Visit>
void forEachEdgeOf(const Tet& tet, const Visit& visit) {
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j) {
      visit(pairOf(tet[i], tet[j]), static_cast<lattice::CornerMask>((1U << i) | (1U << j)));
    }
  }
}

}  // namespace hexhex::tetmap
