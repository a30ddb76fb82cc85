// Faces of a hexahedral mesh and what follows from them (see hex_edges.cpp for the edges).
#include <algorithm>
#include <atomic>
#include <compare>
#include <vector>

#include <adjacency/hex_topology.hpp>

#include <base/disjoint_sets.hpp>
#include <base/parallel.hpp>

namespace hexhex {
namespace {

/// Vertices or cells per block: a block has about 10^5 operations, so its start costs nothing.
constexpr std::size_t kGrain = 2048;

/// A face seen from one cell. The first of its sorted vertices is known from the context.
struct FaceEntry {
  std::array<Index, 3> others;  ///< the other three vertices, ascending
  Index cell;
  std::uint8_t face;
  auto operator<=>(const FaceEntry&) const = default;
};

/// What the faces of one block of vertices add up to.
struct FaceCounts {
  std::uint64_t count = 0;
  std::uint64_t boundaryCount = 0;
  FaceFault overfull;
  FaceFault sameDirection;
  std::uint64_t usedVertices = 0;
  Index firstUnusedVertex = kNone;
};

/// Collects the faces of the cells around `vertex` that have it as their smallest vertex, sorted,
/// so that entries of the same face are neighbours.
void collectFaces(const HexMesh& mesh, std::span<const Index> cells, Index vertex,
                  std::vector<FaceEntry>& entries) {
  entries.clear();
  Index previous = kNone;
  for (const Index c : cells) {
    if (c == previous) continue;  // a cell with repeated vertices
    previous = c;
    for (std::uint8_t f = 0; f < 6; ++f) {
      Quad quad = faceVertices(mesh.cells[c], f);
      if (std::min({quad[0], quad[1], quad[2], quad[3]}) != vertex) continue;
      std::sort(quad.begin(), quad.end());
      entries.push_back({{quad[1], quad[2], quad[3]}, c, f});
    }
  }
  std::sort(entries.begin(), entries.end());
}

/// Whether b lists the vertices of a the other way round, starting anywhere.
bool opposite(const Quad& a, const Quad& b) {
  for (std::size_t shift = 0; shift < 4; ++shift) {
    bool same = true;
    for (std::size_t i = 0; i < 4; ++i) same = same && a[i] == b[(shift + 4 - i) % 4];
    if (same) return true;
  }
  return false;
}

/// One more fault. Blocks are merged in order, so the first one noted is the first of all.
void note(FaceFault& fault, const FaceEntry& entry) {
  if (fault.count++ == 0) fault.first = {entry.cell, entry.face};
}

void merge(FaceFault& sum, const FaceFault& part) {
  if (sum.count == 0) sum.first = part.first;
  sum.count += part.count;
}

/// Finds faces vertex by vertex and notes them in places that several threads share.
class FaceFinder {
 public:
  FaceFinder(const HexMesh& mesh, const VertexCells& around)
      : mesh_(mesh), around_(around), components_(mesh.cells.size()) {
    boundary_.resize(mesh.cells.size());
    std::fill(boundary_.begin(), boundary_.end(), std::uint8_t{0});
  }

  /// Handles all faces whose smallest vertex is in [begin, end).
  FaceCounts findInBlock(std::size_t begin, std::size_t end) {
    FaceCounts counts;
    std::vector<FaceEntry> entries;
    for (std::size_t v = begin; v < end; ++v) {
      const std::span<const Index> cells = around_.around(v);
      if (cells.empty()) {
        if (counts.firstUnusedVertex == kNone) counts.firstUnusedVertex = static_cast<Index>(v);
        continue;
      }
      ++counts.usedVertices;
      collectFaces(mesh_, cells, static_cast<Index>(v), entries);
      const std::span<const FaceEntry> all = entries;
      for (std::size_t i = 0; i < all.size();) {
        std::size_t next = i + 1;
        while (next < all.size() && all[next].others == all[i].others) ++next;
        addFace(all.subspan(i, next - i), counts);
        i = next;
      }
    }
    return counts;
  }

  [[nodiscard]] Array<std::uint8_t> takeBoundary() { return std::move(boundary_); }
  [[nodiscard]] std::uint64_t countComponents() const { return components_.count(); }

 private:
  /// One face, given by its appearances in cells.
  void addFace(std::span<const FaceEntry> sides, FaceCounts& counts) {
    ++counts.count;
    const FaceEntry& first = sides.front();
    if (sides.size() == 1) {
      ++counts.boundaryCount;
      const auto bit = static_cast<std::uint8_t>(1U << first.face);
      std::atomic_ref(boundary_[first.cell]).fetch_or(bit, std::memory_order_relaxed);
      return;
    }
    for (const FaceEntry& side : sides.subspan(1)) components_.unite(first.cell, side.cell);
    if (sides.size() > 2) {
      note(counts.overfull, first);
    } else if (!opposite(faceVertices(mesh_.cells[first.cell], first.face),
                         faceVertices(mesh_.cells[sides[1].cell], sides[1].face))) {
      note(counts.sameDirection, first);
    }
  }

  const HexMesh& mesh_;
  const VertexCells& around_;
  Array<std::uint8_t> boundary_;
  DisjointSets components_;
};

}  // namespace

HexFaces findFaces(const HexMesh& mesh, const VertexCells& around, Stage& stage) {
  FaceFinder finder(mesh, around);
  std::vector<FaceCounts> blocks(blockCount(mesh.points.size(), kGrain));
  parallelBlocks(stage, mesh.points.size(), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   blocks[block] = finder.findInBlock(begin, end);
                 });
  HexFaces faces;
  for (const FaceCounts& part : blocks) {
    faces.count += part.count;
    faces.boundaryCount += part.boundaryCount;
    faces.usedVertices += part.usedVertices;
    faces.firstUnusedVertex = std::min(faces.firstUnusedVertex, part.firstUnusedVertex);
    merge(faces.overfull, part.overfull);
    merge(faces.sameDirection, part.sameDirection);
  }
  faces.boundary = finder.takeBoundary();
  faces.components = finder.countComponents();
  return faces;
}

}  // namespace hexhex
