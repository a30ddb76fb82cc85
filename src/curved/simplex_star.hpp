// All tets around a simplex, each with a frame carried to it.
#pragma once

#include <vector>

#include <curved/frame.hpp>

#include <map/exact_map.hpp>
#include <map/key_table.hpp>
#include <map/tet_topology.hpp>

namespace hexhex {

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
  if (from.simplex != kWholeTet) to.simplex = topology.translated(from.simplex, from.tet, next);
  if (map.transitions.isJump(halfFace)) {
    to.frame = from.frame.carried(map.transitions.across(halfFace));
  }
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
    if (start.simplex == kWholeTet) return false;
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

 private:
  const TetTopology& topology_;
  const ExactMap& map_;
  KeyTable seen_;
  std::vector<SimplexInTet> members_;
};

}  // namespace hexhex
