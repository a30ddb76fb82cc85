// Faces and edges of a hexahedral mesh and what follows from them.
#include <algorithm>
#include <atomic>
#include <bit>
#include <compare>
#include <string>
#include <vector>

#include <adjacency/hex_topology.hpp>

#include <hexhex/error.hpp>

#include <base/disjoint_sets.hpp>
#include <base/parallel.hpp>

namespace hexhex {
namespace {

/// Vertices or cells per block: a block has about 10^5 operations, so its start costs nothing.
constexpr std::size_t kGrain = 2048;

/// One more fault. Blocks are merged in order, so the first one noted is the first of all.
void note(FaceFault& fault, const CellFace<Hex>& face) {
  if (fault.count++ == 0) fault.first = face;
}

void merge(FaceFault& sum, const FaceFault& part) {
  if (sum.count == 0) sum.first = part.first;
  sum.count += part.count;
}

/// Finds faces vertex by vertex and notes them in places that several threads share.
class FaceFinder {
 public:
  FaceFinder(const HexMesh& mesh, const VertexCells& around)
      : mesh_(mesh), around_(around), boundary_(mesh.cells.size(), 0), sets_(mesh.cells.size()) {}

  /// What the faces whose smallest vertex is in [begin, end) add up to.
  HexFaces findInBlock(std::size_t begin, std::size_t end) {
    HexFaces sum;
    FacesAtVertices<Hex> faces(mesh_.cells);
    for (std::size_t v = begin; v < end; ++v) {
      const std::span<const Index> cells = around_.at(v);
      if (cells.empty()) {
        sum.firstUnusedVertex = std::min(sum.firstUnusedVertex, static_cast<Index>(v));
        continue;
      }
      ++sum.usedVertices;
      faces.forEach(static_cast<Index>(v), cells,
                    [&](std::span<const CellFace<Hex>> halfFaces) { addFace(halfFaces, sum); });
    }
    return sum;
  }

  [[nodiscard]] Array<std::uint8_t> takeBoundary() { return std::move(boundary_); }
  [[nodiscard]] std::uint64_t countComponents() const { return sets_.count(); }

 private:
  void addFace(std::span<const CellFace<Hex>> halfFaces, HexFaces& sum) {
    ++sum.count;
    const CellFace<Hex>& first = halfFaces.front();
    if (halfFaces.size() == 1) {
      ++sum.boundaryCount;
      const auto bit = static_cast<std::uint8_t>(1U << first.face);
      std::atomic_ref(boundary_[first.cell]).fetch_or(bit, std::memory_order_relaxed);
      return;
    }
    for (const CellFace<Hex>& other : halfFaces.subspan(1)) sets_.unite(first.cell, other.cell);
    if (halfFaces.size() > 2) {
      note(sum.overfull, first);
    } else if (!areOpposite(faceVertices(mesh_.cells[first.cell], first.face),
                            faceVertices(mesh_.cells[halfFaces[1].cell], halfFaces[1].face))) {
      note(sum.sameDirection, first);
    }
  }

  const HexMesh& mesh_;
  const VertexCells& around_;
  Array<std::uint8_t> boundary_;
  DisjointSets sets_;
};

/// Throws unless every corner is a vertex and cell numbers fit an Index.
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
    parallelFor(stage, mesh.cells.size(), kGrain, [&](std::size_t c) {
      for (const Index v : mesh.cells[c]) add(v, static_cast<Index>(c));
    });
  });
}

std::size_t firstCellOutOfRange(const HexMesh& mesh, Stage& stage) {
  const auto vertices = static_cast<Index>(std::min<std::size_t>(mesh.points.size(), kNone));
  return firstFault(stage, mesh.cells.size(), [&](std::size_t c) {
    unsigned outside = 0;
    for (const Index corner : mesh.cells[c]) outside |= corner >= vertices ? 1U : 0U;
    return outside == 0;
  });
}

void requireCornersInRange(const HexMesh& mesh, Stage& stage) {
  const std::size_t bad = firstCellOutOfRange(mesh, stage);
  if (bad == mesh.cells.size()) return;
  throw Error(ErrorCode::InvalidArgument,
              "Cell " + std::to_string(bad) +
                  " of the hexahedral mesh names a vertex that does not exist (the mesh has " +
                  std::to_string(mesh.points.size()) + " vertices). Correct the cell.",
              Place{PlaceKind::Cell, bad, 0});
}

HexFaces findFaces(const HexMesh& mesh, const VertexCells& around, Stage& stage) {
  FaceFinder finder(mesh, around);
  std::vector<HexFaces> blocks(blockCount(mesh.points.size(), kGrain));
  parallelBlocks(stage, mesh.points.size(), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   blocks[block] = finder.findInBlock(begin, end);
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
  faces.boundary = finder.takeBoundary();
  faces.components = finder.countComponents();
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
  parallelBlocks(stage, mesh.points.size(), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   FacesAtVertices<Hex> faces(mesh.cells);
                   for (std::size_t v = begin; v < end; ++v) {
                     faces.forEach(static_cast<Index>(v), around.at(v), join);
                   }
                 });
  return neighbours;
}

namespace {

/// The two faces of a cell that meet in each of its edges.
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

/// An edge seen from one cell. Its smaller vertex is known from the context.
struct EdgeEntry {
  Index other;                 ///< the larger vertex
  std::array<Index, 2> quads;  ///< boundary quads of this cell at this edge, kNone if inside
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

/// Finds edges vertex by vertex and joins boundary quads, from several threads.
class EdgeFinder {
 public:
  EdgeFinder(const HexMesh& mesh, const VertexCells& around, const HexFaces& faces)
      : mesh_(mesh), around_(around), numbers_(faces), components_(faces.boundaryCount) {}

  /// Handles all edges whose smaller vertex is in [begin, end).
  HexEdges findInBlock(std::size_t begin, std::size_t end) {
    HexEdges edges;
    std::vector<EdgeEntry> entries;
    for (std::size_t v = begin; v < end; ++v) {
      const auto vertex = static_cast<Index>(v);
      collectEdges(vertex, entries);
      forEachRun(
          std::span<const EdgeEntry>(entries),
          [](const EdgeEntry& a, const EdgeEntry& b) { return a.other == b.other; },
          [&](std::span<const EdgeEntry> wedges) { addEdge(vertex, wedges, edges); });
    }
    return edges;
  }

  [[nodiscard]] std::uint64_t countComponents() const { return components_.count(); }

 private:
  /// Collects the edges of the cells around `vertex` that have it as their smaller vertex, sorted.
  void collectEdges(Index vertex, std::vector<EdgeEntry>& entries) const {
    entries.clear();
    Index previous = kNone;
    for (const Index c : around_.at(vertex)) {
      if (c == previous) continue;  // a cell with repeated vertices
      previous = c;
      const Hex& cell = mesh_.cells[c];
      for (std::size_t e = 0; e < 12; ++e) {
        const Index a = cell[kHexEdges[e][0]];
        const Index b = cell[kHexEdges[e][1]];
        if (std::min(a, b) != vertex) continue;
        entries.push_back(
            {std::max(a, b),
             {numbers_.at(c, kFacesOfEdges[e][0]), numbers_.at(c, kFacesOfEdges[e][1])}});
      }
    }
    std::sort(entries.begin(), entries.end());
  }

  /// One edge, given by its appearances in cells.
  void addEdge(Index vertex, std::span<const EdgeEntry> wedges, HexEdges& edges) {
    ++edges.count;
    Index firstQuad = kNone;
    std::size_t quads = 0;
    for (const EdgeEntry& wedge : wedges) {
      for (const Index quad : wedge.quads) {
        if (quad == kNone) continue;
        if (quads++ == 0) firstQuad = quad;
        components_.unite(firstQuad, quad);
      }
    }
    const int valence = static_cast<int>(wedges.size());
    if (valence != (quads == 0 ? 4 : 2)) {
      edges.singular.push_back(
          {vertex, wedges.front().other, static_cast<std::uint32_t>(valence), quads != 0});
    }
    if (quads == 0) {
      if (valence != 4) ++edges.innerSingular[valence];
      return;
    }
    ++edges.boundaryCount;
    if (valence != 2) ++edges.boundarySingular[valence];
    if (quads != 2 && edges.openCount++ == 0) edges.firstOpen = {vertex, wedges.front().other};
  }

  const HexMesh& mesh_;
  const VertexCells& around_;
  QuadNumbers numbers_;
  DisjointSets components_;
};

}  // namespace

HexEdges findEdges(const HexMesh& mesh, const VertexCells& around, const HexFaces& faces,
                   Stage& stage) {
  EdgeFinder finder(mesh, around, faces);
  std::vector<HexEdges> blocks(blockCount(mesh.points.size(), kGrain));
  parallelBlocks(stage, mesh.points.size(), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   blocks[block] = finder.findInBlock(begin, end);
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
  edges.boundaryComponents = finder.countComponents();
  return edges;
}

}  // namespace hexhex
