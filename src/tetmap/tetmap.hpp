// A tet mesh whose edges and tets can be split. Data attached to its tets, corners and half-faces
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

/// Existing tets keep their numbers, as one of the parts into which they are split.
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

  /// The edge between two vertices, in a part of a tet that once had this edge; or the vertex that
  /// has split it.
  struct Found {
    std::optional<adjacency::TetEdge> edge;
    Index middle = kNone;
  };
  [[nodiscard]] Found find(Index v, Index w, Index tet) const;

  /// Calls visit(edge) for all parts of a former edge of a tet. These must not be split meanwhile,
  /// but other edges may.
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

  /// Splits an edge and the tets at it, in ascending order; it must not have been split before.
  /// @return the cuts; the new vertex is the last one
  std::vector<Cut> splitEdge(const EdgeInTet& at);
  /// Splits an edge.
  /// @param around  all tets at it, with its vertices in the same order; they are cut in this order
  std::vector<Cut> splitEdge(std::span<const adjacency::TetEdge> around);
  /// Inserts a vertex into a tet; it becomes the last one.
  /// @return the parts: in each, the new vertex takes the place of the corner of the same number;
  ///         the first keeps the tet's number
  std::array<Index, 4> splitTet(Index tet);

  /// Keeps only what a mesh needs that will not be split again, without room to grow.
  void shrink();

  std::vector<Tet> tets;
  std::vector<adjacency::HalfFace> mate;

 private:
  struct Part {
    Index tet;
    Index next;                 ///< another part of the same tet, in `parts_`, or kNone
    Index kept, given, middle;  ///< the edge that was split: its end here, that there, its midpoint
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

/// Splits edges at their midpoints, the longest first, which keeps tets round.
/// @param mate   as TetTopology has it
/// @param edges  may occur repeatedly
/// @param carry  carry(edge, middle, cuts), called after each split
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
