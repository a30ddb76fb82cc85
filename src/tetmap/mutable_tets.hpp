// A tet mesh whose edges and tets can be split. What is known of its tets, corners and half-faces
// is carried along by cut.hpp.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <adjacency/edge_fan.hpp>
#include <tetmap/cut.hpp>

#include <hexhex/types.hpp>

#include <base/vector3.hpp>

namespace hexhex::tetmap {

/// Tets that were there before keep their numbers, as one of the parts into which they were split.
class MutableTets {
 public:
  MutableTets() = default;
  /// @param mate  as TetTopology has it
  MutableTets(std::vector<Tet> tets, std::span<const adjacency::HalfFace> mate,
              std::size_t vertexCount);

  [[nodiscard]] std::size_t tetCount() const noexcept { return tets.size(); }
  [[nodiscard]] std::size_t vertexCount() const noexcept { return vertexCount_; }
  [[nodiscard]] bool isBoundary(adjacency::HalfFace h) const noexcept { return mate[h] == kNone; }
  [[nodiscard]] std::uint8_t cornerOf(Index tet, Index vertex) const noexcept {
    return static_cast<std::uint8_t>(adjacency::localCorner(tets[tet], vertex));
  }
  /// An edge by its vertices, of a tet that contains it.
  [[nodiscard]] adjacency::TetEdge edge(Index tet, Index v, Index w) const noexcept {
    return {tet, cornerOf(tet, v), cornerOf(tet, w)};
  }

  /// The edge between two vertices, in a part of a tet of which it was once an edge; or the vertex
  /// that has split it.
  struct Found {
    std::optional<adjacency::TetEdge> edge;
    Index middle = kNone;
  };
  [[nodiscard]] Found find(Index v, Index w, Index tet) const;

  /// Calls visit(edge) for all parts of what was once an edge of a tet. They must not be split
  /// meanwhile, but other edges may.
  template <class Visit>
  void forEachPart(Index v, Index w, Index tet, const Visit& visit) {
    const Found found = find(v, w, tet);
    if (found.edge) {
      visit(*found.edge);
    } else {
      forEachPart(v, found.middle, tet, visit);
      forEachPart(found.middle, w, tet, visit);
    }
  }

  /// Splits an edge, and the tets at it, in ascending order; it may not have been split before.
  /// @return the cuts; the new vertex is the last one
  std::vector<Cut> splitEdge(const EdgeInTet& at);
  /// Splits an edge.
  /// @param around  all tets at it, from the same vertex to the same: cut in this order
  std::vector<Cut> splitEdge(std::span<const adjacency::TetEdge> around);
  /// Puts a vertex into a tet, the last one then.
  /// @return the parts, each with the tet's corners but for that of its place in the list, which
  ///         is the new vertex; the first keeps the tet's number
  std::array<Index, 4> splitTet(Index tet);

  /// Leaves what is asked of a mesh that will not be split again, without room to grow.
  void shrink();

  std::vector<Tet> tets;
  std::vector<adjacency::HalfFace> mate;

 private:
  struct Part {
    Index tet;
    Index next;                 ///< another part, in `parts_`, of the same tet, or kNone
    Index kept, given, middle;  ///< the edge that was split: its end here, that there, its middle
  };
  void addPart(Index tet, Part part);
  void join(adjacency::HalfFace a, adjacency::HalfFace b) {
    mate[a] = b;
    mate[b] = a;
  }

  std::size_t vertexCount_ = 0;
  std::vector<Part> parts_;
  std::vector<Index> firstPart_;  ///< per tet
};

/// Splits edges in their middles, the longest first, which keeps tets round.
/// @param mate   as TetTopology has it
/// @param edges  each once or more
/// @param carry  carry(edge, middle, cuts), after each of them
/// @return `mate` afterwards
template <class Carry>
std::vector<adjacency::HalfFace> splitLongestFirst(TetMesh& mesh,
                                                   std::span<const adjacency::HalfFace> mate,
                                                   std::vector<EdgeInTet> edges,
                                                   const Carry& carry) {
  sortUnique(edges);
  const auto squaredLength = [&mesh](const EdgeInTet& edge) {
    const Vec3 d = minus(mesh.points[edge.vertices[1]], mesh.points[edge.vertices[0]]);
    return dot(d, d);
  };
  std::stable_sort(edges.begin(), edges.end(), [&](const EdgeInTet& a, const EdgeInTet& b) {
    return squaredLength(a) > squaredLength(b);
  });
  MutableTets tets(std::move(mesh.tets), mate, mesh.points.size());
  for (const EdgeInTet& edge : edges) {
    const auto [v, w] = edge.vertices;
    const auto middle = static_cast<Index>(mesh.points.size());
    mesh.points.push_back(middleOf(mesh.points[v], mesh.points[w]));
    carry(edge.vertices, middle, tets.splitEdge(edge));
  }
  mesh.tets = std::move(tets.tets);
  return std::move(tets.mate);
}

}  // namespace hexhex::tetmap
