// Hex edges on their way from simplex to simplex.
#pragma once

#include <array>
#include <utility>

#include <curved/lattice_numbers.hpp>
#include <curved/simplex_point.hpp>
#include <curved/simplex_star.hpp>

#include <map/prepare.hpp>

namespace hexhex {

/// A part of a hex edge inside one simplex (its carrier), seen from one of the tets around that.
/// The frame has the edge along its first axis.
struct ArcPart {
  SimplexInTet carrier;
  LatticeTet seen;   ///< the tet in the frame
  int entered = -1;  ///< face through whose interior the edge came into the tet, or -1
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
        star_(map.topology, map.exact) {}

  /// The part of the edge behind a point of it that lies in the interior of a simplex.
  [[nodiscard]] ArcPart behind(const SimplexInTet& point);
  /// The part of the edge in a carrier that is known.
  [[nodiscard]] ArcPart in(const SimplexInTet& carrier) const {
    return {carrier, carrier.frame.see(exact_.corners[carrier.tet], exact_.unit)};
  }

  /// Goes on to the last part, the one that ends at coordinate 1 of the frame.
  /// @param part     one that does not end there
  /// @param visit  called with every part but the last, and with the point at which it ends
  template <class Visit>
  [[nodiscard]] ArcEnd followBeyond(ArcPart part, const Visit& visit) {
    for (std::size_t steps = 0; steps <= topology_.tetCount(); ++steps) {
      const SimplexPoint exit = exitOf(part);
      const CornerMask at = exit.simplex();
      if (at == kNoSimplex) fail(part.carrier.tet, "a hex edge leaves a tet nowhere");
      visit(std::as_const(part), exit, at);
      goOn(part, at);
      // The end is in the closed tet if and only if the edge does not leave it before.
      const Index vertex = vertexIn(part.carrier);
      if (vertex != kNone) return {part.carrier, vertex};
    }
    fail(part.carrier.tet, "a hex edge does not end");
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
  /// The hex vertex at the end of the edge, if the closed tet has it.
  [[nodiscard]] Index vertexIn(const SimplexInTet& at) {
    return vertices_.find(at.tet, at.frame.at({1, 0, 0}), endHints_[at.frame.axes[0]]).vertex;
  }
  [[nodiscard]] SimplexPoint exitOf(const ArcPart& part);
  void goOn(ArcPart& part, CornerMask at);
  void goBeyond(ArcPart& part, int face) const;

  const ExactMap& exact_;
  const TetTopology& topology_;
  const LatticeNumbers& vertices_;
  SimplexStar star_;
  // Guesses, as edges come in the order of a sweep. By direction of the edge:
  std::array<LineHint, kDirections> endHints_;  ///< where the last one ended
  std::array<int, kDirections> exitGuesses_{};  ///< the face through which the last one left
};

}  // namespace hexhex
