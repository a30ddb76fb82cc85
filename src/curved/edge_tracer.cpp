#include <curved/edge_tracer.hpp>

namespace hexhex {

std::array<Index, 2> EdgeTracer::trace(const SimplexInTet& middle) {
  const Found from = vertices_.find(middle.tet, middle.frame.origin);
  const Found to = vertices_.find(middle.tet, step(middle.frame.origin, middle.frame.axes[0]));
  if (from.vertex == kNone || to.vertex == kNone) {
    return middle.simplex == kWholeTet ? traceBothWays(middle, from, to)
                                       : traceFromBoundary(middle, from);
  }
  // By convexity, all between lies in the smallest simplex that contains both ends.
  addSegment({middle.tet, static_cast<CornerMask>(from.simplex | to.simplex), {}});
  return {from.vertex, to.vertex};
}

/// From a midpoint inside a tet.
/// @param from, to  what the tet has of the edge's ends
std::array<Index, 2> EdgeTracer::traceBothWays(const SimplexInTet& middle, const Found& from,
                                               const Found& to) {
  const LatticeTet seen = middle.frame.see(map_.exact.corners[middle.tet], map_.exact.unit);
  const EdgeSides sides(seen);
  std::array<Index, 2> ends = {from.vertex, to.vertex};
  // Both at once, so that memory answers to one while the other is followed.
  if (from.vertex == kNone) tracer_.begin(Way::Backward, middle, seen, sides);
  if (to.vertex == kNone) tracer_.begin(Way::Forward, middle, seen, sides);
  if (from.vertex == kNone) {
    ends[0] =
        traceBack([&](const auto& visit) { return tracer_.followBegun(Way::Backward, visit); });
  } else {
    addSegment(middle);
  }
  if (to.vertex == kNone) {
    ends[1] =
        traceAhead([&](const auto& visit) { return tracer_.followBegun(Way::Forward, visit); });
  }
  return ends;
}

/// From a midpoint on the boundary of tets: back to the beginning, then on from where it was.
/// @param from  what the tet has of the beginning
std::array<Index, 2> EdgeTracer::traceFromBoundary(const SimplexInTet& middle, const Found& from) {
  SimplexInTet back{middle.tet, static_cast<CornerMask>(middle.simplex | from.simplex),
                    middle.frame.reversed()};
  Index first = from.vertex;
  if (first == kNone) {
    back = tracer_.behind({middle.tet, middle.simplex, back.frame});
    first = traceBack([&](const auto& visit) { return tracer_.follow(back, visit); });
  } else {
    addSegment(back);
  }
  // Whether or not that part ends at the midpoint, it is there already.
  back.frame = back.frame.reversed();
  return {first, traceAhead([&](const auto& visit) { return tracer_.follow(back, visit); })};
}

}  // namespace hexhex
