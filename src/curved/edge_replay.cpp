#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

#include <curved/edge_replay.hpp>
#include <curved/edge_tracer.hpp>
#include <curved/face_crossing.hpp>

namespace hexhex {

namespace {

class EdgeReplay {
 public:
  /// @param counts  by tet: receives how many arcs belong to each
  EdgeReplay(const PreparedMap& map, const LatticeNumbers& vertices, const SharedCounts& counts,
             BlockArcs& arcs)
      : map_(map),
        counts_(counts),
        unit_(map.exact.unit),
        arcs_(arcs),
        pieces_(arcs.pieces),
        vertices_(vertices),
        tracer_(map, vertices, arcs.pieces),
        star_(map.topology, map.exact) {}

  void run(const EdgeRecords& records) {
    // Each point is in a face; degenerate edges may have fewer or more.
    const std::size_t edges = records.edges.size();
    const std::size_t faceCount = records.faces.size();
    arcs_.keys.reserve(edges);
    pieces_.reserve(edges, faceCount, faceCount + edges);
    std::size_t first = 0;
    for (const EdgeRecord& record : records.edges) {
      const auto faces = std::span(records.faces).subspan(first, record.faceEnd - first);
      first = record.faceEnd;
      const std::size_t points = pieces_.points();
      const std::size_t segments = pieces_.segments();
      if (follow(record, faces)) {
        finish(record, points, segments);
        continue;
      }
      pieces_.shorten(points, segments);
      if (!faces.empty() || !addInFace(record)) traceExactly(record, faces);
    }
  }

 private:
  /// Adds points and segments in the direction of the record, and finds the tet with the midpoint.
  /// @return false if the edge does not pass through the interiors of faces and tets, or its
  ///         midpoint is not certain to be inside of one
  [[nodiscard]] bool follow(const EdgeRecord& record, std::span<const HalfFace> faces) {
    if (faces.empty() && !record.inside) return false;
    middle_ = {record.z, record.along};
    owner_ = record.tet;
    pieces_.addSegment({record.tet, kWholeTet});
    ChartEdge at = middle_;
    Index tet = record.tet;
    for (const HalfFace halfFace : faces) {
      const HalfFace mate = map_.topology.mate[halfFace];
      const ChartEdge ahead = at.across(map_.exact.transitions, halfFace);
      const bool isOwned = tet < tetOf(mate);
      const HalfFace owned = isOwned ? halfFace : mate;
      const FaceCrossing crossing =
          crossFace(CrossedFace(map_.exact.corners[tetOf(owned)], localOf(owned)),
                    isOwned ? at : ahead, unit_);
      const double fromMiddle = crossing.parameter - 0.5;
      const double distance = std::abs(fromMiddle);
      if (!crossing.inside || distance >= 0.5 - crossing.error || distance <= crossing.error) {
        return false;
      }
      addPoint(owned, crossing);
      at = ahead;
      tet = tetOf(mate);
      pieces_.addSegment({tet, kWholeTet});
      if (fromMiddle < 0) {
        middle_ = at;
        owner_ = tet;
      }
    }
    return true;
  }
  void addPoint(HalfFace face, const FaceCrossing& crossing) {
    const Index owner = tetOf(face);
    const FacePoints corners =
        pointsOf(map_.topology.tets[owner], localOf(face), map_.input.view.points);
    pieces_.addPoint({owner, faceMask(localOf(face))}, pointInFace(crossing.shares, corners),
                     crossing.parameter);
  }

  /// Makes the arc run along the owner's axis.
  void finish(const EdgeRecord& record, std::size_t firstPoint, std::size_t firstSegment) {
    std::array<Index, 2> ends = record.ends;
    if (signOf(middle_.along) < 0) {
      std::swap(ends[0], ends[1]);
      pieces_.reverseFrom(firstPoint, firstSegment);
      pieces_.changeParameters(firstPoint, [](double& parameter) { parameter = 1 - parameter; });
    }
    finish(firstPoint, ends, owner_, middle_.ascending());
  }
  /// @param edge  in the chart of the owner, along its axis
  void finish(std::size_t before, const std::array<Index, 2>& ends, Index owner,
              const ChartEdge& edge) {
    pieces_.addArc(ends, before);
    EdgeTracer::smoothParameters(pieces_, before);
    arcs_.keys.push_back({owner, axisOf(edge.along), edge.z});
    counts_.increase(owner);
  }

  /// Adds an edge inside a tet whose ends are on its boundary, as most degenerate ones are: in a
  /// face on the boundary of the mesh, or from face to face.
  /// @return false, without having done anything, if the edge is inside an edge of the tet
  [[nodiscard]] bool addInFace(const EdgeRecord& record) {
    // By convexity, all between lies in the smallest simplex that contains both ends.
    const GridPoint end = step(record.z, record.along);
    const auto simplex = static_cast<CornerMask>(vertices_.find(record.tet, record.z).simplex |
                                                 vertices_.find(record.tet, end).simplex);
    if (dimension(simplex) < 2) return false;
    ChartEdge edge{record.z, record.along};
    OwnedSimplex carrier{record.tet, simplex};
    if (dimension(simplex) == 2) {
      const FaceOfOwner owned(map_.topology, record.tet, oppositeCorner(simplex));
      carrier = owned.simplex();
      edge = owned.carry(edge, map_.exact.transitions);
    }
    std::array<Index, 2> ends = record.ends;
    if (signOf(edge.along) < 0) std::swap(ends[0], ends[1]);
    const std::size_t before = pieces_.points();
    pieces_.addSegment(carrier);
    finish(before, ends, carrier.tet, edge.ascending());
    return true;
  }
  /// Traces the edge from its midpoint.
  void traceExactly(const EdgeRecord& record, std::span<const HalfFace> faces) {
    const SimplexInTet middle = ownedMiddle(findMiddle(record, faces));
    const ChartEdge edge = ChartEdge{middle.frame.origin, middle.frame.axes[0]}.ascending();
    const std::size_t before = pieces_.points();
    const int axis = axisOf(edge.along);
    const auto ends = tracer_.trace({middle.tet, middle.simplex, Frame::along(edge.z, axis)});
    finish(before, ends, middle.tet, edge);
  }
  /// A simplex with the midpoint, in one of the tets that the edge was followed through.
  [[nodiscard]] SimplexInTet findMiddle(const EdgeRecord& record,
                                        std::span<const HalfFace> faces) const {
    ChartEdge at{record.z, record.along};
    Index tet = record.tet;
    for (std::size_t i = 0;; ++i) {
      const ChartEdge edge = at.ascending();
      const int axis = axisOf(edge.along);
      LatticePoint middle;
      for (std::size_t k = 0; k < 3; ++k) middle[k] = edge.z[k] * unit_;
      middle[static_cast<std::size_t>(axis)] += unit_ / 2;
      const LatticeTet& corners = map_.exact.corners[tet];
      const CornerMask simplex =
          simplexBySides([&](std::size_t face) { return sideOfFace(corners, face, middle); });
      if (simplex != kNoSimplex) return {tet, simplex, Frame::along(edge.z, axis)};
      if (i == faces.size()) break;
      at = at.across(map_.exact.transitions, faces[i]);
      tet = tetOf(map_.topology.mate[faces[i]]);
    }
    ArcTracer::fail(record.tet, "a hex edge was not followed through its midpoint");
  }
  /// The same in the smallest tet.
  [[nodiscard]] SimplexInTet ownedMiddle(const SimplexInTet& middle) {
    SimplexInTet owned = middle;
    star_.visit(middle, [&](const SimplexInTet& here) {
      if (here.tet < owned.tet) owned = here;
      return false;
    });
    return owned;
  }

  const PreparedMap& map_;
  const SharedCounts& counts_;
  std::int64_t unit_;
  BlockArcs& arcs_;
  ArcPieces& pieces_;
  const LatticeNumbers& vertices_;
  EdgeTracer tracer_;
  SimplexStar star_;
  Index owner_ = kNone;  ///< of the midpoint
  ChartEdge middle_{};   ///< the edge there
};

}  // namespace

BlockArcs replayEdges(const PreparedMap& map, const LatticeNumbers& vertices,
                      const EdgeRecords& records, const SharedCounts& counts) {
  BlockArcs arcs;
  EdgeReplay(map, vertices, counts, arcs).run(records);
  return arcs;
}

}  // namespace hexhex
