#include <string>

#include <curved/arc_tracer.hpp>

namespace hexhex {

void ArcTracer::fail(Index tet, const char* what) {
  throw Error(ErrorCode::Internal,
              std::string("Tracing an arc failed: ") + what +
                  ". The map passed all checks, so this is a bug; please report it with the map.",
              {PlaceKind::Tet, tet});
}

ArcPart ArcTracer::behind(const SimplexInTet& point) {
  ArcPart part;
  const bool leads = star_.visit(point, [&](const SimplexInTet& here) {
    part.carrier = here;
    part.seen = here.frame.see(exact_.corners[here.tet], exact_.unit);
    if (here.simplex == kWholeTet) return true;
    part.carrier.simplex = holder(NormalSigns(part.seen), here.simplex, direction(0, 1));
    return part.carrier.simplex != kNoSimplex;
  });
  if (!leads) fail(point.tet, "a hex edge leaves the mesh");
  return part;
}

SimplexPoint ArcTracer::exitOf(const ArcPart& part) {
  const SimplexPoint exit = part.entered >= 0 ? exitAfterEntry(part.seen, part.entered)
                                              : exitPoint(part.seen, part.carrier.simplex, 0);
  if (exit.simplex() == kNoSimplex) fail(part.carrier.tet, "a hex edge leaves a tet nowhere");
  return exit;
}

ArcPart ArcTracer::next(const ArcPart& part, CornerMask at) {
  if (part.carrier.simplex == kWholeTet && dimension(at) == 2) {
    return beyond(part, oppositeCorner(at));
  }
  return behind({part.carrier.tet, at, part.carrier.frame});
}

/// From tet to tet through the interior of a face, whose corners look the same from there.
ArcPart ArcTracer::beyond(const ArcPart& part, int face) const {
  const Index tet = part.carrier.tet;
  const HalfFace mate = topology_.mate[halfFaceOf(tet, face)];
  if (mate == kNone) fail(tet, "a hex edge leaves the mesh");
  ArcPart next{crossed(topology_, exact_, part.carrier, face), {}, localOf(mate)};
  const Tet& corners = topology_.tets[tetOf(mate)];
  for (std::size_t i = 0; i < 4; ++i) {
    if (static_cast<int>(i) == next.entered) {
      next.seen[i] = next.carrier.frame.see(exact_.corners[tetOf(mate)][i], exact_.unit);
    } else {
      next.seen[i] = part.seen[static_cast<std::size_t>(topology_.localCorner(tet, corners[i]))];
    }
  }
  return next;
}

}  // namespace hexhex
