#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include <curved/arc_pieces.hpp>
#include <curved/arc_tracer.hpp>
#include <curved/arcs.hpp>
#include <curved/output_waves.hpp>

namespace hexhex {

namespace {

/// The largest double below 1.
constexpr double kBelowOne = 1 - 0x1p-53;

/// Traces the edges that a block of tets owns.
class BlockTracer {
 public:
  BlockTracer(const PreparedMap& map, const LatticeNumbers& vertices, Arcs& arcs, ArcPieces& pieces)
      : map_(map), vertices_(vertices), arcs_(arcs), pieces_(pieces), tracer_(map, vertices) {}

  void trace(Index tet, const ElementNumbers::Row& row) {
    const GridPoint& begin = row.front().z;
    const int axis = row.front().axis;
    // Early, as who copies it has to wait until memory has all its parts.
    middle_ = {tet, kWholeTet, Frame::along(begin, axis)};
    if (!vertices_.hasVertices(tet)) {
      row.forEach([&](const Element& edge) { trace(edge, row.along(), {}, {}); });
      return;
    }
    const GridPoint end = step(begin, direction(axis, 1));
    LatticeNumbers::OnLine beginnings(vertices_, tet, begin, row.along(), fromHint_);
    LatticeNumbers::OnLine ends(vertices_, tet, end, row.along(), toHint_);
    row.forEach([&](const Element& edge) {
      trace(edge, row.along(), beginnings.find(edge.z),
            ends.find(step(edge.z, direction(axis, 1))));
    });
  }

 private:
  using Found = LatticeNumbers::Found;

  /// @param along     in which coordinate the edge differs from others of its row
  /// @param from, to  what the tet has of the edge's ends
  void trace(const Element& edge, std::size_t along, const Found& from, const Found& to) {
    if (from.vertex != kNone && to.vertex != kNone) {
      // By convexity, all between lies in the smallest simplex that contains both ends.
      arcs_.ends[edge.number] = {from.vertex, to.vertex};
      arcs_.pointBegin[edge.number] = 0;
      addSegment({middle_.tet, static_cast<CornerMask>(from.simplex | to.simplex), {}});
      return;
    }
    const std::size_t before = pieces_.points();
    middle_.frame.origin[along] = edge.z[along];
    middle_.simplex = edge.simplex;
    arcs_.ends[edge.number] = edge.simplex == kWholeTet ? traceBothWays(middle_, from, to)
                                                        : traceFromBeginning(middle_, from);
    arcs_.pointBegin[edge.number] = pieces_.points() - before;
    smoothParameters(pieces_.parametersFrom(before));
  }

  /// From a midpoint inside a tet.
  /// @param from, to  what the tet has of the edge's ends
  [[nodiscard]] std::array<Index, 2> traceBothWays(const SimplexInTet& middle, const Found& from,
                                                   const Found& to) {
    const LatticeTet seen = middle.frame.see(map_.exact.corners[middle.tet], map_.exact.unit);
    const EdgeSides sides(seen);
    std::array<Index, 2> ends = {from.vertex, to.vertex};
    // Both at once, so that memory answers to one while the other is followed.
    if (from.vertex == kNone) tracer_.begin(Way::Backward, middle, seen, sides);
    if (to.vertex == kNone) tracer_.begin(Way::Forward, middle, seen, sides);
    if (from.vertex == kNone) {
      ends[0] = traceBack();
    } else {
      addSegment(middle);
    }
    if (to.vertex != kNone) return ends;
    bool atMiddle = true;
    const ArcEnd last =
        tracer_.followBegun(Way::Forward, [&](const SimplexInTet& carrier, const ArcExit& exit) {
          if (!atMiddle) addSegment(carrier);
          atMiddle = false;
          pieces_.addPoint(exit, exit.parameter);
        });
    addSegment(last.carrier);
    ends[1] = last.vertex;
    return ends;
  }

  /// Adds what there is from the beginning to the segment at the midpoint.
  /// @return the vertex at the beginning
  [[nodiscard]] Index traceBack() {
    const std::size_t firstPoint = pieces_.points();
    const std::size_t firstSegment = pieces_.segments();
    const ArcEnd first =
        tracer_.followBegun(Way::Backward, [&](const SimplexInTet& carrier, const ArcExit& exit) {
          addSegment(carrier);
          pieces_.addPoint(exit, 1 - exit.parameter);
        });
    addSegment(first.carrier);
    pieces_.reverseFrom(firstPoint, firstSegment);
    return first.vertex;
  }

  /// From a midpoint on the boundary of tets: back to the beginning, then all the way.
  /// @param from  what the tet has of the beginning
  [[nodiscard]] std::array<Index, 2> traceFromBeginning(const SimplexInTet& middle,
                                                        const Found& from) {
    ArcEnd first{{middle.tet, static_cast<CornerMask>(middle.simplex | from.simplex), middle.frame},
                 from.vertex};
    if (from.vertex == kNone) {
      const SimplexInTet turned{middle.tet, middle.simplex, middle.frame.reversed()};
      first = tracer_.follow(tracer_.behind(turned), [](const SimplexInTet&, const ArcExit&) {});
      first.carrier.frame = first.carrier.frame.reversed();
    }
    const ArcEnd last =
        tracer_.follow(first.carrier, [&](const SimplexInTet& carrier, const ArcExit& exit) {
          addSegment(carrier);
          pieces_.addPoint(exit, exit.parameter);
        });
    addSegment(last.carrier);
    return {first.vertex, last.vertex};
  }

  void addSegment(const SimplexInTet& carrier) {
    pieces_.addSegment(ownedBy(map_.topology, carrier.tet, carrier.simplex));
  }

  /// Exact values are in (0, 1) and ascend; rounding may not change that.
  static void smoothParameters(std::span<double> parameters) {
    double low = std::numeric_limits<double>::min();
    for (double& parameter : parameters) parameter = low = std::clamp(parameter, low, kBelowOne);
  }

  const PreparedMap& map_;
  const LatticeNumbers& vertices_;
  Arcs& arcs_;
  ArcPieces& pieces_;
  ArcTracer tracer_;
  SimplexInTet middle_;  ///< the midpoint of the edge at hand
  LineHint fromHint_;
  LineHint toHint_;
};

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
          points += pieces[block % kWaveBlocks].points();
        }
        const std::uint64_t done = edges.begin(std::min(endBlock * grain, tets));
        lengthenAll(arcs, points, points + done,
                    static_cast<double>(done) / static_cast<double>(edges.count()));
      },
      [&](std::size_t block) {
        const std::uint64_t firstPoint = firstPoints[block % kWaveBlocks];
        pieces[block % kWaveBlocks].copyTo(arcs, firstPoint,
                                           firstPoint + edges.begin(block * grain));
      });
  exclusiveScan(std::span(arcs.pointBegin));
  return arcs;
}

}  // namespace hexhex
