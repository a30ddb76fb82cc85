#include <algorithm>
#include <cassert>
#include <limits>
#include <string>
#include <vector>

#include <curved/arcs.hpp>
#include <curved/face_walk.hpp>
#include <curved/intersections.hpp>
#include <curved/simplex_point.hpp>
#include <curved/simplex_star.hpp>

namespace hexhex::curved {

/// Traces hex edges from their midpoints to both ends. One per thread. In every frame, the edge
/// runs along the first axis.
///
/// A hex edge is straight in every tet. So between entering and leaving a closed tet it stays in
/// the interior of one simplex, its carrier.
class ArcTracer {
 public:
  /// @param pieces  receives the arcs
  ArcTracer(const igm::PreparedMap& map, const sweep::VertexTables& vertices, ArcPieces& pieces)
      : map_(map),
        exact_(map.exact),
        topology_(map.topology),
        vertices_(vertices),
        pieces_(pieces),
        walk_(map),
        star_(map.topology, map.exact) {}

  /// Adds the arc of an edge.
  /// @param middle  the simplex that holds the midpoint, with the edge's frame
  void trace(const SimplexInTet& middle);

 private:
  using Found = sweep::VertexTables::Found;
  using Ends = std::array<Index, 2>;

  [[nodiscard]] Ends traceFromInside(const SimplexInTet& middle, const Found& from,
                                     const Found& to);
  [[nodiscard]] Ends traceFromBoundary(const SimplexInTet& middle, const Found& from);
  template <class Follow>
  [[nodiscard]] Index traceBack(const SimplexInTet& carrier, const Follow& follow);

  [[nodiscard]] Index follow(const SimplexInTet& at);
  [[nodiscard]] Index followBeyond(SimplexInTet at, bool walking);
  [[nodiscard]] Index walkOn(SimplexInTet& at);
  [[nodiscard]] bool startWalk(const SimplexInTet& at);

  /// The simplex whose interior holds the end of a part, and the carrier of the next part.
  struct HandOver {
    OwnedSimplex exit;
    SimplexInTet carrier;
  };
  [[nodiscard]] HandOver leave(const SimplexInTet& at, lattice::CornerMask exit);
  [[nodiscard]] HandOver leaveAlongBoundary(const SimplexInTet& at, lattice::CornerMask edge) const;
  [[nodiscard]] SimplexInTet carrierBehind(const SimplexInTet& point);
  [[nodiscard]] ArcExit exitAt(const OwnedSimplex& generator, const SimplexInTet& carrier,
                               const lattice::LatticeTet& seen, const SimplexPoint& point) const;

  /// The hex vertex at the end of the edge, if the closed tet contains it.
  [[nodiscard]] Index vertexIn(const SimplexInTet& at) const {
    return vertices_.find(at.tet, lattice::step(at.frame.origin(), at.frame.axis(0))).vertex;
  }
  [[nodiscard]] lattice::LatticeTet see(const SimplexInTet& at) const {
    return at.frame.see(exact_.corners[at.tet], exact_.unit);
  }
  void addSegment(const SimplexInTet& carrier) {
    pieces_.addSegment(ownedBy(topology_, carrier.tet, carrier.simplex));
  }
  [[noreturn]] static void fail(Index tet, const char* what);

  const igm::PreparedMap& map_;
  const igm::ExactMap& exact_;
  const adjacency::TetTopology& topology_;
  const sweep::VertexTables& vertices_;
  ArcPieces& pieces_;
  FaceWalk walk_;
  SimplexStar star_;
};

namespace {

/// Traces the edges owned by some tets.
void traceEdges(const igm::PreparedMap& map, const sweep::VertexTables& vertices,
                const ElementNumbers& edges, std::size_t begin, std::size_t end,
                ArcPieces& pieces) {
  pieces.clear();
  ArcTracer tracer(map, vertices, pieces);
  for (std::size_t t = begin; t < end; ++t) {
    const auto tet = static_cast<Index>(t);
    edges.forEach(tet, [&](const Element& edge) {
      tracer.trace({tet, edge.simplex, Frame::along(edge.z, edge.axis)});
    });
  }
}

}  // namespace

Arcs traceArcs(const igm::PreparedMap& map, const sweep::VertexTables& vertices,
               const ElementNumbers& edges, Stage& stage) {
  Arcs arcs;
  arcs.ends.resize(edges.count());
  arcs.pointBegin.resize(edges.count() + 1);
  const std::size_t tets = map.topology.tetCount();
  std::uint64_t points = 0;
  parallelBatches<ArcPieces>(
      stage, tets, tetsPerBlock(edges.count(), tets),
      [&](std::size_t begin, std::size_t end, ArcPieces& pieces) {
        traceEdges(map, vertices, edges, begin, end, pieces);
      },
      [&](const ArcPieces& pieces, std::size_t end) {
        const std::uint64_t firstPoint = points;
        points += pieces.points();
        lengthenForPieces(arcs, points, edges.begin(end));
        return firstPoint;
      },
      [&](const ArcPieces& pieces, std::uint64_t firstPoint, std::size_t begin) {
        pieces.copyTo(arcs, edges.begin(begin), firstPoint);
      });
  assert(arcs.points.size() == points && arcs.segmentTet.size() == points + edges.count());
  arcs.pointBegin.back() = points;
  return arcs;
}

namespace {

/// The simplex of a tet into which the first axis leads from an interior point of another simplex,
/// or kNoSimplex: holder() for a single direction (Algorithm 4).
lattice::CornerMask holderAhead(const lattice::LatticeTet& seen, lattice::CornerMask at) {
  lattice::CornerMask simplex = lattice::kWholeTet;
  for (int face = 0; face < 4; ++face) {
    if (lattice::contains(at, face)) continue;
    const std::array<int, 3>& f = lattice::kFaceCorners[static_cast<std::size_t>(face)];
    const lattice::LatticePoint& origin = seen[static_cast<std::size_t>(f[0])];
    const lattice::Int128 ahead =
        lattice::crossComponent(seen[static_cast<std::size_t>(f[1])] - origin,
                                seen[static_cast<std::size_t>(f[2])] - origin, 0);
    if (ahead < 0) return lattice::kNoSimplex;
    if (ahead == 0) simplex = static_cast<lattice::CornerMask>(simplex & lattice::faceMask(face));
  }
  return simplex;
}

}  // namespace

void ArcTracer::fail(Index tet, const char* what) {
  throw Error(ErrorCode::Internal,
              std::string("Tracing an arc failed: ") + what +
                  ". The map passed all checks, so this is a bug; please report it with the map.",
              {PlaceKind::Tet, tet});
}

void ArcTracer::trace(const SimplexInTet& middle) {
  const std::size_t firstPoint = pieces_.points();
  const Found from = vertices_.find(middle.tet, middle.frame.origin());
  const Found to =
      vertices_.find(middle.tet, lattice::step(middle.frame.origin(), middle.frame.axis(0)));
  Ends ends = {from.vertex, to.vertex};
  if (from.vertex != kNone && to.vertex != kNone) {
    // By convexity, everything in between lies in the smallest simplex that contains both ends.
    addSegment({middle.tet, static_cast<lattice::CornerMask>(from.simplex | to.simplex), {}});
  } else {
    ends = middle.simplex == lattice::kWholeTet ? traceFromInside(middle, from, to)
                                                : traceFromBoundary(middle, from);
  }
  assert(ends[0] != kNone && ends[1] != kNone);
  pieces_.addArc(ends, firstPoint);
  // Exact parameters are in (0, 1) and ascending; rounding must not change that.
  constexpr double kBelowOne = 1 - 0x1p-53;
  double before = std::numeric_limits<double>::min();
  pieces_.changeParameters(firstPoint, [&](double& parameter) {
    parameter = before = std::clamp(parameter, before, kBelowOne);
  });
}

/// Starts at a midpoint inside a tet.
/// @param from, to  what the tet contains of the edge's ends
ArcTracer::Ends ArcTracer::traceFromInside(const SimplexInTet& middle, const Found& from,
                                           const Found& to) {
  const lattice::LatticeTet seen = see(middle);
  const EdgeSides sides(seen);
  Ends ends = {from.vertex, to.vertex};
  if (from.vertex == kNone) {
    const SimplexInTet back{middle.tet, lattice::kWholeTet, middle.frame.reversed()};
    const bool walking = walk_.start(back, seen, sides, Heading::Backward);
    ends[0] = traceBack(back, [&] { return followBeyond(back, walking); });
  } else {
    addSegment(middle);
  }
  if (to.vertex == kNone) {
    ends[1] = followBeyond(middle, walk_.start(middle, seen, sides, Heading::Forward));
  }
  return ends;
}

/// Starts at a midpoint on the boundary of tets: first back to the beginning, then forward from the
/// midpoint.
/// @param from  what the tet contains of the beginning
ArcTracer::Ends ArcTracer::traceFromBoundary(const SimplexInTet& middle, const Found& from) {
  SimplexInTet carrier{middle.tet, static_cast<lattice::CornerMask>(middle.simplex | from.simplex),
                       middle.frame};
  Index first = from.vertex;
  if (first == kNone) {
    const SimplexInTet back = carrierBehind({middle.tet, middle.simplex, middle.frame.reversed()});
    first = traceBack(back, [&] { return follow(back); });
    carrier = {back.tet, back.simplex, back.frame.reversed()};
  } else {
    addSegment(carrier);
  }
  // The midpoint has been added already, whether or not that part ends there.
  return {first, follow(carrier)};
}

/// Adds everything from the beginning of the edge to one of its parts.
/// @param carrier  of that part, in a frame with the edge reversed
/// @param follow   follows the edge in that frame, from that part to its end
/// @return the vertex at the beginning
template <class Follow>
Index ArcTracer::traceBack(const SimplexInTet& carrier, const Follow& follow) {
  const std::size_t firstPoint = pieces_.points();
  const std::size_t firstSegment = pieces_.segments();
  addSegment(carrier);
  const Index vertex = follow();
  pieces_.reverseFrom(firstPoint, firstSegment);
  pieces_.changeParameters(firstPoint, [](double& parameter) { parameter = 1 - parameter; });
  return vertex;
}

/// Adds everything beyond a part of an edge: points, each with the segment after it.
/// @param at  the carrier of the part
/// @return the vertex at the end
Index ArcTracer::follow(const SimplexInTet& at) {
  const Index vertex = vertexIn(at);
  return vertex != kNone ? vertex : followBeyond(at, startWalk(at));
}

/// Continues from a part that is not the last.
/// @param walking  whether a walk has started there
Index ArcTracer::followBeyond(SimplexInTet at, bool walking) {
  for (std::size_t steps = 0; steps <= topology_.tetCount(); ++steps) {
    if (walking) {
      const Index vertex = walkOn(at);
      if (vertex != kNone) return vertex;
    }
    const lattice::LatticeTet seen = see(at);
    const SimplexPoint exit = exitPoint(seen, at.simplex, 0);
    const HandOver next = leave(at, exit.simplex());
    pieces_.addPoint(exitAt(next.exit, at, seen, exit));
    at = next.carrier;
    addSegment(at);
    // The end is in the closed tet if and only if the edge does not leave the tet before.
    const Index vertex = vertexIn(at);
    if (vertex != kNone) return vertex;
    walking = startWalk(at);
  }
  fail(at.tet, "a hex edge does not end");
}

/// Whether a walk through the interiors of faces begins in a part's carrier.
bool ArcTracer::startWalk(const SimplexInTet& at) {
  if (at.simplex != lattice::kWholeTet) return false;
  const lattice::LatticeTet seen = see(at);
  return walk_.start(at, seen, EdgeSides(seen), Heading::Forward);
}

/// Follows the walk through the interiors of faces.
/// @return the hex vertex at the end, or kNone if the walk reaches another kind of exit first
Index ArcTracer::walkOn(SimplexInTet& at) {
  for (std::size_t steps = 0; steps <= topology_.tetCount(); ++steps) {
    SimplexInTet owner = at;
    int face = walk_.face();
    if (!walk_.cross(at)) fail(at.tet, "a hex edge leaves the mesh");
    if (at.tet < owner.tet) {
      owner = at;
      face = walk_.face();
    }
    pieces_.addPoint(exitThrough(map_, {owner.tet, lattice::faceMask(face)}, owner.frame.edge()));
    pieces_.addSegment({at.tet, lattice::kWholeTet});
    // Looking for the end is cheaper than leaving the tet, so it comes first.
    const Index vertex = vertices_.hasVertices(at.tet) ? vertexIn(at) : kNone;
    if (vertex != kNone || !walk_.leave(at)) return vertex;
  }
  fail(at.tet, "a hex edge does not end");
}

/// @param at    the carrier of the part that ends
/// @param exit  the simplex where it ends, in the same tet
ArcTracer::HandOver ArcTracer::leave(const SimplexInTet& at, lattice::CornerMask exit) {
  if (exit == lattice::kNoSimplex) fail(at.tet, "a hex edge leaves a tet nowhere");
  if (lattice::dimension(exit) == 1 && lattice::dimension(at.simplex) == 2 &&
      topology_.isBoundary(adjacency::halfFaceOf(at.tet, lattice::oppositeCorner(at.simplex)))) {
    const HandOver next = leaveAlongBoundary(at, exit);
    if (next.carrier.simplex != lattice::kNoSimplex) return next;
  }
  return {ownedBy(topology_, at.tet, exit), carrierBehind({at.tet, exit, at.frame})};
}

/// From a boundary triangle through one of its edges: the next part is usually in the next boundary
/// triangle, one walk around the edge away, which also passes the edge's owner.
/// @return a carrier without a simplex if the tet of that triangle does not contain the next part
ArcTracer::HandOver ArcTracer::leaveAlongBoundary(const SimplexInTet& at,
                                                  lattice::CornerMask edge) const {
  adjacency::EdgeTurn turn(topology_, at.tet, edge,
                           adjacency::otherFaceAtEdge(edge, lattice::oppositeCorner(at.simplex)));
  HandOver next{{at.tet, edge}, at};
  while (turn.next() != kNone) {
    next.carrier.frame.cross(exact_.transitions, turn.out());
    turn.step();
    if (turn.tet() < next.exit.tet) next.exit = {turn.tet(), turn.edge()};
  }
  next.carrier.tet = turn.tet();
  next.carrier.simplex = holderAhead(see(next.carrier), turn.edge());
  return next;
}

/// The carrier of the part of the edge beyond a point in the interior of a simplex.
SimplexInTet ArcTracer::carrierBehind(const SimplexInTet& point) {
  SimplexInTet carrier;
  const bool leads = star_.visit(point, [&](const SimplexInTet& here) {
    carrier = here;
    if (here.simplex == lattice::kWholeTet) return true;
    carrier.simplex = holderAhead(see(here), here.simplex);
    return carrier.simplex != lattice::kNoSimplex;
  });
  if (!leads) fail(point.tet, "a hex edge leaves the mesh");
  return carrier;
}

/// The point at which a part ends.
/// @param generator  the simplex that holds it, by its owner
/// @param seen       the carrier's tet
ArcExit ArcTracer::exitAt(const OwnedSimplex& generator, const SimplexInTet& carrier,
                          const lattice::LatticeTet& seen, const SimplexPoint& point) const {
  const lattice::CornerMask at = point.simplex();
  if (lattice::dimension(at) == 2) {
    return exitThrough(map_, carrier.tet, lattice::oppositeCorner(at), carrier.frame.edge());
  }
  return exitAtCorners(map_, generator, carrier.tet, at, seen);
}

}  // namespace hexhex::curved
