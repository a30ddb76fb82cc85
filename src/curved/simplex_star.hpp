// Simplices of tets: who owns them, and all tets around one, each with a frame carried to it.
#pragma once

#include <array>
#include <vector>

#include <adjacency/key_table.hpp>
#include <adjacency/tet_topology.hpp>

#include <curved/frame.hpp>
#include <igm/exact_map.hpp>

namespace hexhex {

/// A simplex by the smallest tet that contains it.
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

/// A simplex as one of the tets around it sees it.
struct SimplexInTet {
  Index tet = kNone;
  CornerMask simplex = kNoSimplex;
  Frame frame;
};

/// Crosses a face that is not on the boundary and contains the simplex; a whole tet becomes the
/// whole neighbour.
[[nodiscard]] inline SimplexInTet crossed(const TetTopology& topology, const ExactMap& map,
                                          const SimplexInTet& from, int face) {
  const HalfFace halfFace = halfFaceOf(from.tet, face);
  const Index next = tetOf(topology.mate[halfFace]);
  SimplexInTet to{next, kWholeTet, from.frame};
  if (from.simplex != kWholeTet) to.simplex = acrossFace(topology, halfFace, from.simplex);
  to.frame.cross(map.transitions, halfFace);
  return to;
}

/// Walks around simplices; one per thread.
class SimplexStar {
 public:
  SimplexStar(const TetTopology& topology, const ExactMap& map) : topology_(topology), map_(map) {}

  /// Visits all tets around a simplex, breadth first through faces, from a tet at it. What the
  /// frame shows must be the same after a walk around the simplex: the line that a hex edge lies
  /// on if it contains a point of the simplex, the plane of a hex face if its interior does.
  /// @param visit  of a SimplexInTet; returns true to stop there
  /// @return whether it was stopped
  template <class Visit>
  bool visit(const SimplexInTet& start, const Visit& visit) {
    if (visit(start)) return true;
    switch (dimension(start.simplex)) {
      case 3:
        return false;
      case 2: {
        const int face = oppositeCorner(start.simplex);
        if (topology_.mate[halfFaceOf(start.tet, face)] == kNone) return false;
        return visit(crossed(topology_, map_, start, face));
      }
      case 1:
        return visitAroundEdge(start, visit);
      default:
        return visitAroundVertex(start, visit);
    }
  }

 private:
  /// One step in one direction, one in the other, until they meet.
  template <class Visit>
  bool visitAroundEdge(const SimplexInTet& start, const Visit& visit) const {
    struct Side {
      EdgeTurn turn;
      Frame frame;
      bool goesOn = true;
    };
    const int first = otherFaceAtEdge(start.simplex, -1);
    const int second = otherFaceAtEdge(start.simplex, first);
    std::array<Side, 2> sides = {
        Side{EdgeTurn(topology_, start.tet, start.simplex, first), start.frame},
        Side{EdgeTurn(topology_, start.tet, start.simplex, second), start.frame}};
    while (sides[0].goesOn || sides[1].goesOn) {
      for (std::size_t i = 0; i < 2; ++i) {
        Side& side = sides[i];
        const HalfFace next = side.turn.next();
        side.goesOn = side.goesOn && next != kNone && tetOf(next) != start.tet &&
                      tetOf(next) != sides[1 - i].turn.tet();
        if (!side.goesOn) continue;
        side.frame.cross(map_.transitions, side.turn.out());
        side.turn.step();
        if (visit(SimplexInTet{side.turn.tet(), side.turn.edge(), side.frame})) return true;
      }
    }
    return false;
  }

  template <class Visit>
  bool visitAroundVertex(const SimplexInTet& start, const Visit& visit) {
    seen_.clear();
    members_.assign(1, start);
    seen_.insert(start.tet);
    for (std::size_t head = 0; head < members_.size(); ++head) {
      const SimplexInTet here = members_[head];
      for (int face = 0; face < 4; ++face) {
        if (contains(here.simplex, face)) continue;
        const HalfFace mate = topology_.mate[halfFaceOf(here.tet, face)];
        if (mate == kNone || seen_.insert(tetOf(mate)) < members_.size()) continue;
        members_.push_back(crossed(topology_, map_, here, face));
        const SimplexInTet next = members_.back();
        if (visit(next)) return true;
      }
    }
    return false;
  }

  const TetTopology& topology_;
  const ExactMap& map_;
  KeyTable seen_;
  std::vector<SimplexInTet> members_;
};

}  // namespace hexhex
