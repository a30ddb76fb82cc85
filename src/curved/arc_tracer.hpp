// Hex edges on their way from simplex to simplex.
#pragma once

#include <array>
#include <utility>

#include <curved/face_walk.hpp>
#include <curved/lattice_numbers.hpp>
#include <curved/simplex_point.hpp>
#include <curved/simplex_star.hpp>

#include <map/prepare.hpp>

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
        walk_(map),
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
    return goOn(at, startWalk(at), visit);
  }
  /// The same from a point in the interior of a tet, forward or backward along the frame.
  /// @param seen, sides  of the tet in the frame
  template <class Visit>
  [[nodiscard]] ArcEnd followFrom(const SimplexInTet& middle, const LatticeTet& seen,
                                  const EdgeSides& sides, Way way, const Visit& visit) {
    SimplexInTet at = middle;
    if (way == Way::Backward) at.frame = at.frame.reversed();
    return goOn(at, walk_.start(at, seen, sides, way), visit);
  }
  /// The same from a part that may be the last one.
  template <class Visit>
  [[nodiscard]] ArcEnd follow(const SimplexInTet& at, const Visit& visit) {
    const Index vertex = vertexIn(at);
    if (vertex != kNone) return {at, vertex};
    return followBeyond(at, visit);
  }

  [[noreturn]] static void fail(Index tet, const char* what);

 private:
  /// Whether the walk through the interiors of faces has begun.
  [[nodiscard]] bool startWalk(const SimplexInTet& at) {
    if (at.simplex != kWholeTet) return false;
    const LatticeTet seen = see(at);
    return walk_.start(at, seen, EdgeSides(seen));
  }
  template <class Visit>
  [[nodiscard]] ArcEnd goOn(SimplexInTet at, bool walking, const Visit& visit) {
    for (std::size_t steps = 0; steps <= topology_.tetCount(); ++steps) {
      if (walking) {
        const Index vertex = walkOn(at, visit);
        if (vertex != kNone) return {at, vertex};
      }
      const LatticeTet seen = see(at);
      const SimplexPoint exit = exitPoint(seen, at.simplex, 0);
      visit(std::as_const(at), exitAt(at.tet, seen, exit));
      at = behind({at.tet, exit.simplex(), at.frame});
      // The end is in the closed tet if and only if the edge does not leave it before.
      const Index vertex = vertexIn(at);
      if (vertex != kNone) return {at, vertex};
      walking = startWalk(at);
    }
    fail(at.tet, "a hex edge does not end");
  }
  /// Follows the walk through the interiors of faces.
  /// @return the hex vertex at the end, or kNone if the walk comes to another exit before
  template <class Visit>
  [[nodiscard]] Index walkOn(SimplexInTet& at, const Visit& visit) {
    for (std::size_t steps = 0; steps <= topology_.tetCount(); ++steps) {
      visit(std::as_const(at), walk_.exit(at.tet));
      if (!walk_.cross(at)) fail(at.tet, "a hex edge leaves the mesh");
      const bool leaves = walk_.leave(at);
      if (leaves && walk_.certainlyGoesOn()) continue;
      const Index vertex = vertexIn(at);
      if (vertex != kNone || !leaves) return vertex;
    }
    fail(at.tet, "a hex edge does not end");
  }
  /// The hex vertex at the end of the edge, if the closed tet has it.
  [[nodiscard]] Index vertexIn(const SimplexInTet& at) {
    const Direction along = at.frame.axes[0];
    return vertices_.find(at.tet, step(at.frame.origin, along), endHints_[along]).vertex;
  }
  [[nodiscard]] LatticeTet see(const SimplexInTet& at) const {
    return at.frame.see(exact_.corners[at.tet], exact_.unit);
  }
  [[nodiscard]] ArcExit exitAt(Index tet, const LatticeTet& seen, const SimplexPoint& point) const;

  const PreparedMap& map_;
  const ExactMap& exact_;
  const TetTopology& topology_;
  const LatticeNumbers& vertices_;
  FaceWalk walk_;
  SimplexStar star_;
  /// Where the last edge ended, by direction, as edges come in the order of a sweep.
  std::array<LineHint, kDirections> endHints_;
};

}  // namespace hexhex
