#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include <curved/arc_order.hpp>
#include <curved/edge_replay.hpp>
#include <curved/element_numbers.hpp>
#include <curved/recorded_arcs.hpp>

#include <base/parallel.hpp>
#include <base/shared_counts.hpp>

namespace hexhex {

namespace {

/// Copies arcs from where they were made to where they belong.
Arcs collectArcs(std::span<const BlockArcs> blocks, std::span<const ArcPlace> places,
                 Array<std::uint64_t> pointBegin, Stage& stage) {
  constexpr std::size_t kArcs = 1024;
  const std::size_t count = places.size();
  const std::uint64_t points = pointBegin.back();
  Arcs arcs;
  arcs.pointBegin = std::move(pointBegin);
  arcs.ends.resize(count);
  arcs.points.resize(points);
  arcs.parameters.resize(points);
  arcs.generatorTet.resize(points);
  arcs.generatorCorners.resize(points);
  arcs.segmentTet.resize(points + count);
  arcs.segmentCorners.resize(points + count);
  const auto piecesOf = [&](std::size_t arc) -> const ArcPieces& {
    return blocks[places[arc].block].pieces;
  };
  parallelFor(stage, count, kArcs, [&](std::size_t arc) {
    // Early, as arcs come from all over memory.
    constexpr std::size_t kSoon = 8;
    constexpr std::size_t kLater = 16;
    if (arc + kLater < count) piecesOf(arc + kLater).fetchArc(places[arc + kLater].number);
    if (arc + kSoon < count) piecesOf(arc + kSoon).fetchPieces(places[arc + kSoon].number);
    piecesOf(arc).copyArc(places[arc].number, arcs, arc, arcs.pointBegin[arc]);
  });
  return arcs;
}

}  // namespace

Arcs gatherArcs(const PreparedMap& map, const LatticeNumbers& vertices,
                std::vector<EdgeRecords> records, Stage& stage) {
  std::vector<BlockArcs> blocks(records.size());
  Array<Index> counts(map.topology.tetCount());
  std::fill(counts.begin(), counts.end(), 0);
  const SharedCounts shared(counts);
  parallelFor(stage, records.size(), 1, [&](std::size_t block) {
    const EdgeRecords own = std::move(records[block]);  // gives its memory back early
    blocks[block] = replayEdges(map, vertices, own, shared);
  });
  std::uint64_t count = 0;
  for (const BlockArcs& block : blocks) count += block.keys.size();
  requireNumbers(count);
  ArcOrder order = orderArcs(map, blocks, counts, stage);
  return collectArcs(blocks, order.places, std::move(order.pointBegin), stage);
}

}  // namespace hexhex
