#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include <curved/arc_tracer.hpp>
#include <curved/arcs.hpp>
#include <curved/output_waves.hpp>

namespace hexhex {

namespace {

/// The largest double below 1.
constexpr double kBelowOne = 1 - 0x1p-53;

/// An inner point of an arc.
struct Crossing {
  Vec3 point;
  double parameter;
  OwnedSimplex generator;
};

/// Inner points and segments of consecutive arcs.
struct ArcPieces {
  std::vector<Crossing> crossings;
  std::vector<OwnedSimplex> segments;

  void clear() {
    crossings.clear();
    segments.clear();
  }
};

/// Traces the edges that a block of tets owns.
class BlockTracer {
 public:
  BlockTracer(const PreparedMap& map, const LatticeNumbers& vertices, Arcs& arcs, ArcPieces& pieces)
      : map_(map),
        vertices_(vertices),
        arcs_(arcs),
        pieces_(pieces),
        unit_(static_cast<double>(map.exact.unit)),
        tracer_(map, vertices) {}

  void trace(Index tet, const ElementNumbers::Row& row) {
    const GridPoint& begin = row.front().z;
    const int axis = row.front().axis;
    const GridPoint end = step(begin, direction(axis, 1));
    LatticeNumbers::OnLine beginnings(vertices_, tet, begin, row.along(), fromHint_);
    LatticeNumbers::OnLine ends(vertices_, tet, end, row.along(), toHint_);
    row.forEach([&](const Element& edge) {
      trace(tet, edge, beginnings.find(edge.z), ends.find(step(edge.z, direction(axis, 1))));
    });
  }

 private:
  using Found = LatticeNumbers::Found;

  /// @param from, to  what the tet has of the edge's ends
  void trace(Index tet, const Element& edge, const Found& from, const Found& to) {
    if (from.vertex != kNone && to.vertex != kNone) {
      // By convexity, all between lies in the smallest simplex that contains both ends.
      arcs_.ends[edge.number] = {from.vertex, to.vertex};
      arcs_.pointBegin[edge.number] = 0;
      addSegment({tet, static_cast<CornerMask>(from.simplex | to.simplex), {}});
      return;
    }
    const std::size_t before = pieces_.crossings.size();
    const SimplexInTet middle{tet, edge.simplex, Frame::along(edge.z, edge.axis)};
    arcs_.ends[edge.number] = edge.simplex == kWholeTet ? traceBothWays(middle, from, to)
                                                        : traceFromBeginning(middle, from);
    arcs_.pointBegin[edge.number] = pieces_.crossings.size() - before;
    smoothParameters(std::span(pieces_.crossings).subspan(before));
  }

  /// From a midpoint inside a tet.
  /// @param from, to  what the tet has of the edge's ends
  [[nodiscard]] std::array<Index, 2> traceBothWays(const SimplexInTet& middle, const Found& from,
                                                   const Found& to) {
    std::array<Index, 2> ends = {from.vertex, to.vertex};
    if (from.vertex == kNone) {
      ends[0] = traceBack(middle);
    } else {
      addSegment(middle);
    }
    if (to.vertex != kNone) return ends;
    bool atMiddle = true;
    const ArcEnd last = tracer_.followBeyond(tracer_.in(middle),
                                             [&](const SimplexInTet& carrier, const ArcExit& exit) {
                                               if (!atMiddle) addSegment(carrier);
                                               atMiddle = false;
                                               pieces_.crossings.push_back(crossingAt(exit));
                                             });
    addSegment(last.carrier);
    ends[1] = last.vertex;
    return ends;
  }

  /// Adds what there is from the beginning to the segment at the midpoint.
  /// @return the vertex at the beginning
  [[nodiscard]] Index traceBack(const SimplexInTet& middle) {
    back_.clear();
    const ArcEnd first = tracer_.followBeyond(
        tracer_.in({middle.tet, middle.simplex, reversed(middle.frame)}),
        [&](const SimplexInTet& carrier, const ArcExit& exit) {
          back_.segments.push_back(carrierOf(carrier));
          back_.crossings.push_back(crossingAt(exit));
          back_.crossings.back().parameter = 1 - back_.crossings.back().parameter;
        });
    addSegment(first.carrier);
    pieces_.segments.insert(pieces_.segments.end(), back_.segments.rbegin(), back_.segments.rend());
    pieces_.crossings.insert(pieces_.crossings.end(), back_.crossings.rbegin(),
                             back_.crossings.rend());
    return first.vertex;
  }

  /// From a midpoint on the boundary of tets: back to the beginning, then all the way.
  /// @param from  what the tet has of the beginning
  [[nodiscard]] std::array<Index, 2> traceFromBeginning(const SimplexInTet& middle,
                                                        const Found& from) {
    ArcEnd first{{middle.tet, static_cast<CornerMask>(middle.simplex | from.simplex), middle.frame},
                 from.vertex};
    if (from.vertex == kNone) {
      const SimplexInTet turned{middle.tet, middle.simplex, reversed(middle.frame)};
      first = tracer_.follow(tracer_.behind(turned), [](const SimplexInTet&, const ArcExit&) {});
      first.carrier.frame = reversed(first.carrier.frame);
    }
    const ArcEnd last = tracer_.follow(tracer_.in(first.carrier),
                                       [&](const SimplexInTet& carrier, const ArcExit& exit) {
                                         addSegment(carrier);
                                         pieces_.crossings.push_back(crossingAt(exit));
                                       });
    addSegment(last.carrier);
    return {first.vertex, last.vertex};
  }

  /// The same edge from its other end.
  static Frame reversed(const Frame& frame) {
    return {frame.at({1, 0, 0}), {opposite(frame.axes[0]), opposite(frame.axes[1]), frame.axes[2]}};
  }

  [[nodiscard]] OwnedSimplex carrierOf(const SimplexInTet& carrier) const {
    return ownedBy(map_.topology, carrier.tet, carrier.simplex);
  }
  void addSegment(const SimplexInTet& carrier) { pieces_.segments.push_back(carrierOf(carrier)); }

  [[nodiscard]] Crossing crossingAt(const ArcExit& exit) const {
    double sum = 0;
    for (std::size_t i = 0; i < exit.count; ++i) sum += exit.weights[i];
    Crossing crossing{{}, 0, exit.generator};
    for (std::size_t i = 0; i < exit.count; ++i) {
      const double share = exit.weights[i] / sum;
      const Vec3& corner = map_.input.view.points[exit.vertices[i]];
      for (std::size_t k = 0; k < 3; ++k) crossing.point[k] += share * corner[k];
      crossing.parameter += share * exit.places[i];
    }
    crossing.parameter /= unit_;
    return crossing;
  }

  /// Exact values are in (0, 1) and ascend; rounding may not change that.
  static void smoothParameters(std::span<Crossing> arc) {
    double low = std::numeric_limits<double>::min();
    for (Crossing& crossing : arc) {
      crossing.parameter = low = std::clamp(crossing.parameter, low, kBelowOne);
    }
  }

  const PreparedMap& map_;
  const LatticeNumbers& vertices_;
  Arcs& arcs_;
  ArcPieces& pieces_;
  double unit_;
  ArcTracer tracer_;
  ArcPieces back_;
  LineHint fromHint_;
  LineHint toHint_;
};

/// Copies the pieces of a block to their places.
void join(const ArcPieces& pieces, std::uint64_t firstPoint, std::uint64_t firstSegment,
          Arcs& arcs) {
  for (std::size_t i = 0; i < pieces.crossings.size(); ++i) {
    const Crossing& crossing = pieces.crossings[i];
    arcs.points[firstPoint + i] = crossing.point;
    arcs.parameters[firstPoint + i] = crossing.parameter;
    arcs.generatorTet[firstPoint + i] = crossing.generator.tet;
    arcs.generatorCorners[firstPoint + i] = crossing.generator.corners;
  }
  for (std::size_t i = 0; i < pieces.segments.size(); ++i) {
    arcs.segmentTet[firstSegment + i] = pieces.segments[i].tet;
    arcs.segmentCorners[firstSegment + i] = pieces.segments[i].corners;
  }
}

/// Makes room.
/// @param share  of all arcs whose pieces have room then
void lengthenAll(Arcs& arcs, std::uint64_t points, std::uint64_t segments, double share) {
  lengthen(arcs.points, points, share);
  lengthen(arcs.parameters, points, share);
  lengthen(arcs.generatorTet, points, share);
  lengthen(arcs.generatorCorners, points, share);
  lengthen(arcs.segmentTet, segments, share);
  lengthen(arcs.segmentCorners, segments, share);
}

}  // namespace

Arcs traceArcs(const PreparedMap& map, const LatticeNumbers& vertices, const ElementNumbers& edges,
               Stage& stage) {
  Arcs arcs;
  arcs.ends.resize(edges.count());
  arcs.pointBegin.resize(edges.count() + 1);
  arcs.pointBegin.back() = 0;
  const std::size_t tets = map.topology.tetCount();
  const std::size_t grain = tetsPerBlock(edges.count(), tets);
  std::vector<ArcPieces> pieces(std::min(kWaveBlocks, blockCount(tets, grain)));
  std::vector<std::uint64_t> firstPoints(pieces.size());
  std::uint64_t points = 0;
  parallelWaves(
      stage, tets, grain,
      [&](std::size_t begin, std::size_t end, std::size_t block) {
        pieces[block % kWaveBlocks].clear();
        BlockTracer tracer(map, vertices, arcs, pieces[block % kWaveBlocks]);
        for (std::size_t t = begin; t < end; ++t) {
          const auto tet = static_cast<Index>(t);
          edges.forEachRow(tet, [&](const ElementNumbers::Row& row) { tracer.trace(tet, row); });
        }
      },
      [&](std::size_t firstBlock, std::size_t endBlock) {
        for (std::size_t block = firstBlock; block < endBlock; ++block) {
          firstPoints[block % kWaveBlocks] = points;
          points += pieces[block % kWaveBlocks].crossings.size();
        }
        const std::uint64_t done = edges.begin(std::min(endBlock * grain, tets));
        lengthenAll(arcs, points, points + done,
                    static_cast<double>(done) / static_cast<double>(edges.count()));
      },
      [&](std::size_t block) {
        const std::uint64_t firstPoint = firstPoints[block % kWaveBlocks];
        join(pieces[block % kWaveBlocks], firstPoint, firstPoint + edges.begin(block * grain),
             arcs);
      });
  exclusiveScan(std::span(arcs.pointBegin));
  return arcs;
}

}  // namespace hexhex
