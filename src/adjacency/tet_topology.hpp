// Adjacency in a tet mesh: half-faces and their mates, stars of vertices, edges.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <adjacency/cell_faces.hpp>
#include <adjacency/corner_order.hpp>
#include <adjacency/vertex_lists.hpp>

#include <hexhex/types.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <lattice/tet_geometry.hpp>

namespace hexhex::adjacency {

/// Index 4 * tet + corner of a corner of a tet, or of the face opposite that corner (a half-face).
using CornerIndex = std::uint32_t;
using HalfFace = std::uint32_t;

[[nodiscard]] constexpr Index tetOf(HalfFace halfFace) noexcept { return halfFace / 4; }
[[nodiscard]] constexpr int localOf(HalfFace halfFace) noexcept {
  return static_cast<int>(halfFace % 4);
}
[[nodiscard]] constexpr HalfFace halfFaceOf(Index tet, int opposite) noexcept {
  return 4 * tet + static_cast<HalfFace>(opposite);
}

/// Position of a vertex in a tet that contains it: a number of two bits, computed without branches,
/// which could not be predicted.
[[nodiscard]] constexpr Index localCorner(const Tet& tet, Index vertex) noexcept {
  const Index isLast = tet[3] == vertex ? 1 : 0;
  const Index low = (tet[1] == vertex ? 1U : 0U) | isLast;
  const Index high = (tet[2] == vertex ? 1U : 0U) | isLast;
  return low | (high << 1);
}

/// An edge as one of its tets sees it: the corners at its ends.
struct TetEdge {
  Index tet;
  std::uint8_t corner0;
  std::uint8_t corner1;

  [[nodiscard]] constexpr lattice::CornerMask mask() const noexcept {
    return static_cast<lattice::CornerMask>(1U << corner0 | 1U << corner1);
  }
};

struct TetTopology {
  std::span<const Tet> tets;  ///< the caller's array
  std::size_t pointCount = 0;
  Array<HalfFace> mate;      ///< per half-face: the same triangle in the neighbour, or kNone
  Array<Index> vertexTet;    ///< per vertex: the smallest tet at it, or kNone
  Array<CornerOrder> order;  ///< per tet: how its vertices are ordered

  // Empty until addStars().
  VertexLists<CornerIndex> stars;  ///< the corners at each vertex

  [[nodiscard]] std::size_t tetCount() const noexcept { return tets.size(); }
  [[nodiscard]] Index vertex(CornerIndex corner) const noexcept {
    return tets[corner / 4][corner % 4];
  }
  [[nodiscard]] bool isBoundary(HalfFace halfFace) const noexcept {
    return mate[halfFace] == kNone;
  }
  [[nodiscard]] bool isIsolated(Index vertex) const noexcept { return vertexTet[vertex] == kNone; }
  /// Position of a vertex in a tet that contains it.
  [[nodiscard]] int localCorner(Index tet, Index vertex) const noexcept {
    return static_cast<int>(adjacency::localCorner(tets[tet], vertex));
  }
  /// An edge by its vertices, of a tet that contains it.
  [[nodiscard]] TetEdge edge(Index tet, Index v, Index w) const noexcept {
    return {tet, static_cast<std::uint8_t>(localCorner(tet, v)),
            static_cast<std::uint8_t>(localCorner(tet, w))};
  }
  /// The same simplex (given by corners of tet `from`) as corners of tet `to`, which contains it.
  [[nodiscard]] lattice::CornerMask translated(lattice::CornerMask mask, Index from,
                                               Index to) const noexcept {
    lattice::CornerMask result = 0;
    for (int i = 0; i < 4; ++i) {
      if (lattice::contains(mask, i)) {
        result = static_cast<lattice::CornerMask>(
            result | lattice::cornerBit(localCorner(to, tets[from][static_cast<std::size_t>(i)])));
      }
    }
    return result;
  }
  /// Needs addStars().
  [[nodiscard]] std::span<const CornerIndex> star(Index vertex) const noexcept {
    assert(!stars.empty());
    return stars(vertex);
  }
};

/// The corners of a face that two tets share, in both of them. Turns come from a table: with three
/// searches for a corner, extractions of s17c_sphere_r0.1 take 8 % longer.
class SharedFace {
 public:
  SharedFace(const TetTopology& topology, HalfFace here, HalfFace there) noexcept
      : here_(kTurns[here % 4][0]) {
    const Tet& mate = topology.tets[tetOf(there)];
    const Index first = topology.tets[tetOf(here)][here_[0]];
    // The mate has the corners in reverse order: only the first must be found.
    const auto& turns = kTurns[there % 4];
    there_ =
        &turns[3 + (mate[turns[0][1]] == first ? 1U : 0U) + (mate[turns[0][2]] == first ? 2U : 0U)];
  }
  [[nodiscard]] std::size_t here(std::size_t k) const noexcept { return here_[k]; }
  [[nodiscard]] std::size_t there(std::size_t k) const noexcept { return (*there_)[k]; }

 private:
  using Turn = std::array<std::uint8_t, 3>;

  /// Per face: its corners starting from each of them, then the same in reverse order.
  static constexpr std::array<std::array<Turn, 6>, 4> kTurns = [] {
    std::array<std::array<Turn, 6>, 4> turns{};
    for (std::size_t face = 0; face < 4; ++face) {
      for (std::size_t first = 0; first < 3; ++first) {
        for (std::size_t k = 0; k < 3; ++k) {
          const auto corner = [face](std::size_t i) {
            return static_cast<std::uint8_t>(lattice::kFaceCorners[face][i % 3]);
          };
          turns[face][first][k] = corner(first + k);
          turns[face][3 + first][k] = corner(first + 3 - k);
        }
      }
    }
    return turns;
  }();

  const Turn& here_;
  const Turn* there_ = nullptr;
};

/// Values at the corners of an inner face, in both its tets.
template <class Value>
struct SharedCorners {
  std::array<Value, 3> here;
  std::array<Value, 3> there;

  /// @param at  at(tet, corner)
  template <class At>
  SharedCorners(const TetTopology& topology, HalfFace halfFace, const At& at) noexcept {
    const HalfFace mate = topology.mate[halfFace];
    const SharedFace face(topology, halfFace, mate);
    for (std::size_t k = 0; k < 3; ++k) {
      here[k] = at(tetOf(halfFace), face.here(k));
      there[k] = at(tetOf(mate), face.there(k));
    }
  }
};

/// A simplex of a face as the neighbour sees it.
/// @param here  the face, as a half-face that is not on the boundary
[[nodiscard]] inline lattice::CornerMask acrossFace(const TetTopology& topology, HalfFace here,
                                                    lattice::CornerMask simplex) noexcept {
  return topology.translated(simplex, tetOf(here), tetOf(topology.mate[here]));
}

/// Finds the neighbour of each tet across each of its faces: fills `mate`, `vertexTet` and `order`.
/// @return false if a triangle belongs to more than two tets, or if its two tets do not see it with
///         opposite orientation; the result is then only good for a list of defects
[[nodiscard]] bool matchFaces(TetTopology& topology, Stage& stage);

/// The same for tets that should form a manifold.
/// @param tets  must outlive the result
/// @return nothing if they do not
[[nodiscard]] std::optional<TetTopology> manifoldTopology(std::span<const Tet> tets,
                                                          std::size_t pointCount, Stage& stage);

/// Lists the corners at each vertex, unless they are listed already.
void addStars(TetTopology& topology, Stage& stage);

/// Needs addStars().
[[nodiscard]] std::uint64_t countEdges(const TetTopology& topology, Stage& stage);

/// One tet at an edge whose smaller vertex comes first.
struct EdgeCorner : TetEdge {
  Index other;  ///< the edge's larger vertex
};

/// Calls visit(w, span of EdgeCorner) for each edge (v, w), v < w, in ascending order of w, with
/// all tets at the edge in ascending order. Needs addStars().
/// @param scratch  reused between calls
template <class Visit>
void forEachEdge(const TetTopology& topology, Index v, std::vector<EdgeCorner>& scratch,
                 const Visit& visit) {
  scratch.clear();
  for (const CornerIndex corner : topology.star(v)) {
    const Tet& tet = topology.tets[corner / 4];
    for (std::uint8_t i = 0; i < 4; ++i) {
      if (tet[i] > v) {
        scratch.push_back({{corner / 4, static_cast<std::uint8_t>(corner % 4), i}, tet[i]});
      }
    }
  }
  std::sort(scratch.begin(), scratch.end(), [](const EdgeCorner& a, const EdgeCorner& b) {
    return a.other != b.other ? a.other < b.other : a.tet < b.tet;
  });
  forEachRun(
      std::span<const EdgeCorner>(scratch),
      [](const EdgeCorner& a, const EdgeCorner& b) { return a.other == b.other; },
      [&visit](std::span<const EdgeCorner> fan) { visit(fan.front().other, fan); });
}

/// Number of boundary faces among the two faces of each tet at an edge: 0 inside, 2 on the
/// boundary.
[[nodiscard]] std::size_t boundaryFacesAt(const TetTopology& topology,
                                          std::span<const EdgeCorner> fan);

/// The smallest tet that contains a simplex of a tet: the simplex's owner (ParentTet of the paper).
[[nodiscard]] Index ownerTet(const TetTopology& topology, Index tet,
                             lattice::CornerMask simplex) noexcept;

/// Whether that is the tet itself, which is quicker to decide.
[[nodiscard]] bool ownsSimplex(const TetTopology& topology, Index tet,
                               lattice::CornerMask simplex) noexcept;

}  // namespace hexhex::adjacency
