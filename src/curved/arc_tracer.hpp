// Hex edges on their way from simplex to simplex.
#pragma once

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

/// Follows hex edges. One per thread.
///
/// A hex edge is straight in every tet, so inside a closed tet it stays in one simplex from where
/// it enters to where it leaves.
class ArcTracer {
 public:
  explicit ArcTracer(const PreparedMap& map)
      : exact_(map.exact), topology_(map.topology), star_(map.topology, map.exact) {}

  /// The part of the edge behind a point of it that lies in the interior of a simplex.
  [[nodiscard]] ArcPart behind(const SimplexInTet& point);

  /// Goes on to the last part, the one that ends at coordinate 1 of the frame.
  /// @param visit  called with every part but the last, and with the point at which it ends
  template <class Visit>
  [[nodiscard]] ArcPart follow(ArcPart part, const Visit& visit) {
    for (std::size_t steps = 0; steps <= topology_.tetCount(); ++steps) {
      const SimplexPoint exit = exitOf(part);
      if (exit.compare(part.seen, 0, exact_.unit) >= 0) return part;
      visit(std::as_const(part), exit);
      part = next(part, exit.simplex());
    }
    fail(part.carrier.tet, "a hex edge does not end");
  }

  [[noreturn]] static void fail(Index tet, const char* what);

 private:
  [[nodiscard]] static SimplexPoint exitOf(const ArcPart& part);
  [[nodiscard]] ArcPart next(const ArcPart& part, CornerMask at);
  [[nodiscard]] ArcPart beyond(const ArcPart& part, int face) const;

  const ExactMap& exact_;
  const TetTopology& topology_;
  SimplexStar star_;
};

}  // namespace hexhex
