#include <algorithm>
#include <atomic>
#include <string>
#include <vector>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <io/ovm_first_fault.hpp>
#include <io/ovm_topology.hpp>

namespace hexhex {
namespace {

// A block takes some tens of microseconds at least.
constexpr std::size_t kGrain = 2048;

/// Groups numbers 0 ... n - 1 by key: the numbers with key k are those in [begins[k], begins[k +
/// 1]) of `members`, in ascending order.
struct Groups {
  Array<std::uint64_t> begins;
  Array<Index> members;

  [[nodiscard]] std::span<Index> operator[](std::size_t key) {
    return {members.data() + begins[key], members.data() + begins[key + 1]};
  }
};

template <class KeyOf>
Groups groupByKey(std::size_t keys, std::size_t n, const KeyOf& keyOf, Stage& stage) {
  Groups groups;
  groups.begins.assign(keys + 1, 0);
  parallelFor(stage, n, kGrain, [&](std::size_t i) {
    std::atomic_ref(groups.begins[keyOf(i)]).fetch_add(1, std::memory_order_relaxed);
  });
  exclusiveScan(std::span(groups.begins));
  groups.members.resize(n);
  // begins[k] serves as the cursor of k, and ends where k + 1 begins.
  parallelFor(stage, n, kGrain, [&](std::size_t i) {
    const std::uint64_t place =
        std::atomic_ref(groups.begins[keyOf(i)]).fetch_add(1, std::memory_order_relaxed);
    groups.members[place] = static_cast<Index>(i);
  });
  for (std::size_t k = keys; k > 0; --k) groups.begins[k] = groups.begins[k - 1];
  groups.begins[0] = 0;
  // Threads came in any order.
  parallelFor(stage, keys, kGrain,
              [&](std::size_t k) { std::sort(groups[k].begin(), groups[k].end()); });
  return groups;
}

void requireAtMost(std::uint64_t limit, std::uint64_t count, const char* what) {
  if (count <= limit) return;
  throw Error(ErrorCode::TooLarge, "The mesh has " + std::to_string(count) + " " + what +
                                       "; files of OpenVolumeMesh hold at most " +
                                       std::to_string(limit) + ".");
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
    buildEdges();
    linkFacesToEdges();
    return std::move(topology_);
  }

 private:
  /// A side, number cell * k + slot, with its vertices in ascending order.
  struct SortedSide {
    Loop vertices;
    Index side;
  };

  [[nodiscard]] Loop loopOf(Index side) const {
    const Cell& cell = cells_[side / k];
    Loop loop;
    for (std::size_t i = 0; i < n; ++i) loop[i] = cell[table_[side % k][i]];
    return loop;
  }
  void requireDifferentCorners();
  void matchSides();
  [[nodiscard]] bool matchAt(std::span<const Index> sides, std::vector<SortedSide>& scratch);
  [[noreturn]] void failAt(std::span<const Index> sides, std::vector<SortedSide>& scratch) const;
  void collect(std::span<const Index> sides, std::vector<SortedSide>& scratch) const;
  [[nodiscard]] bool areOpposite(Index a, Index b) const;
  void numberFaces();
  void buildEdges();
  void linkFacesToEdges();

  std::span<const Cell> cells_;
  const Table& table_;
  Stage& stage_;
  OvmTopology topology_;
  Array<Index> mate_;       ///< per side: the same face in the other cell, or the side itself
  Array<Index> faceOwner_;  ///< per face: the side whose loop is half-face 2f
};

template <class Cell, std::size_t n, std::size_t k>
void TopologyBuilder<Cell, n, k>::requireDifferentCorners() {
  const std::size_t fault = firstFault(stage_, cells_.size(), [this](std::size_t c) {
    Cell corners = cells_[c];
    std::sort(corners.begin(), corners.end());
    return std::adjacent_find(corners.begin(), corners.end()) == corners.end();
  });
  if (fault == cells_.size()) return;
  throw Error(ErrorCode::RepeatedVertex,
              "Cell " + std::to_string(fault) +
                  " has a vertex twice; files of OpenVolumeMesh cannot hold that.",
              Place{PlaceKind::Cell, fault});
}

/// Sorts sides by their vertices, so that those of one face follow each other.
template <class Cell, std::size_t n, std::size_t k>
void TopologyBuilder<Cell, n, k>::collect(std::span<const Index> sides,
                                          std::vector<SortedSide>& scratch) const {
  scratch.clear();
  for (const Index side : sides) {
    Loop vertices = loopOf(side);
    std::sort(vertices.begin(), vertices.end());
    scratch.push_back({vertices, side});
  }
  std::sort(scratch.begin(), scratch.end(), [](const SortedSide& a, const SortedSide& b) {
    // The smallest vertex is the same for all.
    for (std::size_t i = 1; i < n; ++i) {
      if (a.vertices[i] != b.vertices[i]) return a.vertices[i] < b.vertices[i];
    }
    return a.side < b.side;
  });
}

/// Whether two sides with the same vertices pass them in opposite directions.
template <class Cell, std::size_t n, std::size_t k>
bool TopologyBuilder<Cell, n, k>::areOpposite(Index a, Index b) const {
  const Loop here = loopOf(a);
  const Loop there = loopOf(b);
  const auto start =
      static_cast<std::size_t>(std::find(there.begin(), there.end(), here[0]) - there.begin());
  for (std::size_t i = 0; i < n; ++i) {
    if (here[i] != there[(start + n - i) % n]) return false;
  }
  return true;
}

/// Finds the mates of all sides with the same smallest vertex; false if some have none or several.
template <class Cell, std::size_t n, std::size_t k>
bool TopologyBuilder<Cell, n, k>::matchAt(std::span<const Index> sides,
                                          std::vector<SortedSide>& scratch) {
  collect(sides, scratch);
  for (std::size_t i = 0; i < scratch.size();) {
    std::size_t end = i + 1;
    while (end < scratch.size() && scratch[end].vertices == scratch[i].vertices) ++end;
    const Index first = scratch[i].side;
    const Index last = scratch[end - 1].side;
    if (end - i > 2 || (end - i == 2 && !areOpposite(first, last))) return false;
    mate_[first] = last;
    mate_[last] = first;
    i = end;
  }
  return true;
}

template <class Cell, std::size_t n, std::size_t k>
void TopologyBuilder<Cell, n, k>::failAt(std::span<const Index> sides,
                                         std::vector<SortedSide>& scratch) const {
  collect(sides, scratch);
  const auto sameFace = [&](std::size_t i, std::size_t j) {
    return j < scratch.size() && scratch[i].vertices == scratch[j].vertices;
  };
  for (std::size_t i = 0; i < scratch.size(); ++i) {
    if (!sameFace(i, i + 1)) continue;
    const Index cell = scratch[i].side / k;
    const std::string cells =
        "cells " + std::to_string(cell) + " and " + std::to_string(scratch[i + 1].side / k);
    const Place place{PlaceKind::Cell, cell};
    if (sameFace(i, i + 2)) {
      throw Error(ErrorCode::NonManifoldFace,
                  "More cells than the two " + cells +
                      " share a face; files of OpenVolumeMesh cannot hold that.",
                  place);
    }
    if (!areOpposite(scratch[i].side, scratch[i + 1].side)) {
      throw Error(ErrorCode::Orientation,
                  "The " + cells +
                      " list the corners of the face that they share in the same direction, so "
                      "one of them is inside out; files of OpenVolumeMesh cannot hold that.",
                  place);
    }
  }
  throw Error(ErrorCode::Internal, "A fault of a face was found, but not again.");
}

template <class Cell, std::size_t n, std::size_t k>
void TopologyBuilder<Cell, n, k>::matchSides() {
  const std::size_t sides = cells_.size() * k;
  Groups groups = groupByKey(
      topology_.vertexCount, sides,
      [this](std::size_t side) {
        const Loop loop = loopOf(static_cast<Index>(side));
        return *std::min_element(loop.begin(), loop.end());
      },
      stage_);
  mate_.resize(sides);
  const std::size_t fault = firstFault(stage_, topology_.vertexCount, [&](std::size_t v) {
    thread_local std::vector<SortedSide> scratch;
    return matchAt(groups[v], scratch);
  });
  if (fault == topology_.vertexCount) return;
  std::vector<SortedSide> scratch;
  failAt(groups[fault], scratch);
}

template <class Cell, std::size_t n, std::size_t k>
void TopologyBuilder<Cell, n, k>::numberFaces() {
  topology_.cells.length = k;
  Array<Index>& halfFaces = topology_.cells.handles;
  halfFaces.resize(mate_.size());
  std::size_t faces = 0;
  for (std::size_t side = 0; side < mate_.size(); ++side) faces += mate_[side] >= side ? 1 : 0;
  requireAtMost(kMaxOvmEntities, faces, "faces");
  faceOwner_.resize(faces);
  Index face = 0;
  for (Index side = 0; side < mate_.size(); ++side) {
    const Index mate = mate_[side];
    if (mate < side) continue;
    // The corners of a cell begin with its first side, so the reader finds them in their order if
    // that side begins where the cell does.
    const bool mateOwns = mate % k < side % k;
    faceOwner_[face] = mateOwns ? mate : side;
    halfFaces[mate] = 2 * face + (mateOwns ? 0U : 1U);
    halfFaces[side] = 2 * face + (mateOwns ? 1U : 0U);
    ++face;
  }
}

template <class Cell, std::size_t n, std::size_t k>
void TopologyBuilder<Cell, n, k>::buildEdges() {
  // Side i of face f is number f * n + i, which 64 bits may be needed for; so edges are grouped by
  // their smaller vertex without numbers, as larger vertices.
  const std::size_t vertices = topology_.vertexCount;
  Array<std::uint64_t> begins(vertices + 1, 0);
  const auto forEachEdge = [this](std::size_t face, const auto& visit) {
    const Loop loop = loopOf(faceOwner_[face]);
    for (std::size_t i = 0; i < n; ++i) {
      visit(std::min(loop[i], loop[(i + 1) % n]), std::max(loop[i], loop[(i + 1) % n]));
    }
  };
  parallelFor(stage_, faceOwner_.size(), kGrain, [&](std::size_t face) {
    forEachEdge(face, [&](Index low, Index /*high*/) {
      std::atomic_ref(begins[low]).fetch_add(1, std::memory_order_relaxed);
    });
  });
  Array<Index> ends(exclusiveScan(std::span(begins)));
  parallelFor(stage_, faceOwner_.size(), kGrain, [&](std::size_t face) {
    forEachEdge(face, [&](Index low, Index high) {
      ends[std::atomic_ref(begins[low]).fetch_add(1, std::memory_order_relaxed)] = high;
    });
  });
  // Now begins[v] is where v ends. Each edge occurs once for each of its faces.
  const auto rangeOf = [&](std::size_t v) {
    return std::span(ends.data() + (v == 0 ? 0 : begins[v - 1]), ends.data() + begins[v]);
  };
  Array<std::uint64_t> edgeBegins(vertices + 1, 0);
  parallelFor(stage_, vertices, kGrain, [&](std::size_t v) {
    const std::span<Index> range = rangeOf(v);
    std::sort(range.begin(), range.end());
    edgeBegins[v] =
        static_cast<std::uint64_t>(std::unique(range.begin(), range.end()) - range.begin());
  });
  const std::uint64_t edges = exclusiveScan(std::span(edgeBegins));
  requireAtMost(kMaxOvmEntities, edges, "edges");
  topology_.edges.resize(static_cast<std::size_t>(edges));
  parallelFor(stage_, vertices, kGrain, [&](std::size_t v) {
    const std::span<const Index> range = rangeOf(v);
    for (std::uint64_t e = edgeBegins[v]; e < edgeBegins[v + 1]; ++e) {
      topology_.edges[e] = {static_cast<Index>(v), range[e - edgeBegins[v]]};
    }
  });
}

template <class Cell, std::size_t n, std::size_t k>
void TopologyBuilder<Cell, n, k>::linkFacesToEdges() {
  topology_.faces.length = n;
  topology_.faces.handles.resize(n * faceOwner_.size());
  const OvmEdgeFinder finder(topology_);
  parallelFor(stage_, faceOwner_.size(), kGrain, [&](std::size_t face) {
    const Loop loop = loopOf(faceOwner_[face]);
    for (std::size_t i = 0; i < n; ++i) {
      const Index from = loop[i];
      const Index to = loop[(i + 1) % n];
      topology_.faces.handles[n * face + i] = 2 * finder.find(from, to) + (from < to ? 0U : 1U);
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
  const auto* const found = std::lower_bound(
      first, last, high,
      [](const std::array<Index, 2>& edge, Index vertex) { return edge[1] < vertex; });
  if (found == last || (*found)[1] != high) return kNone;
  return static_cast<Index>(found - edges_.data());
}

OvmTopology buildOvmTopology(std::size_t vertexCount, std::span<const Tet> cells, Stage& stage) {
  return TopologyBuilder<Tet, 3, 4>(vertexCount, cells, kOvmTetFaces, stage).build();
}

OvmTopology buildOvmTopology(std::size_t vertexCount, std::span<const Hex> cells, Stage& stage) {
  return TopologyBuilder<Hex, 4, 6>(vertexCount, cells, kOvmHexFaces, stage).build();
}

}  // namespace hexhex
