#include <algorithm>
#include <vector>

#include <base/output_batches.hpp>
#include <base/prefetch.hpp>
#include <curved/arc_pieces.hpp>
#include <curved/arcs.hpp>
#include <curved/edge_tracer.hpp>
#include <curved/tet_exits.hpp>
#include <curved/tet_faces.hpp>

namespace hexhex {

namespace {

/// Traces the edges that a block of tets owns.
class BlockTracer {
 public:
  BlockTracer(const PreparedMap& map, const LatticeNumbers& vertices, ArcPieces& pieces)
      : map_(map),
        vertices_(vertices),
        pieces_(pieces),
        tracer_(map, vertices, pieces),
        exits_(map.exact.unit),
        faces_(map) {}

  /// By exact arithmetic.
  void trace(Index tet, const ElementNumbers::Row& row) {
    // Early, as who copies it has to wait until memory has all its parts.
    middle_ = {tet, kWholeTet, Frame::along(row.front().z, row.front().axis)};
    row.forEach([&](const Element& edge) {
      middle_.frame.origin[row.along()] = edge.z[row.along()];
      middle_.simplex = edge.simplex;
      traceExactly();
    });
  }
  /// By exits in floating point, as far as they are certain.
  void traceByExits(Index tet, const ElementNumbers::Row& row) {
    const GridPoint& begin = row.front().z;
    const int axis = row.front().axis;
    lookAlong(tet, axis);
    const TetExits::Weights first = exits_.atMiddle(begin);
    const TetExits::Weights& gradient = exits_.gradient(row.along());
    double steps = 0;
    row.forEach([&](const Element& edge) {
      const TetExits::Weights middle = first.plus(gradient, steps);
      steps += 1;
      if (edge.simplex == kWholeTet && traceInside(edge, middle)) return;
      middle_ = {tet, edge.simplex, Frame::along(edge.z, axis)};
      traceExactly();
    });
  }

 private:
  /// One of the two ways from a midpoint inside a tet.
  struct WayOut {
    TetExits::Exit exit{};
    HalfFace mate = kNone;  ///< behind the face that the edge leaves through; kNone if it does not
    Index vertex = kNone;   ///< the end of the edge, if it is known
  };

  /// @return the edge's second grid point
  [[nodiscard]] static GridPoint endOf(const Element& edge) noexcept {
    return step(edge.z, direction(edge.axis, 1));
  }

  void lookAlong(Index tet, int axis) {
    if (tet != tet_) {
      exits_.enter(map_.exact.corners[tet]);
      faces_.enter(tet);
    }
    if (tet != tet_ || axis != axis_) exits_.turn(axis);
    tet_ = tet;
    axis_ = axis;
  }

  /// From a midpoint inside a tet, as far as it is certain which faces the edge leaves it through.
  /// @return false, without having done anything, if it is not
  [[nodiscard]] bool traceInside(const Element& edge, const TetExits::Weights& middle) {
    const TetExits::Zeros zeros = exits_.zeros(middle);
    WayOut back;
    WayOut ahead;
    back.exit = exits_.exit<Way::Backward>(zeros);
    ahead.exit = exits_.exit<Way::Forward>(zeros);
    if (!leave(back, middle, -back.exit.at) || !leave(ahead, middle, ahead.exit.at)) return false;
    if (back.mate == kNone) back.vertex = vertices_.find(tet_, edge.z).vertex;
    if (ahead.mate == kNone) ahead.vertex = vertices_.find(tet_, endOf(edge)).vertex;
    if ((back.mate == kNone && back.vertex == kNone) ||
        (ahead.mate == kNone && ahead.vertex == kNone)) {
      return false;
    }
    const std::size_t before = pieces_.points();
    const Index first = goBack(edge, back);
    pieces_.addSegment({tet_, kWholeTet});
    finish(before, {first, goAhead(edge, ahead)});
    return true;
  }

  /// @param distance  to the exit
  /// @return whether it is certain that the edge leaves the tet, and where, or that it does not
  [[nodiscard]] bool leave(WayOut& way, const TetExits::Weights& middle, double distance) {
    const TetExits::End end = exits_.endAt(distance);
    if (end != TetExits::End::Beyond) return end == TetExits::End::Inside;
    if (!exits_.point(middle, way.exit).sure) return false;
    const HalfFace halfFace = halfFaceOf(tet_, way.exit.face);
    way.mate = map_.topology.mate[halfFace];
    if (way.mate == kNone) return false;
    vertices_.fetch(tetOf(way.mate));
    const Transitions& transitions = map_.exact.transitions;
    prefetch(&transitions.table[transitions.jump[halfFace]]);
    return true;
  }

  [[nodiscard]] Index goBack(const Element& edge, WayOut& way) {
    if (way.mate == kNone) return way.vertex;
    const Index vertex = vertexBehind(way, edge.z);
    if (vertex != kNone) {
      pieces_.addSegment({tetOf(way.mate), kWholeTet});
      addExit(edge, way);
      return vertex;
    }
    const SimplexInTet back{tet_, kWholeTet, Frame::along(edge.z, axis_).reversed()};
    return tracer_.traceBack([&](const auto& visit) {
      addExit(edge, way);
      return tracer_.tracer().followThrough(way.exit.face, back, visit);
    });
  }
  [[nodiscard]] Index goAhead(const Element& edge, WayOut& way) {
    if (way.mate == kNone) return way.vertex;
    const Index vertex = vertexBehind(way, endOf(edge));
    if (vertex != kNone) {
      addExit(edge, way);
      pieces_.addSegment({tetOf(way.mate), kWholeTet});
      return vertex;
    }
    const SimplexInTet middle{tet_, kWholeTet, Frame::along(edge.z, axis_)};
    return tracer_.traceAhead([&](const auto& visit) {
      visit(middle, exitOf(edge, way));
      return tracer_.tracer().followThrough(way.exit.face, middle, visit);
    });
  }
  /// @param z  the end of the edge
  [[nodiscard]] Index vertexBehind(const WayOut& way, const GridPoint& z) const {
    return tracer_.tracer().vertexBehind(halfFaceOf(tet_, way.exit.face), way.mate, z);
  }
  [[nodiscard]] ArcExit exitOf(const Element& edge, const WayOut& way) {
    return faces_.exit(way.exit.face, {edge.z, direction(edge.axis, 1)});
  }
  void addExit(const Element& edge, const WayOut& way) {
    const ArcExit exit = exitOf(edge, way);
    pieces_.addPoint(exit, exit.parameter);
  }

  /// From the midpoint, wherever that is.
  void traceExactly() {
    const std::size_t before = pieces_.points();
    finish(before, tracer_.trace(middle_));
  }
  /// @param before  how many points there were before the edge
  void finish(std::size_t before, const std::array<Index, 2>& ends) {
    pieces_.addArc(ends, before);
    EdgeTracer::smoothParameters(pieces_, before);
  }

  const PreparedMap& map_;
  const LatticeNumbers& vertices_;
  ArcPieces& pieces_;
  EdgeTracer tracer_;
  TetExits exits_;
  TetFaces faces_;
  Index tet_ = kNone;    ///< that exits are known of
  int axis_ = -1;        ///< of its chart, along which
  SimplexInTet middle_;  ///< the midpoint of the edge at hand
};

}  // namespace

Arcs traceArcs(const PreparedMap& map, const LatticeNumbers& vertices, const ElementNumbers& edges,
               Stage& stage, std::uint64_t enough) {
  Arcs arcs;
  arcs.ends.resize(edges.count());
  arcs.pointBegin.resize(edges.count() + 1);
  const std::size_t tets = map.topology.tetCount();
  const std::size_t grain = tetsPerBlock(edges.count(), tets);
  std::vector<ArcPieces> pieces(blocksPerBatch(blockCount(tets, grain)));
  std::vector<std::uint64_t> firstPoints(pieces.size());
  std::uint64_t points = 0;
  parallelBatches(
      stage, tets, grain, pieces.size(),
      [&](std::size_t begin, std::size_t end, std::size_t block) {
        pieces[block % pieces.size()].clear();
        BlockTracer tracer(map, vertices, pieces[block % pieces.size()]);
        for (std::size_t t = begin; t < end; ++t) {
          const auto tet = static_cast<Index>(t);
          const bool byExits = edges.begin(t + 1) - edges.begin(t) >= enough;
          edges.forEachRow(tet, [&](const ElementNumbers::Row& row) {
            if (byExits) {
              tracer.traceByExits(tet, row);
            } else {
              tracer.trace(tet, row);
            }
          });
        }
      },
      [&](std::size_t firstBlock, std::size_t endBlock) {
        for (std::size_t block = firstBlock; block < endBlock; ++block) {
          firstPoints[block % pieces.size()] = points;
          points += pieces[block % pieces.size()].points();
        }
        lengthenForPieces(arcs, points, edges.begin(std::min(endBlock * grain, tets)));
      },
      [&](std::size_t block) {
        const std::size_t slot = block % pieces.size();
        pieces[slot].copyTo({arcs, edges.begin(block * grain), firstPoints[slot]}, 0, 0);
      });
  arcs.pointBegin.back() = points;
  return arcs;
}

}  // namespace hexhex
