#include <string>

#include <curved/arc_tracer.hpp>
#include <curved/edge_crossing.hpp>

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

SimplexInTet ArcTracer::behind(const SimplexInTet& point) {
  SimplexInTet carrier;
  const bool leads = star_.visit(point, [&](const SimplexInTet& here) {
    carrier = here;
    if (here.simplex == kWholeTet) return true;
    carrier.simplex = holderAhead(see(here), here.simplex);
    return carrier.simplex != kNoSimplex;
  });
  if (!leads) fail(point.tet, "a hex edge leaves the mesh");
  return carrier;
}

ArcTracer::Passage ArcTracer::pass(const SimplexInTet& at, CornerMask exit) {
  if (exit == kNoSimplex) fail(at.tet, "a hex edge leaves a tet nowhere");
  if (dimension(exit) == 1 && dimension(at.simplex) == 2 &&
      topology_.isBoundary(halfFaceOf(at.tet, oppositeCorner(at.simplex)))) {
    const Passage passage = passOnBoundary(at, exit);
    if (passage.carrier.simplex != kNoSimplex) return passage;
  }
  return {ownedBy(topology_, at.tet, exit), behind({at.tet, exit, at.frame})};
}

/// From a triangle on the boundary through one of its edges: usually to the next triangle on the
/// boundary, and to go there takes one walk around the edge, which comes by its owner as well.
/// @return a carrier without a simplex if the tet of that triangle does not have the next part
ArcTracer::Passage ArcTracer::passOnBoundary(const SimplexInTet& at, CornerMask edge) const {
  EdgeTurn turn(topology_, at.tet, edge, otherFaceAtEdge(edge, oppositeCorner(at.simplex)));
  Passage passage{{at.tet, edge}, at};
  while (turn.next() != kNone) {
    passage.carrier.frame.cross(exact_.transitions, turn.out());
    turn.step();
    if (turn.tet() < passage.exit.tet) passage.exit = {turn.tet(), turn.edge()};
  }
  passage.carrier.tet = turn.tet();
  passage.carrier.simplex = holderAhead(see(passage.carrier), turn.edge());
  return passage;
}

ArcExit ArcTracer::exitAt(const OwnedSimplex& generator, const SimplexInTet& carrier,
                          const LatticeTet& seen, const SimplexPoint& point) const {
  const CornerMask at = point.simplex();
  if (dimension(at) == 2) {
    return exitThrough(map_, carrier.tet, oppositeCorner(at),
                       {carrier.frame.origin, carrier.frame.axes[0]});
  }
  return exitAtCorners(map_, generator, carrier.tet, at, seen, 0);
}

}  // namespace hexhex
