// The tets around an edge: the one walk from tet to tet, and a table of all edges.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <adjacency/tet_topology.hpp>

namespace hexhex::adjacency {

/// The face through which a walk around the edge (two corners) leaves a tet that it entered through
/// face `entered`: the other face at the edge; with -1, the first.
[[nodiscard]] constexpr int otherFaceAtEdge(lattice::CornerMask edge, int entered) noexcept {
  for (int face = 0; face < 4; ++face) {
    if (!lattice::contains(edge, face) && face != entered) return face;
  }
  return entered;
}

/// A walk from tet to tet around an edge.
/// @tparam Mesh  has `tets` and, per half-face, `mate`, as TetTopology does
template <class Mesh>
class EdgeTurn {
 public:
  /// @param edge  two corners of the tet
  /// @param face  at the edge, through which the walk goes first
  EdgeTurn(const Mesh& mesh, Index tet, lattice::CornerMask edge, int face) noexcept
      : mesh_(mesh),
        tet_(tet),
        edge_(edge),
        out_(halfFaceOf(tet, face)),
        vertexAhead_(mesh.tets[tet][ahead()]) {
    assert(lattice::dimension(edge) == 1 && !lattice::contains(edge, face));
  }

  [[nodiscard]] Index tet() const noexcept { return tet_; }
  /// The edge, as corners of the tet.
  [[nodiscard]] lattice::CornerMask edge() const noexcept { return edge_; }
  /// The half-face through which the walk leaves the tet.
  [[nodiscard]] HalfFace out() const noexcept { return out_; }
  /// The corner of that face that is not on the edge.
  [[nodiscard]] std::size_t ahead() const noexcept {
    return static_cast<std::size_t>(otherFaceAtEdge(edge_, localOf(out_)));
  }
  /// The same half-face in the next tet, or kNone.
  [[nodiscard]] HalfFace next() const noexcept { return mesh_.mate[out_]; }

  /// Enters the next tet, which must exist.
  void step() noexcept {
    const HalfFace in = next();
    assert(in != kNone);
    tet_ = tetOf(in);
    // The third corner of the face behind is opposite the face ahead.
    const auto opposite = static_cast<int>(localCorner(mesh_.tets[tet_], vertexAhead_));
    edge_ = static_cast<lattice::CornerMask>(lattice::kWholeTet ^ lattice::cornerBit(opposite) ^
                                             lattice::cornerBit(localOf(in)));
    vertexAhead_ = mesh_.tets[tet_][static_cast<std::size_t>(localOf(in))];
    out_ = halfFaceOf(tet_, opposite);
  }

  /// Goes on to the boundary or, if the edge is inside, once around.
  /// @return whether it is at the boundary
  bool goToBoundary() noexcept {
    const Index start = tet_;
    while (next() != kNone) {
      step();
      if (tet_ == start) return false;
    }
    return true;
  }

 private:
  const Mesh& mesh_;
  Index tet_;
  lattice::CornerMask edge_;
  HalfFace out_;
  Index vertexAhead_;
};

/// Calls visit(turn, value) for the other tets around an edge, in one direction and, if that ends
/// at the boundary, in the other, until it returns false.
/// @param start  the value in the first tet: a chart, say
/// @param carry  carry(value, half-face): the value beyond
/// @return the value after a full turn; nothing without one
template <class Mesh, class T, class Carry, class Visit>
std::optional<T> visitAroundEdge(const Mesh& mesh, Index tet, lattice::CornerMask edge, T start,
                                 const Carry& carry, const Visit& visit) {
  const int first = otherFaceAtEdge(edge, -1);
  for (const int face : {first, otherFaceAtEdge(edge, first)}) {
    EdgeTurn turn(mesh, tet, edge, face);
    T value = start;
    while (turn.next() != kNone) {
      value = carry(value, turn.out());
      turn.step();
      if (turn.tet() == tet) return value;
      if (!visit(turn, value)) return std::nullopt;
    }
  }
  return std::nullopt;
}

/// All tets at an edge, ascending.
template <class Mesh>
std::vector<Index> tetsAround(const Mesh& mesh, Index tet, lattice::CornerMask edge) {
  std::vector<Index> tets = {tet};
  visitAroundEdge(
      mesh, tet, edge, 0, [](int nothing, HalfFace /*out*/) { return nothing; },
      [&tets](const auto& turn, int /*nothing*/) {
        tets.push_back(turn.tet());
        return true;
      });
  std::sort(tets.begin(), tets.end());
  return tets;
}

/// The edges of a tet mesh, each with the tets around it in ascending order.
class EdgeFans {
 public:
  /// @param topology  with stars; must outlive this
  explicit EdgeFans(const TetTopology& topology);

  [[nodiscard]] std::size_t size() const noexcept { return begin_.size() - 1; }
  [[nodiscard]] std::span<const EdgeCorner> operator()(std::size_t edge) const noexcept {
    return std::span(corners_).subspan(begin_[edge], begin_[edge + 1] - begin_[edge]);
  }
  /// The edge between two corners of a tet.
  [[nodiscard]] Index edgeOf(Index tet, lattice::CornerMask ends) const noexcept;
  [[nodiscard]] Index edgeOf(const TetEdge& at) const noexcept { return edgeOf(at.tet, at.mask()); }
  [[nodiscard]] bool isBoundary(std::size_t edge) const noexcept {
    return boundaryFacesAt(topology_, (*this)(edge)) != 0;
  }

 private:
  const TetTopology& topology_;
  std::vector<std::size_t> begin_ = {0};
  std::vector<EdgeCorner> corners_;
  std::vector<std::array<Index, 6>> edges_;  ///< per tet
};

}  // namespace hexhex::adjacency
