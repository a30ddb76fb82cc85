// Faces and edges of a hexahedral mesh, and what follows from them.
#include <algorithm>
#include <atomic>
#include <bit>
#include <compare>
#include <string>
#include <vector>

#include <adjacency/corner_range.hpp>
#include <adjacency/hex_topology.hpp>

#include <hexhex/error.hpp>

#include <base/disjoint_sets.hpp>
#include <base/parallel.hpp>

namespace hexhex::adjacency {
namespace {

/// Vertices or cells per block: about 10^5 operations, so starting a block costs next to nothing.
constexpr std::size_t kHexTopologyGrain = 2048;

/// Counts another fault. Blocks are merged in order, so the first fault noted is the first of all.
void note(FaceFault& fault, const CellFace<Hex>& face) {
  if (fault.count++ == 0) fault.first = face;
}

void merge(FaceFault& sum, const FaceFault& part) {
  if (sum.count == 0) sum.first = part.first;
  sum.count += part.count;
}

/// Adds one face, given its half-faces.
/// @param boundary, cells  shared by several threads
void addFace(const HexMesh& mesh, std::span<const CellFace<Hex>> halfFaces,
             Array<std::uint8_t>& boundary, DisjointSets& cells, HexFaces& sum) {
  ++sum.count;
  const CellFace<Hex>& first = halfFaces.front();
  if (halfFaces.size() == 1) {
    ++sum.boundaryCount;
    const auto bit = static_cast<std::uint8_t>(1U << first.face);
    std::atomic_ref(boundary[first.cell]).fetch_or(bit, std::memory_order_relaxed);
    return;
  }
  for (const CellFace<Hex>& other : halfFaces.subspan(1)) cells.unite(first.cell, other.cell);
  if (halfFaces.size() > 2) {
    note(sum.overfull, first);
  } else if (!areOpposite(faceVertices(mesh.cells[first.cell], first.face),
                          faceVertices(mesh.cells[halfFaces[1].cell], halfFaces[1].face))) {
    note(sum.sameDirection, first);
  }
}

/// Throws unless every corner is a vertex and all cell numbers fit an Index.
void requireIndexable(const HexMesh& mesh, Stage& stage) {
  if (mesh.cells.size() >= kNone) {
    throw Error(ErrorCode::TooLarge,
                "The mesh has " + std::to_string(mesh.cells.size()) +
                    " cells, but its faces can be found for fewer than 2^32 - 1 cells only. Split "
                    "the mesh or use a smaller scale.");
  }
  requireCornersInRange(mesh, stage);
}

}  // namespace

VertexCells cellsAroundVertices(const HexMesh& mesh, Stage& stage) {
  requireIndexable(mesh, stage);
  return VertexCells(mesh.points.size(), stage, [&](const auto& add) {
    parallelFor(stage, mesh.cells.size(), kHexTopologyGrain, [&](std::size_t c) {
      for (const Index v : mesh.cells[c]) add(v, static_cast<Index>(c));
    });
  });
}

HexFaces findFaces(const HexMesh& mesh, const VertexCells& around, Stage& stage) {
  Array<std::uint8_t> boundary(mesh.cells.size(), 0);
  DisjointSets cells(mesh.cells.size());
  std::vector<HexFaces> blocks(blockCount(mesh.points.size(), kHexTopologyGrain));
  parallelBlocks(stage, mesh.points.size(), kHexTopologyGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   HexFaces& sum = blocks[block];
                   for (std::size_t v = end; v > begin;) {
                     --v;
                     if (around(v).empty()) {
                       sum.firstUnusedVertex = static_cast<Index>(v);
                     } else {
                       ++sum.usedVertices;
                     }
                   }
                   forEachFace(std::span(mesh.cells), begin, end, around,
                               [&](std::span<const CellFace<Hex>> halfFaces) {
                                 addFace(mesh, halfFaces, boundary, cells, sum);
                               });
                 });
  HexFaces faces;
  for (const HexFaces& part : blocks) {
    faces.count += part.count;
    faces.boundaryCount += part.boundaryCount;
    faces.usedVertices += part.usedVertices;
    faces.firstUnusedVertex = std::min(faces.firstUnusedVertex, part.firstUnusedVertex);
    merge(faces.overfull, part.overfull);
    merge(faces.sameDirection, part.sameDirection);
  }
  faces.boundary = std::move(boundary);
  faces.components = cells.count();
  return faces;
}

FaceNeighbours findFaceNeighbours(const HexMesh& mesh, Stage& stage) {
  const VertexCells around = cellsAroundVertices(mesh, stage);
  FaceNeighbours neighbours(mesh.cells.size());
  const auto join = [&neighbours](std::span<const CellFace<Hex>> halfFaces) {
    const CellFace<Hex>& a = halfFaces.front();
    const CellFace<Hex>& b = halfFaces.back();
    if (halfFaces.size() > 2) {
      throw Error(ErrorCode::InvalidArgument,
                  "A face of cell " + std::to_string(a.cell) + " belongs to " +
                      std::to_string(halfFaces.size()) + " cells, but two are the most.",
                  Place{PlaceKind::Cell, a.cell});
    }
    const bool isInner = halfFaces.size() == 2;
    neighbours[a.cell][a.face] = isInner ? b.cell : kNone;
    if (isInner) neighbours[b.cell][b.face] = a.cell;
  };
  parallelBlocks(stage, mesh.points.size(), kHexTopologyGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   forEachFace(std::span(mesh.cells), begin, end, around, join);
                 });
  return neighbours;
}

namespace {

/// The two faces of a cell that meet at each of its edges.
constexpr std::array<std::array<std::uint8_t, 2>, 12> facesOfEdges() {
  std::array<std::array<std::uint8_t, 2>, 12> result{};
  for (std::size_t e = 0; e < 12; ++e) {
    std::size_t found = 0;
    for (std::uint8_t f = 0; f < 6; ++f) {
      int common = 0;
      for (const std::uint8_t corner : kHexFaces[f]) {
        if (corner == kHexEdges[e][0] || corner == kHexEdges[e][1]) ++common;
      }
      if (common == 2) result[e][found++] = f;
    }
  }
  return result;
}
constexpr auto kFacesOfEdges = facesOfEdges();

/// An edge seen from one cell. Its smaller vertex is known from context.
struct EdgeEntry {
  Index other;                 ///< the larger vertex
  std::array<Index, 2> quads;  ///< this cell's boundary quads at this edge, kNone if inside
  auto operator<=>(const EdgeEntry&) const = default;
};

/// Numbers the boundary quads in order of (cell, face), like boundaryPlaces().
class QuadNumbers {
 public:
  explicit QuadNumbers(const HexFaces& faces) : boundary_(faces.boundary) {
    if (faces.boundaryCount >= kNone) {
      throw Error(ErrorCode::TooLarge,
                  "The mesh has " + std::to_string(faces.boundaryCount) +
                      " boundary quads, but fewer than 2^32 - 1 are supported. Use a smaller "
                      "scale.");
    }
    firsts_.resize(boundary_.size());
    Index next = 0;
    for (std::size_t c = 0; c < boundary_.size(); ++c) {
      firsts_[c] = next;
      next += static_cast<Index>(std::popcount(boundary_[c]));
    }
  }

  /// The number of the quad on a face of a cell, kNone if the face is inside.
  [[nodiscard]] Index at(Index cell, std::uint8_t face) const {
    const unsigned mask = boundary_[cell];
    if ((mask >> face & 1U) == 0) return kNone;
    const unsigned before = mask & ((1U << face) - 1U);
    return firsts_[cell] + static_cast<Index>(std::popcount(before));
  }

 private:
  const Array<std::uint8_t>& boundary_;
  Array<Index> firsts_;
};

/// Collects the edges of the cells around a vertex for which it is the smaller vertex, sorted.
void collectEdges(const HexMesh& mesh, std::span<const Index> around, Index vertex,
                  const QuadNumbers& numbers, std::vector<EdgeEntry>& entries) {
  entries.clear();
  Index previous = kNone;
  for (const Index c : around) {
    if (c == previous) continue;  // a cell with repeated vertices
    previous = c;
    const Hex& cell = mesh.cells[c];
    for (std::size_t e = 0; e < 12; ++e) {
      const Index a = cell[kHexEdges[e][0]];
      const Index b = cell[kHexEdges[e][1]];
      if (std::min(a, b) != vertex) continue;
      entries.push_back({std::max(a, b),
                         {numbers.at(c, kFacesOfEdges[e][0]), numbers.at(c, kFacesOfEdges[e][1])}});
    }
  }
  std::sort(entries.begin(), entries.end());
}

/// Adds one edge, given its appearances in cells.
/// @param quads  of the boundary; shared by several threads
void addEdge(Index vertex, std::span<const EdgeEntry> wedges, DisjointSets& quads,
             HexEdges& edges) {
  ++edges.count;
  Index firstQuad = kNone;
  std::size_t quadCount = 0;
  for (const EdgeEntry& wedge : wedges) {
    for (const Index quad : wedge.quads) {
      if (quad == kNone) continue;
      if (quadCount++ == 0) firstQuad = quad;
      quads.unite(firstQuad, quad);
    }
  }
  const bool isBoundary = quadCount != 0;
  const int valence = static_cast<int>(wedges.size());
  if (valence != (isBoundary ? 2 : 4)) {
    edges.singular.push_back(
        {vertex, wedges.front().other, static_cast<std::uint32_t>(valence), isBoundary});
    ++(isBoundary ? edges.boundarySingular : edges.innerSingular)[valence];
  }
  if (!isBoundary) return;
  ++edges.boundaryCount;
  if (quadCount != 2 && edges.openCount++ == 0) edges.firstOpen = {vertex, wedges.front().other};
}

}  // namespace

HexEdges findEdges(const HexMesh& mesh, const VertexCells& around, const HexFaces& faces,
                   Stage& stage) {
  const QuadNumbers numbers(faces);
  DisjointSets quads(faces.boundaryCount);
  std::vector<HexEdges> blocks(blockCount(mesh.points.size(), kHexTopologyGrain));
  parallelBlocks(stage, mesh.points.size(), kHexTopologyGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   std::vector<EdgeEntry> entries;
                   for (std::size_t v = begin; v < end; ++v) {
                     const auto vertex = static_cast<Index>(v);
                     collectEdges(mesh, around(v), vertex, numbers, entries);
                     forEachRun(
                         std::span<const EdgeEntry>(entries),
                         [](const EdgeEntry& a, const EdgeEntry& b) { return a.other == b.other; },
                         [&](std::span<const EdgeEntry> wedges) {
                           addEdge(vertex, wedges, quads, blocks[block]);
                         });
                   }
                 });
  HexEdges edges;
  for (const HexEdges& part : blocks) {
    if (edges.openCount == 0) edges.firstOpen = part.firstOpen;
    edges.count += part.count;
    edges.boundaryCount += part.boundaryCount;
    edges.openCount += part.openCount;
    edges.singular.insert(edges.singular.end(), part.singular.begin(), part.singular.end());
    for (const auto& [valence, count] : part.innerSingular) edges.innerSingular[valence] += count;
    for (const auto& [valence, count] : part.boundarySingular) {
      edges.boundarySingular[valence] += count;
    }
  }
  edges.boundaryComponents = quads.count();
  return edges;
}

}  // namespace hexhex::adjacency
