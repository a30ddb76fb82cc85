#include <algorithm>
#include <vector>

#include <base/output_batches.hpp>
#include <curved/arc_tracer.hpp>
#include <curved/arcs.hpp>

namespace hexhex {

namespace {

/// Traces the edges that some tets own.
void traceEdges(const PreparedMap& map, const VertexTables& vertices, const ElementNumbers& edges,
                std::size_t begin, std::size_t end, ArcPieces& pieces) {
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

Arcs traceArcs(const PreparedMap& map, const VertexTables& vertices, const ElementNumbers& edges,
               Stage& stage) {
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
        traceEdges(map, vertices, edges, begin, end, pieces[block % pieces.size()]);
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
        pieces[slot].copyTo(arcs, edges.begin(block * grain), firstPoints[slot]);
      });
  arcs.pointBegin.back() = points;
  return arcs;
}

}  // namespace hexhex
