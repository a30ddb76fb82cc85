#include <algorithm>
#include <vector>

#include <curved/arc_tracer.hpp>
#include <curved/arcs.hpp>

namespace hexhex::curved {

namespace {

/// Traces the edges that some tets own.
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
  arcs.pointBegin.back() = points;
  return arcs;
}

}  // namespace hexhex::curved
