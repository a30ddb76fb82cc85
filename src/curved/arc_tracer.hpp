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

/// A part of a hex edge inside one simplex (its carrier), seen from one of the tets around that.
/// The frame has the edge along its first axis.
struct ArcPart {
  SimplexInTet carrier;
  LatticeTet seen;  ///< the tet in the frame
};

/// Where a hex edge ends.
struct ArcEnd {
  SimplexInTet carrier;  ///< of its last part
  Index vertex;
};

/// Follows hex edges. One per thread.
///
/// A hex edge is straight in every tet, so inside a closed tet it stays in one simplex from where
/// it enters to where it leaves.
class ArcTracer {
 public:
  ArcTracer(const PreparedMap& map, const LatticeNumbers& vertices)
      : exact_(map.exact),
        topology_(map.topology),
        vertices_(vertices),
        walk_(map),
        star_(map.topology, map.exact) {}

  /// The part of the edge behind a point of it that lies in the interior of a simplex.
  [[nodiscard]] ArcPart behind(const SimplexInTet& point);
  /// The part of the edge in a carrier that is known.
  [[nodiscard]] ArcPart in(const SimplexInTet& carrier) const {
    return {carrier, carrier.frame.see(exact_.corners[carrier.tet], exact_.unit)};
  }

  /// Goes on to the last part, the one that ends at coordinate 1 of the frame.
  /// @param part   one that does not end there
  /// @param visit  called with the carrier (SimplexInTet) of every part but the last, and with the
  ///               point (ArcExit) at which it ends
  template <class Visit>
  [[nodiscard]] ArcEnd followBeyond(ArcPart part, const Visit& visit) {
    SimplexInTet& at = part.carrier;
    for (std::size_t steps = 0; steps <= topology_.tetCount(); ++steps) {
      if (at.simplex == kWholeTet && walk_.start(at, part.seen)) {
        const Index vertex = walkOn(at, visit);
        if (vertex != kNone) return {at, vertex};
        part = in(at);
      }
      const SimplexPoint exit = exitPoint(part.seen, at.simplex, 0);
      visit(std::as_const(at), exitAt(part, exit));
      part = behind({at.tet, exit.simplex(), at.frame});
      // The end is in the closed tet if and only if the edge does not leave it before.
      const Index vertex = vertexIn(at);
      if (vertex != kNone) return {at, vertex};
    }
    fail(at.tet, "a hex edge does not end");
  }
  /// The same from a part that may be the last one.
  template <class Visit>
  [[nodiscard]] ArcEnd follow(const ArcPart& part, const Visit& visit) {
    const Index vertex = vertexIn(part.carrier);
    if (vertex != kNone) return {part.carrier, vertex};
    return followBeyond(part, visit);
  }

  [[noreturn]] static void fail(Index tet, const char* what);

 private:
  /// Follows the walk through the interiors of faces.
  /// @return the hex vertex at the end, or kNone if the walk comes to another exit before
  template <class Visit>
  [[nodiscard]] Index walkOn(SimplexInTet& at, const Visit& visit) {
    for (std::size_t steps = 0; steps <= topology_.tetCount(); ++steps) {
      visit(std::as_const(at), walk_.exit(at.tet));
      if (!walk_.cross(at)) fail(at.tet, "a hex edge leaves the mesh");
      const Index vertex = vertexIn(at);
      if (vertex != kNone || !walk_.leave(at)) return vertex;
    }
    fail(at.tet, "a hex edge does not end");
  }
  /// The hex vertex at the end of the edge, if the closed tet has it.
  [[nodiscard]] Index vertexIn(const SimplexInTet& at) {
    const Direction along = at.frame.axes[0];
    return vertices_.find(at.tet, step(at.frame.origin, along), endHints_[along]).vertex;
  }
  [[nodiscard]] ArcExit exitAt(const ArcPart& part, const SimplexPoint& point) const;

  const ExactMap& exact_;
  const TetTopology& topology_;
  const LatticeNumbers& vertices_;
  FaceWalk walk_;
  SimplexStar star_;
  /// Where the last edge ended, by direction, as edges come in the order of a sweep.
  std::array<LineHint, kDirections> endHints_;
};

}  // namespace hexhex
