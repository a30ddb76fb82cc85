#include <algorithm>
#include <bit>

#include <adjacency/hex_topology.hpp>

#include <base/parallel.hpp>
#include <io/ovm/ovm_seam_edges.hpp>

namespace hexhex {
namespace {

constexpr std::size_t kGrain = 2048;

/// By the corners of a cell that are on seams: its edges between them, as bits.
constexpr std::array<std::uint16_t, 256> makeEdgesBetween() {
  std::array<std::uint16_t, 256> result{};
  for (unsigned corners = 0; corners < 256; ++corners) {
    for (unsigned e = 0; e < 12; ++e) {
      const auto& [i, k] = kHexEdges[e];
      if ((corners >> i & corners >> k & 1U) == 0) continue;
      result[corners] = static_cast<std::uint16_t>(result[corners] | 1U << e);
    }
  }
  return result;
}
constexpr std::array<std::uint16_t, 256> kEdgesBetween = makeEdgesBetween();

/// Calls f(smaller vertex, larger vertex) for the edges of all cells between seam vertices.
template <class F>
void forEachSeamEdge(std::span<const Hex> cells, std::span<const std::uint8_t> seamCorners,
                     Stage& stage, const F& f) {
  parallelFor(stage, cells.size(), kGrain, [&](std::size_t c) {
    for (unsigned edges = kEdgesBetween[seamCorners[c]]; edges != 0; edges &= edges - 1) {
      const auto& [i, k] = kHexEdges[static_cast<std::size_t>(std::countr_zero(edges))];
      f(std::min(cells[c][i], cells[c][k]), std::max(cells[c][i], cells[c][k]));
    }
  });
}

}  // namespace

SeamEdges::SeamEdges(std::size_t vertexCount, std::span<const Hex> cells,
                     std::span<const std::uint8_t> seamCorners, Stage& stage)
    : ends_(vertexCount, stage), firsts_(vertexCount + 1) {
  forEachSeamEdge(cells, seamCorners, stage,
                  [this](Index low, Index /*high*/) { ends_.count(low); });
  ends_.makeRoom();
  forEachSeamEdge(cells, seamCorners, stage,
                  [this](Index low, Index high) { ends_.enter(low, high); });
  parallelFor(stage, vertexCount, kGrain, [this](std::size_t v) {
    const std::span<Index> ends = ends_.at(v);
    std::sort(ends.begin(), ends.end());
    firsts_[v] = static_cast<Index>(std::unique(ends.begin(), ends.end()) - ends.begin());
  });
  exclusiveScan(std::span(firsts_));
}

Index SeamEdges::halfEdge(Index from, Index to) const noexcept {
  const Index low = std::min(from, to);
  const Index* const ends = ends_.at(low).data();
  const Index* const last = ends + (firsts_[low + std::size_t{1}] - firsts_[low]);
  const Index* const found = std::lower_bound(ends, last, std::max(from, to));
  return 2 * (firsts_[low] + static_cast<Index>(found - ends)) + (from < to ? 0U : 1U);
}

void SeamEdges::list(std::array<Index, 2>* edges, Stage& stage) const {
  parallelFor(stage, firsts_.size() - 1, kGrain, [&](std::size_t v) {
    const std::span<const Index> ends = ends_.at(v);
    for (std::size_t i = firsts_[v]; i < firsts_[v + 1]; ++i) {
      edges[i] = {static_cast<Index>(v), ends[i - firsts_[v]]};
    }
  });
}

}  // namespace hexhex
