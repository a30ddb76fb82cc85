#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include <curved/arcs.hpp>
#include <curved/owned_simplex.hpp>
#include <curved/simplex_point.hpp>
#include <curved/simplex_star.hpp>

namespace hexhex {

namespace {

/// The largest double below 1.
constexpr double kBelowOne = 1 - 0x1p-53;

/// Inner points and segments of consecutive arcs.
struct ArcPieces {
  std::vector<Vec3> points;
  std::vector<double> parameters;
  std::vector<OwnedSimplex> crossings;
  std::vector<OwnedSimplex> segments;
};

/// Follows hex edges from simplex to simplex. One per thread.
///
/// The frame has the edge along its first axis. A hex edge is straight in every tet, so inside a
/// closed tet it stays in one simplex (its carrier), from where it enters to where it leaves.
class ArcTracer {
 public:
  explicit ArcTracer(const PreparedMap& map)
      : map_(map), star_(map.topology, map.exact), topology_(map.topology) {}

  /// A part of an edge: its carrier, in one of the tets around that.
  using Part = SimplexInTet;

  /// The last part of the edge that runs through the midpoint of `start`, along its frame.
  [[nodiscard]] Part toEnd(const SimplexInTet& start) {
    return follow(leave(start), [](const Part&, const SimplexPoint&, const LatticeTet&) {});
  }

  /// Visits every part of the edge but the first with the point at which it begins, and returns
  /// the last one.
  template <class Visit>
  Part follow(Part part, const Visit& visitEnd) {
    for (std::size_t steps = 0; steps <= topology_.tetCount(); ++steps) {
      const LatticeTet seen = part.frame.see(map_.exact.corners[part.tet], map_.exact.unit);
      const SimplexPoint exit = exitPoint(seen, part.simplex, 0);
      const CornerMask at = exit.simplex();
      if (at == kNoSimplex) fail(part.tet, "a hex edge leaves a tet nowhere");
      if (exit.compare(seen, 0, map_.exact.unit) >= 0) return part;
      visitEnd(part, exit, seen);
      const bool throughFace = part.simplex == kWholeTet && dimension(at) == 2;
      part = throughFace ? beyond(part, at) : leave({part.tet, at, part.frame});
    }
    fail(part.tet, "a hex edge does not end");
  }

  [[noreturn]] static void fail(Index tet, const char* what) {
    throw Error(ErrorCode::Internal,
                std::string("Tracing an arc failed: ") + what +
                    ". The map passed all checks, so this is a bug; please report it with the map.",
                {PlaceKind::Tet, tet});
  }

 private:
  /// The part of the edge behind a point of it that lies in the interior of a simplex.
  [[nodiscard]] Part leave(const SimplexInTet& point) {
    if (point.simplex == kWholeTet) return point;
    Part found;
    const bool leads = star_.visit(point, [&](const SimplexInTet& here) {
      const LatticeTet seen = here.frame.see(map_.exact.corners[here.tet], map_.exact.unit);
      found = here;
      found.simplex = holder(NormalSigns(seen), here.simplex, direction(0, 1));
      return found.simplex != kNoSimplex;
    });
    if (!leads) fail(point.tet, "a hex edge leaves the mesh");
    return found;
  }

  /// The same behind a face that the edge crosses.
  [[nodiscard]] Part beyond(const Part& part, CornerMask face) const {
    const int opposite = oppositeCorner(face);
    if (topology_.isBoundary(halfFaceOf(part.tet, opposite))) {
      fail(part.tet, "a hex edge leaves the mesh");
    }
    return crossed(topology_, map_.exact, part, opposite);  // from tet to tet
  }

  const PreparedMap& map_;
  SimplexStar star_;
  const TetTopology& topology_;
};

/// Traces the edges that a block of tets owns.
class BlockTracer {
 public:
  BlockTracer(const PreparedMap& map, const LatticeNumbers& vertices, Arcs& arcs, ArcPieces& pieces)
      : map_(map), vertices_(vertices), arcs_(arcs), pieces_(pieces), tracer_(map) {}

  void trace(Index tet, const Element& edge) {
    GridPoint end = edge.z;
    ++end[static_cast<std::size_t>(edge.axis)];
    const LatticeNumbers::Found from = vertices_.find(tet, edge.z);
    const LatticeNumbers::Found to = vertices_.find(tet, end);
    if (from.vertex != kNone && to.vertex != kNone) {
      // By convexity, all between lies in the smallest simplex that contains both ends.
      arcs_.ends[edge.number] = {from.vertex, to.vertex};
      arcs_.pointBegin[edge.number] = 0;
      addSegment(tet, static_cast<CornerMask>(from.simplex | to.simplex));
      return;
    }
    traceThroughTets(tet, edge);
  }

 private:
  void traceThroughTets(Index tet, const Element& edge) {
    // First back to the beginning, then all the way, so that every point is seen from there.
    ArcTracer::Part part = tracer_.toEnd({tet, edge.simplex, reversed(Frame::along(edge.z, edge.axis))});
    part.frame = reversed(part.frame);
    const Index from = vertexAt(part, 0);
    const std::size_t before = pieces_.points.size();
    part = tracer_.follow(part, [&](const ArcTracer::Part& here, const SimplexPoint& exit,
                                    const LatticeTet& seen) {
      addSegment(here.tet, here.simplex);
      addPoint(here.tet, exit, seen, pieces_.points.size() == before);
    });
    addSegment(part.tet, part.simplex);
    arcs_.ends[edge.number] = {from, vertexAt(part, 1)};
    arcs_.pointBegin[edge.number] = pieces_.points.size() - before;
  }

  /// The same edge from its other end.
  static Frame reversed(const Frame& frame) {
    return {frame.at({1, 0, 0}), {opposite(frame.axes[0]), opposite(frame.axes[1]), frame.axes[2]}};
  }

  [[nodiscard]] Index vertexAt(const ArcTracer::Part& part, std::int32_t at) const {
    const Index vertex = vertices_.find(part.tet, part.frame.at({at, 0, 0})).vertex;
    if (vertex == kNone) ArcTracer::fail(part.tet, "a hex edge ends where no hex vertex is");
    return vertex;
  }

  void addSegment(Index tet, CornerMask simplex) {
    pieces_.segments.push_back(ownedBy(map_.topology, tet, simplex));
  }

  void addPoint(Index tet, const SimplexPoint& point, const LatticeTet& seen, bool first) {
    const std::array<double, 4> shares = point.normalized();
    const double t = coordinate(shares, seen, 0) / static_cast<double>(map_.exact.unit);
    // The exact value is in (0, 1) and ascends; rounding may not change that.
    const double low = first ? std::numeric_limits<double>::min() : pieces_.parameters.back();
    pieces_.parameters.push_back(std::clamp(t, low, kBelowOne));
    pieces_.points.push_back(position(shares, map_.topology.tets[tet], map_.input.view.points));
    pieces_.crossings.push_back(ownedBy(map_.topology, tet, point.simplex()));
  }

  const PreparedMap& map_;
  const LatticeNumbers& vertices_;
  Arcs& arcs_;
  ArcPieces& pieces_;
  ArcTracer tracer_;
};

/// Moves the pieces of a block to their places.
void join(ArcPieces& pieces, std::uint64_t firstPoint, std::uint64_t firstSegment, Arcs& arcs) {
  for (std::size_t i = 0; i < pieces.points.size(); ++i) {
    arcs.points[firstPoint + i] = pieces.points[i];
    arcs.parameters[firstPoint + i] = pieces.parameters[i];
    arcs.generatorTet[firstPoint + i] = pieces.crossings[i].tet;
    arcs.generatorCorners[firstPoint + i] = pieces.crossings[i].corners;
  }
  for (std::size_t i = 0; i < pieces.segments.size(); ++i) {
    arcs.segmentTet[firstSegment + i] = pieces.segments[i].tet;
    arcs.segmentCorners[firstSegment + i] = pieces.segments[i].corners;
  }
  pieces = {};
}

}  // namespace

Arcs traceArcs(const PreparedMap& map, const LatticeNumbers& vertices, const ElementNumbers& edges,
               Stage& stage) {
  Arcs arcs;
  const std::size_t tets = map.topology.tetCount();
  arcs.ends.resize(edges.count());
  arcs.pointBegin.resize(edges.count() + 1);
  arcs.pointBegin.back() = 0;
  std::vector<ArcPieces> blocks(blockCount(tets, kSweepBlock));
  parallelBlocks(stage, tets, kSweepBlock,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   blocks[block].segments.reserve(edges.begin(end) - edges.begin(begin));
                   BlockTracer tracer(map, vertices, arcs, blocks[block]);
                   for (std::size_t t = begin; t < end; ++t) {
                     const auto tet = static_cast<Index>(t);
                     edges.forEach(tet, [&](const Element& edge) { tracer.trace(tet, edge); });
                   }
                 });
  const std::uint64_t points = exclusiveScan(std::span(arcs.pointBegin));
  arcs.points.resize(points);
  arcs.parameters.resize(points);
  arcs.generatorTet.resize(points);
  arcs.generatorCorners.resize(points);
  arcs.segmentTet.resize(points + edges.count());
  arcs.segmentCorners.resize(points + edges.count());
  parallelFor(stage, blocks.size(), 1, [&](std::size_t block) {
    const std::uint64_t firstArc = edges.begin(block * kSweepBlock);
    const std::uint64_t firstPoint = arcs.pointBegin[firstArc];
    join(blocks[block], firstPoint, firstPoint + firstArc, arcs);
  });
  return arcs;
}

}  // namespace hexhex
