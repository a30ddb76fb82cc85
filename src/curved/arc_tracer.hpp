// Hex edges on their way from simplex to simplex.
#pragma once

#include <array>
#include <utility>

#include <curved/face_walk.hpp>
#include <curved/lattice_numbers.hpp>
#include <curved/simplex_point.hpp>
#include <curved/simplex_star.hpp>
#include <igm/prepare.hpp>

namespace hexhex {

/// Where a hex edge ends.
struct ArcEnd {
  SimplexInTet carrier;  ///< of its last part
  Index vertex;
};

/// Follows hex edges. One per thread. Frames have the edge along their first axis.
///
/// A hex edge is straight in every tet, so inside a closed tet it stays in one simplex from where
/// it enters to where it leaves.
class ArcTracer {
 public:
  ArcTracer(const PreparedMap& map, const LatticeNumbers& vertices)
      : map_(map),
        exact_(map.exact),
        topology_(map.topology),
        vertices_(vertices),
        beginnings_{Beginning(map), Beginning(map)},
        star_(map.topology, map.exact) {}

  /// The carrier of the part of the edge (the simplex that holds it) behind a point of it that
  /// lies in the interior of a simplex.
  [[nodiscard]] SimplexInTet behind(const SimplexInTet& point);

  /// Goes on to the last part, the one that ends at coordinate 1 of the frame.
  /// @param at     the carrier of a part that does not end there
  /// @param visit  called with the carrier (SimplexInTet) of every part but the last, and with the
  ///               point (ArcExit) at which it ends
  template <class Visit>
  [[nodiscard]] ArcEnd followBeyond(const SimplexInTet& at, const Visit& visit) {
    FaceWalk& walk = beginnings_[0].walk;
    return goOn(walk, at, startWalk(walk, at), visit);
  }
  /// Begins to follow an edge from a point in the interior of a tet, forward or backward along the
  /// frame.
  /// @param seen, sides  of the tet in the frame
  void begin(Way way, const SimplexInTet& middle, const LatticeTet& seen, const EdgeSides& sides) {
    Beginning& beginning = beginningOf(way);
    beginning.at = middle;
    if (way == Way::Backward) beginning.at.frame = middle.frame.reversed();
    beginning.walking = beginning.walk.start(beginning.at, seen, sides, way);
  }
  /// Goes on from there. The edge does not end in that tet.
  template <class Visit>
  [[nodiscard]] ArcEnd followBegun(Way way, const Visit& visit) {
    Beginning& beginning = beginningOf(way);
    return goOn(beginning.walk, beginning.at, beginning.walking, visit);
  }
  /// The same from a part that may be the last one.
  template <class Visit>
  [[nodiscard]] ArcEnd follow(const SimplexInTet& at, const Visit& visit) {
    const Index vertex = vertexIn(at);
    if (vertex != kNone) return {at, vertex};
    return followBeyond(at, visit);
  }

  /// Goes on from a point inside a face that the edge is known to leave a tet through, where the
  /// tet behind it does not have the end. That point is not visited again.
  template <class Visit>
  [[nodiscard]] ArcEnd followThrough(int face, SimplexInTet at, const Visit& visit) {
    FaceWalk& walk = beginnings_[0].walk;
    walk.resume(at, face);
    if (!walk.cross(at)) fail(at.tet, "a hex edge leaves the mesh");
    const bool walking = walk.leave(at);
    return goOn(walk, at, walking, visit);
  }
  /// The hex vertex at the end of an edge that crosses a face, if the closed tet behind has it.
  /// @param z  the end, in the chart on this side
  [[nodiscard]] Index vertexBehind(HalfFace halfFace, HalfFace mate, GridPoint z) const {
    if (exact_.transitions.isJump(halfFace)) z = exact_.transitions.across(halfFace)(z);
    return vertices_.find(tetOf(mate), z).vertex;
  }

  [[noreturn]] static void fail(Index tet, const char* what);

 private:
  /// A walk that has been begun, and where.
  struct Beginning {
    explicit Beginning(const PreparedMap& map) : walk(map) {}
    FaceWalk walk;
    SimplexInTet at;
    bool walking = false;
  };
  [[nodiscard]] Beginning& beginningOf(Way way) noexcept {
    return beginnings_[static_cast<std::size_t>(way)];
  }
  /// Whether a walk through the interiors of faces begins.
  [[nodiscard]] bool startWalk(FaceWalk& walk, const SimplexInTet& at) {
    if (at.simplex != kWholeTet) return false;
    const LatticeTet seen = see(at);
    return walk.start(at, seen, EdgeSides(seen));
  }
  template <class Visit>
  [[nodiscard]] ArcEnd goOn(FaceWalk& walk, SimplexInTet at, bool walking, const Visit& visit) {
    for (std::size_t steps = 0; steps <= topology_.tetCount(); ++steps) {
      if (walking) {
        const Index vertex = walkOn(walk, at, visit);
        if (vertex != kNone) return {at, vertex};
      }
      const LatticeTet seen = see(at);
      const SimplexPoint exit = exitPoint(seen, at.simplex, 0);
      const Passage passage = pass(at, exit.simplex());
      visit(std::as_const(at), exitAt(passage.exit, at, seen, exit));
      at = passage.carrier;
      // The end is in the closed tet if and only if the edge does not leave it before.
      const Index vertex = vertexIn(at);
      if (vertex != kNone) return {at, vertex};
      walking = startWalk(walk, at);
    }
    fail(at.tet, "a hex edge does not end");
  }
  /// Follows the walk through the interiors of faces.
  /// @return the hex vertex at the end, or kNone if the walk comes to another exit before
  template <class Visit>
  [[nodiscard]] Index walkOn(FaceWalk& walk, SimplexInTet& at, const Visit& visit) {
    // Points are computed one step late, while memory looks for the next tet.
    FaceWalk::Exit exit = walk.exit(at);
    for (std::size_t steps = 0; steps <= topology_.tetCount(); ++steps) {
      if (!walk.cross(at)) fail(at.tet, "a hex edge leaves the mesh");
      // To look for the end takes less than to leave the tet, so where it may be, it is done first.
      const Index vertex = vertices_.hasVertices(at.tet) ? vertexIn(at) : kNone;
      const bool goesOn = vertex == kNone && walk.leave(at);
      visit(std::as_const(exit.carrier), exit.through(map_));
      if (!goesOn) return vertex;
      exit = walk.exit(at);
    }
    fail(at.tet, "a hex edge does not end");
  }
  /// The hex vertex at the end of the edge, if the closed tet has it.
  [[nodiscard]] Index vertexIn(const SimplexInTet& at) {
    const Direction along = at.frame.axes[0];
    return vertices_.find(at.tet, step(at.frame.origin, along)).vertex;
  }
  [[nodiscard]] LatticeTet see(const SimplexInTet& at) const {
    return at.frame.see(exact_.corners[at.tet], exact_.unit);
  }
  /// The simplex at whose inner point a part ends, and the carrier of the next part.
  struct Passage {
    OwnedSimplex exit;
    SimplexInTet carrier;
  };
  /// @param at    the carrier of the part that ends
  /// @param exit  where, in the same tet
  [[nodiscard]] Passage pass(const SimplexInTet& at, CornerMask exit);
  [[nodiscard]] Passage passOnBoundary(const SimplexInTet& at, CornerMask edge) const;
  [[nodiscard]] ArcExit exitAt(const OwnedSimplex& generator, const SimplexInTet& carrier,
                               const LatticeTet& seen, const SimplexPoint& point) const;

  const PreparedMap& map_;
  const ExactMap& exact_;
  const TetTopology& topology_;
  const LatticeNumbers& vertices_;
  std::array<Beginning, 2> beginnings_;  ///< by way
  SimplexStar star_;
};

}  // namespace hexhex
