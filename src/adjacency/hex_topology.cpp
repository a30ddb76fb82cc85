// Faces of a hexahedral mesh and what follows from them (see hex_edges.cpp for the edges).
#include <algorithm>
#include <atomic>
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

}  // namespace hexhex
