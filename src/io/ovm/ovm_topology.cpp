// Faces and edges are found at their smallest vertices. Neighbouring cells come close to each
// other, so that what a vertex has is in the cache when it is asked for; and all threads may work
// at the same vertex, since what they find does not depend on who comes first.
#include <algorithm>
#include <atomic>
#include <bit>
#include <mutex>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <io/ovm/ovm_cells.hpp>
#include <io/ovm/ovm_hex_topology.hpp>
#include <io/ovm/ovm_tet_topology.hpp>
#include <io/ovm/ovm_topology.hpp>

namespace hexhex {
namespace {

// A block takes some tens of microseconds at least.
constexpr std::size_t kGrain = 2048;

void requireAtMost(std::uint64_t limit, std::uint64_t count, const char* what) {
  if (count <= limit) return;
  throw Error(ErrorCode::TooLarge, "The mesh has " + std::to_string(count) + " " + what +
                                       "; files of OpenVolumeMesh hold at most " +
                                       std::to_string(limit) + ".");
}

/// Makes a value the smallest one.
void lower(std::atomic<Index>& place, Index value) {
  Index known = place.load(std::memory_order_relaxed);
  while (value < known && !place.compare_exchange_weak(known, value)) {
  }
}

/// Builds the topology of cells with k faces of n corners each.
template <class Cell, std::size_t n, std::size_t k>
class TopologyBuilder {
 public:
  using Loop = std::array<Index, n>;
  using Table = std::array<std::array<std::uint8_t, n>, k>;

  TopologyBuilder(std::size_t vertexCount, std::span<const Cell> cells, const Table& table,
                  Stage& stage)
      : cells_(cells), table_(table), stage_(stage) {
    topology_.vertexCount = vertexCount;
  }

  OvmTopology build() {
    requireAtMost(kMaxOvmEntities, topology_.vertexCount, "vertices");
    // The sides of all cells have 32-bit numbers.
    requireAtMost((kNone - 1) / k, cells_.size(), "cells");
    requireDifferentCorners();
    matchSides();
    numberFaces();
    collectEdges();
    numberEdges();
    linkFacesToEdges();
    return std::move(topology_);
  }

 private:
  /// A side, number cell * k + slot, with its vertices in ascending order.
  struct SortedSide {
    Loop vertices;
    Index side;
  };

  [[nodiscard]] Loop loopOf(Index side) const { return loopOf(side / k, side % k); }
  [[nodiscard]] Loop loopOf(std::size_t cell, std::size_t slot) const {
    Loop loop;
    for (std::size_t i = 0; i < n; ++i) loop[i] = cells_[cell][table_[slot][i]];
    return loop;
  }
  void requireDifferentCorners();
  void matchSides();
  void matchSide(std::size_t cell, std::size_t slot);
  [[nodiscard]] bool replace(Index& place, Index expected, Index value) const;
  [[nodiscard]] static std::size_t listOf(Index smallest, Index sum);
  [[nodiscard]] bool areOpposite(const Loop& here, const Loop& there) const;
  [[noreturn]] void failAt(Index vertex) const;
  [[nodiscard]] std::vector<SortedSide> sidesAt(Index vertex) const;
  void numberFaces();
  void collectEdges();
  void addEdge(Index low, Index high);
  void numberEdges();
  [[nodiscard]] std::span<const std::array<Index, 2>> overflowOf(Index low) const;
  [[nodiscard]] Index findEdge(Index low, Index high) const;
  void linkFacesToEdges();

  // So many vertices share so many lists: few enough that they stay in the cache, and so many that
  // few lists hold several faces, of tets, too, whose vertices have a dozen faces each.
  static constexpr std::size_t kNearby = 256;
  static constexpr std::size_t kLists = 8 * kNearby;
  // Few vertices of a hex mesh have more edges to larger vertices, some of a tet mesh have.
  static constexpr std::size_t kSlots = n == 4 ? 8 : 16;
  using Ends = std::array<Index, kSlots>;

  std::span<const Cell> cells_;
  const Table& table_;
  Stage& stage_;
  /// No other thread is at work, so that nothing has to be exchanged at once, which takes a
  /// processor much longer.
  const bool alone_ = currentThreads() == 1;
  OvmTopology topology_;
  // Lists of sides by smallest vertex, linked through `next_`. A list holds the side of each face
  // that came first; `sums_` tell most of them apart.
  Array<Index> first_;                 ///< per list
  Array<Index> next_;                  ///< per side
  Array<Index> sums_;                  ///< per side: of its vertices, modulo 2^32
  std::atomic<Index> faultAt_{kNone};  ///< the smallest vertex with a face that cannot be
  Array<Index> mate_;                  ///< per side: the same face in the other cell, or itself
  Array<Index> faceOwner_;             ///< per face: the side whose loop is half-face 2f
  Array<Ends> ends_;                   ///< per vertex: larger vertices of its edges, in any order
  std::mutex overflowMutex_;
  std::vector<std::array<Index, 2>> overflow_;  ///< edges without a slot; sorted at last
  Array<Index> edgeBegins_;                     ///< per vertex (+1): its edges to larger vertices
};

template <class Cell, std::size_t n, std::size_t k>
void TopologyBuilder<Cell, n, k>::requireDifferentCorners() {
  const std::size_t fault = firstFault(
      stage_, cells_.size(), [this](std::size_t c) { return !hasVertexTwice(cells_[c]); });
  if (fault == cells_.size()) return;
  throw Error(ErrorCode::RepeatedVertex,
              "Cell " + std::to_string(fault) +
                  " has a vertex twice; files of OpenVolumeMesh cannot hold that.",
              Place{PlaceKind::Cell, fault});
}

/// Whether two sides pass the same vertices in opposite directions.
template <class Cell, std::size_t n, std::size_t k>
bool TopologyBuilder<Cell, n, k>::areOpposite(const Loop& here, const Loop& there) const {
  std::size_t start = 0;
  for (std::size_t i = 1; i < n; ++i) start += there[i] == here[0] ? i : 0;
  bool opposite = true;
  for (std::size_t i = 0; i < n; ++i) opposite &= here[i] == there[(start + n - i) % n];
  return opposite;
}

/// The sides with this smallest vertex, so that those of one face follow each other.
template <class Cell, std::size_t n, std::size_t k>
auto TopologyBuilder<Cell, n, k>::sidesAt(Index vertex) const -> std::vector<SortedSide> {
  std::vector<SortedSide> sides;
  for (std::size_t side = 0; side < k * cells_.size(); ++side) {
    Loop vertices = loopOf(static_cast<Index>(side));
    std::sort(vertices.begin(), vertices.end());
    if (vertices[0] == vertex) sides.push_back({vertices, static_cast<Index>(side)});
  }
  std::stable_sort(sides.begin(), sides.end(), [](const SortedSide& a, const SortedSide& b) {
    return a.vertices < b.vertices;
  });
  return sides;
}

template <class Cell, std::size_t n, std::size_t k>
void TopologyBuilder<Cell, n, k>::failAt(Index vertex) const {
  const std::vector<SortedSide> sides = sidesAt(vertex);
  const auto sameFace = [&](std::size_t i, std::size_t j) {
    return j < sides.size() && sides[i].vertices == sides[j].vertices;
  };
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (!sameFace(i, i + 1)) continue;
    const Index cell = sides[i].side / k;
    const std::string cells =
        "cells " + std::to_string(cell) + " and " + std::to_string(sides[i + 1].side / k);
    const Place place{PlaceKind::Cell, cell};
    if (sameFace(i, i + 2)) {
      throw Error(ErrorCode::NonManifoldFace,
                  "More cells than the two " + cells +
                      " share a face; files of OpenVolumeMesh cannot hold that.",
                  place);
    }
    if (!areOpposite(loopOf(sides[i].side), loopOf(sides[i + 1].side))) {
      throw Error(ErrorCode::Orientation,
                  "The " + cells +
                      " list the corners of the face that they share in the same direction, so "
                      "one of them is inside out; files of OpenVolumeMesh cannot hold that.",
                  place);
    }
  }
  throw Error(ErrorCode::Internal, "A fault of a face was found, but not again.");
}

/// The list of a face: not that of its smallest vertex itself, which may have any number of faces,
/// but one of those nearby.
template <class Cell, std::size_t n, std::size_t k>
std::size_t TopologyBuilder<Cell, n, k>::listOf(Index smallest, Index sum) {
  constexpr Index kOdd = 0x9e3779b1U;  // without pattern: the product's upper bits depend on all
  constexpr unsigned kUnused = 32 - std::bit_width(kLists - 1);
  const std::size_t place = 8 * std::size_t{smallest} + (sum * kOdd >> kUnused);
  return smallest / kNearby * kLists + place % kLists;
}

/// @return whether the place had the value that it is expected to have
template <class Cell, std::size_t n, std::size_t k>
bool TopologyBuilder<Cell, n, k>::replace(Index& place, Index expected, Index value) const {
  if (!alone_) return std::atomic_ref(place).compare_exchange_strong(expected, value);
  if (place != expected) return false;
  place = value;
  return true;
}

/// Finds the side of the same face that came before, or puts this one into the face's list. Of two
/// that come at the same time, one finds the list changed and looks again.
template <class Cell, std::size_t n, std::size_t k>
void TopologyBuilder<Cell, n, k>::matchSide(std::size_t cell, std::size_t slot) {
  const auto side = static_cast<Index>(cell * k + slot);
  const Loop loop = loopOf(cell, slot);
  const Index smallest = *std::min_element(loop.begin(), loop.end());
  const Index sum = std::accumulate(loop.begin(), loop.end(), Index{0});
  mate_[side] = side;
  sums_[side] = sum;
  std::atomic_ref first(first_[listOf(smallest, sum)]);
  Index head = first.load(std::memory_order_acquire);
  Index searched = kNone;  // from here on, all has been looked at
  while (true) {
    for (Index other = head; other != searched; other = next_[other]) {
      if (sums_[other] != sum) continue;
      const Loop there = loopOf(other);
      if (areOpposite(loop, there)) {
        if (!replace(mate_[other], other, side)) lower(faultAt_, smallest);  // a third one
        mate_[side] = other;
        return;
      }
      if (std::is_permutation(loop.begin(), loop.end(), there.begin())) lower(faultAt_, smallest);
    }
    searched = head;
    next_[side] = head;
    if (alone_) return first.store(side, std::memory_order_relaxed);
    if (first.compare_exchange_strong(head, side, std::memory_order_acq_rel)) return;
  }
}

template <class Cell, std::size_t n, std::size_t k>
void TopologyBuilder<Cell, n, k>::matchSides() {
  const std::size_t sides = cells_.size() * k;
  first_.resize(blockCount(topology_.vertexCount, kNearby) * kLists);
  parallelFor(stage_, first_.size(), 8 * kGrain, [this](std::size_t v) { first_[v] = kNone; });
  next_.resize(sides);
  sums_.resize(sides);
  mate_.resize(sides);
  parallelFor(stage_, cells_.size(), kGrain, [this](std::size_t cell) {
    for (std::size_t slot = 0; slot < k; ++slot) matchSide(cell, slot);
  });
  if (faultAt_ != kNone) failAt(faultAt_);
  first_ = {};
  sums_ = {};
}

template <class Cell, std::size_t n, std::size_t k>
void TopologyBuilder<Cell, n, k>::numberFaces() {
  // The lists of sides are not needed any more, but memory that is in use already is fast.
  topology_.cells.length = k;
  topology_.cells.handles = std::move(next_);
  Array<Index>& halfFaces = topology_.cells.handles;
  constexpr std::size_t kBlock = k * kGrain;
  Array<std::uint64_t> begins(blockCount(mate_.size(), kBlock) + 1, 0);
  parallelBlocks(stage_, mate_.size(), kBlock,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   std::uint64_t faces = 0;
                   for (std::size_t side = begin; side < end; ++side) {
                     faces += mate_[side] >= side ? 1 : 0;
                   }
                   begins[block] = faces;
                 });
  const std::uint64_t faces = exclusiveScan(std::span(begins));
  requireAtMost(kMaxOvmEntities, faces, "faces");
  faceOwner_.resize(static_cast<std::size_t>(faces));
  parallelBlocks(stage_, mate_.size(), kBlock,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   auto face = static_cast<Index>(begins[block]);
                   for (auto side = static_cast<Index>(begin); side < end; ++side) {
                     const Index mate = mate_[side];
                     if (mate < side) continue;
                     // The corners of a cell begin with its first side, so the reader finds them in
                     // their order if that side begins where the cell does.
                     const bool mateOwns = mate % k < side % k;
                     faceOwner_[face] = mateOwns ? mate : side;
                     halfFaces[mate] = 2 * face + (mateOwns ? 0U : 1U);
                     halfFaces[side] = 2 * face + (mateOwns ? 1U : 0U);
                     ++face;
                   }
                 });
  mate_ = {};
}

/// Gives the larger vertex of an edge a slot of the smaller one, unless it has one.
template <class Cell, std::size_t n, std::size_t k>
void TopologyBuilder<Cell, n, k>::addEdge(Index low, Index high) {
  Ends& ends = ends_[low];
  if (alone_) {
    unsigned taken = 0;
    unsigned same = 0;
    for (const Index end : ends) {
      taken += end != kNone ? 1U : 0U;
      same |= end == high ? 1U : 0U;
    }
    if (same != 0) return;
    if (taken < kSlots) {
      ends[taken] = high;
    } else {
      overflow_.push_back({low, high});
    }
    return;
  }
  unsigned known = 0;
  for (Index& end : ends) {
    known |= std::atomic_ref(end).load(std::memory_order_relaxed) == high ? 1U : 0U;
  }
  if (known != 0) return;
  for (Index& end : ends) {
    Index occupied = kNone;
    if (std::atomic_ref(end).compare_exchange_strong(occupied, high) || occupied == high) return;
  }
  const std::scoped_lock lock(overflowMutex_);
  overflow_.push_back({low, high});
}

template <class Cell, std::size_t n, std::size_t k>
void TopologyBuilder<Cell, n, k>::collectEdges() {
  ends_.resize(topology_.vertexCount);
  parallelFor(stage_, ends_.size(), kGrain, [this](std::size_t v) { ends_[v].fill(kNone); });
  parallelFor(stage_, faceOwner_.size(), kGrain, [this](std::size_t face) {
    const Loop loop = loopOf(faceOwner_[face]);
    for (std::size_t i = 0; i < n; ++i) {
      addEdge(std::min(loop[i], loop[(i + 1) % n]), std::max(loop[i], loop[(i + 1) % n]));
    }
  });
  std::sort(overflow_.begin(), overflow_.end());
  overflow_.erase(std::unique(overflow_.begin(), overflow_.end()), overflow_.end());
}

/// The edges of a vertex that have no slot.
template <class Cell, std::size_t n, std::size_t k>
std::span<const std::array<Index, 2>> TopologyBuilder<Cell, n, k>::overflowOf(Index low) const {
  const auto begin =
      std::lower_bound(overflow_.begin(), overflow_.end(), std::array{low, Index{0}});
  const auto end = std::lower_bound(begin, overflow_.end(), std::array{low + 1, Index{0}});
  return {begin, end};
}

template <class Cell, std::size_t n, std::size_t k>
void TopologyBuilder<Cell, n, k>::numberEdges() {
  const std::size_t vertices = topology_.vertexCount;
  Array<std::uint64_t> begins(blockCount(vertices, kGrain) + 1, 0);
  const auto countOf = [this](std::size_t v) {
    std::size_t count = 0;
    for (const Index end : ends_[v]) count += end != kNone ? 1 : 0;
    return count == kSlots ? count + overflowOf(static_cast<Index>(v)).size() : count;
  };
  edgeBegins_.resize(vertices + 1);
  parallelBlocks(stage_, vertices, kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   std::uint64_t sum = 0;
                   for (std::size_t v = begin; v < end; ++v) sum += countOf(v);
                   begins[block] = sum;
                 });
  const std::uint64_t edges = exclusiveScan(std::span(begins));
  requireAtMost(kMaxOvmEntities, edges, "edges");
  edgeBegins_[vertices] = static_cast<Index>(edges);
  topology_.edges.resize(static_cast<std::size_t>(edges));
  parallelBlocks(stage_, vertices, kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   auto edge = static_cast<Index>(begins[block]);
                   for (auto v = static_cast<Index>(begin); v < end; ++v) {
                     edgeBegins_[v] = edge;
                     const Index first = edge;
                     for (const Index other : ends_[v]) {
                       if (other != kNone) topology_.edges[edge++] = {v, other};
                     }
                     if (edge - first == kSlots) {
                       for (const auto& further : overflowOf(v)) topology_.edges[edge++] = further;
                     }
                     std::sort(topology_.edges.begin() + first, topology_.edges.begin() + edge);
                   }
                 });
}

/// The number of an edge: as many edges of the vertex go to smaller vertices as come before it.
template <class Cell, std::size_t n, std::size_t k>
Index TopologyBuilder<Cell, n, k>::findEdge(Index low, Index high) const {
  const Ends& ends = ends_[low];
  Index smaller = 0;
  for (const Index end : ends) smaller += end < high ? 1U : 0U;
  if (ends.back() != kNone && !overflow_.empty()) {
    const auto further = overflowOf(low);
    smaller += static_cast<Index>(
        std::lower_bound(further.begin(), further.end(), std::array{low, high}) - further.begin());
  }
  return edgeBegins_[low] + smaller;
}

template <class Cell, std::size_t n, std::size_t k>
void TopologyBuilder<Cell, n, k>::linkFacesToEdges() {
  topology_.faces.length = n;
  topology_.faces.handles.resize(n * faceOwner_.size());
  parallelFor(stage_, faceOwner_.size(), kGrain, [&](std::size_t face) {
    const Loop loop = loopOf(faceOwner_[face]);
    for (std::size_t i = 0; i < n; ++i) {
      const Index from = loop[i];
      const Index to = loop[(i + 1) % n];
      topology_.faces.handles[n * face + i] =
          2 * findEdge(std::min(from, to), std::max(from, to)) + (from < to ? 0U : 1U);
    }
  });
}

}  // namespace

OvmEdgeFinder::OvmEdgeFinder(const OvmTopology& topology)
    : edges_(topology.edges), begins_(topology.vertexCount + 1) {
  std::size_t e = 0;
  for (std::size_t v = 0; v <= topology.vertexCount; ++v) {
    while (e < edges_.size() && edges_[e][0] < v) ++e;
    begins_[v] = static_cast<Index>(e);
  }
}

Index OvmEdgeFinder::find(Index a, Index b) const noexcept {
  const Index low = std::min(a, b);
  const Index high = std::max(a, b);
  if (high + std::size_t{1} >= begins_.size()) return kNone;
  const auto* const first = edges_.data() + begins_[low];
  const auto* const last = edges_.data() + begins_[low + 1];
  const auto* const found = std::find_if(
      first, last, [high](const std::array<Index, 2>& edge) { return edge[1] == high; });
  return found == last ? kNone : static_cast<Index>(found - edges_.data());
}

OvmTopology buildOvmTopology(std::size_t vertexCount, std::span<const Tet> cells, Stage& stage) {
  if (vertexCount <= kMaxOvmEntities && cells.size() < kNone / 4) {
    std::optional<OvmTopology> topology = buildOvmTetTopology(vertexCount, cells, stage);
    if (topology) return std::move(*topology);
  }
  return TopologyBuilder<Tet, 3, 4>(vertexCount, cells, kOvmTetFaces, stage).build();
}

OvmTopology buildOvmTopology(std::size_t vertexCount, std::span<const Hex> cells, Stage& stage) {
  if (vertexCount <= kMaxOvmEntities && cells.size() < kNone / 12) {
    std::optional<OvmTopology> topology = buildOvmHexTopology(vertexCount, cells, stage);
    if (topology) return std::move(*topology);
  }
  // Says what is wrong, if anything is.
  return TopologyBuilder<Hex, 4, 6>(vertexCount, cells, kOvmHexFaces, stage).build();
}

}  // namespace hexhex
