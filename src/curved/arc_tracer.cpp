#include <string>

#include <curved/arc_tracer.hpp>

namespace hexhex {

void ArcTracer::fail(Index tet, const char* what) {
  throw Error(ErrorCode::Internal,
              std::string("Tracing an arc failed: ") + what +
                  ". The map passed all checks, so this is a bug; please report it with the map.",
              {PlaceKind::Tet, tet});
}

namespace {

/// The simplex of a tet into which the first axis leads from an inner point of another one, or
/// kNoSimplex: holder() where only one direction matters. (Algorithm 4)
CornerMask holderAhead(const LatticeTet& seen, CornerMask at) {
  CornerMask simplex = kWholeTet;
  for (int face = 0; face < 4; ++face) {
    if (contains(at, face)) continue;
    const std::array<int, 3>& f = kFaceCorners[static_cast<std::size_t>(face)];
    const LatticePoint& origin = seen[static_cast<std::size_t>(f[0])];
    const Int128 ahead = crossComponent(seen[static_cast<std::size_t>(f[1])] - origin,
                                        seen[static_cast<std::size_t>(f[2])] - origin, 0);
    if (ahead < 0) return kNoSimplex;
    if (ahead == 0) simplex = static_cast<CornerMask>(simplex & faceMask(face));
  }
  return simplex;
}

}  // namespace

ArcPart ArcTracer::behind(const SimplexInTet& point) {
  ArcPart part;
  const bool leads = star_.visit(point, [&](const SimplexInTet& here) {
    part = in(here);
    if (here.simplex == kWholeTet) return true;
    part.carrier.simplex = holderAhead(part.seen, here.simplex);
    return part.carrier.simplex != kNoSimplex;
  });
  if (!leads) fail(point.tet, "a hex edge leaves the mesh");
  return part;
}

SimplexPoint ArcTracer::exitOf(const ArcPart& part) {
  if (part.entered >= 0) return exitAfterEntry(part.seen, part.entered);
  int& guess = exitGuesses_[part.carrier.frame.axes[0]];
  if (part.carrier.simplex == kWholeTet) {
    const SimplexPoint exit = exitInside(part.seen, guess);
    if (exit.weights[static_cast<std::size_t>((guess + 1) % 4)] != 0) return exit;
  }
  const SimplexPoint exit = exitPoint(part.seen, part.carrier.simplex, 0);
  const CornerMask at = exit.simplex();
  if (dimension(at) == 2) guess = oppositeCorner(at);
  return exit;
}

void ArcTracer::goOn(ArcPart& part, CornerMask at) {
  if (part.carrier.simplex == kWholeTet && dimension(at) == 2) {
    goBeyond(part, oppositeCorner(at));
  } else {
    part = behind({part.carrier.tet, at, part.carrier.frame});
  }
}

/// From tet to tet through the interior of a face, whose corners look the same from there.
void ArcTracer::goBeyond(ArcPart& part, int face) const {
  const Index tet = part.carrier.tet;
  const HalfFace mate = topology_.mate[halfFaceOf(tet, face)];
  if (mate == kNone) fail(tet, "a hex edge leaves the mesh");
  part.carrier = crossed(topology_, exact_, part.carrier, face);
  part.entered = localOf(mate);
  const LatticeTet before = part.seen;
  const Tet& corners = topology_.tets[tetOf(mate)];
  for (std::size_t i = 0; i < 4; ++i) {
    if (static_cast<int>(i) == part.entered) {
      part.seen[i] = part.carrier.frame.see(exact_.corners[tetOf(mate)][i], exact_.unit);
    } else {
      part.seen[i] = before[static_cast<std::size_t>(topology_.localCorner(tet, corners[i]))];
    }
  }
}

}  // namespace hexhex
