// First, as its HalfFace and CornerOrder are names of entities and properties: adjacency has types
// of these names, which they would shadow.
#include <algorithm>
#include <string>
#include <vector>

#include <adjacency/cell_faces.hpp>
#include <adjacency/corner_order.hpp>
#include <adjacency/key_table.hpp>
#include <adjacency/tet_topology.hpp>
#include <adjacency/vertex_lists.hpp>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <io/formats/ovm_cells.hpp>

namespace hexhex::io {

void requireOvmCount(std::uint64_t limit, std::uint64_t count, const char* what) {
  if (count <= limit) return;
  throw Error(ErrorCode::TooLarge, "The mesh has " + std::to_string(count) + " " + what +
                                       "; files of OpenVolumeMesh hold at most " +
                                       std::to_string(limit) + ".");
}

namespace {

constexpr std::size_t kOvmTopologyGrain = 2048;

void requireCounts(std::size_t vertexCount, std::size_t cellCount, std::size_t facesPerCell) {
  requireOvmCount(kMaxOvmEntities, vertexCount, "vertices");
  // The half-faces of all cells have 32-bit numbers.
  requireOvmCount((kNone - 1) / facesPerCell, cellCount, "cells");
}

template <class Cell>
void requireDifferentVertices(std::span<const Cell> cells, Stage& stage) {
  const std::size_t fault =
      firstFault(stage, cells.size(), [cells](std::size_t c) { return !hasVertexTwice(cells[c]); });
  if (fault == cells.size()) return;
  throw Error(ErrorCode::RepeatedVertex,
              "Cell " + std::to_string(fault) +
                  " has a vertex twice; files of OpenVolumeMesh cannot hold that.",
              Place{PlaceKind::Cell, fault});
}

/// Throws if this is a face of more than two cells, or of two that are not beside each other.
template <class Cell>
void requireManifold(std::span<const Cell> cells,
                     std::span<const adjacency::CellFace<Cell>> halfFaces) {
  if (halfFaces.size() == 1) return;
  const adjacency::CellFace<Cell>& a = halfFaces[0];
  const adjacency::CellFace<Cell>& b = halfFaces[1];
  const std::string names = "cells " + std::to_string(a.cell) + " and " + std::to_string(b.cell);
  const Place place{PlaceKind::Cell, a.cell};
  if (halfFaces.size() > 2) {
    throw Error(ErrorCode::NonManifoldFace,
                "More cells than the two " + names +
                    " share a face; files of OpenVolumeMesh cannot hold that.",
                place);
  }
  if (adjacency::areOpposite(adjacency::faceVertices(cells[a.cell], a.face),
                             adjacency::faceVertices(cells[b.cell], b.face)))
    return;
  throw Error(ErrorCode::Orientation,
              "The " + names +
                  " list the corners of the face that they share in the same direction, so one of "
                  "them is inside out; files of OpenVolumeMesh cannot hold that.",
              place);
}

/// Finds out what is wrong with a mesh whose faces could not be matched.
template <class Cell>
[[noreturn]] void throwFaceFault(std::size_t vertexCount, std::span<const Cell> cells,
                                 Stage& stage) {
  const adjacency::VertexLists<Index, std::uint64_t> around(
      vertexCount, stage, [&](const auto& add) {
        parallelFor(stage, cells.size(), kOvmTopologyGrain, [&](std::size_t c) {
          for (const Index v : cells[c]) add(v, static_cast<Index>(c));
        });
      });
  adjacency::forEachFace(cells, 0, vertexCount, around,
                         [cells](std::span<const adjacency::CellFace<Cell>> halfFaces) {
                           requireManifold(cells, halfFaces);
                         });
  throw Error(ErrorCode::Internal, "A fault of a face was found, but not again.");
}

using Edge = std::array<Index, 2>;

/// The edges from a vertex to larger ones, in the order in which its tets have them.
/// @param others  reused between calls
void appendEdges(const adjacency::TetTopology& tets, Index vertex, adjacency::KeyTable& others,
                 std::vector<Edge>& edges) {
  others.clear();
  for (const adjacency::CornerIndex corner : tets.star(vertex)) {
    const Index t = corner / 4;
    for (const std::uint8_t i : adjacency::kAscendingCorners[tets.order[t]]) {
      const Index other = tets.tets[t][i];
      if (other <= vertex) continue;
      const std::size_t known = others.size();
      if (others.insert(other) == known) edges.push_back({vertex, other});
    }
  }
}

std::vector<Edge> listEdges(const adjacency::TetTopology& tets, Stage& stage) {
  return collectFromBlocks<Edge>(
      stage, tets.pointCount, kOvmTopologyGrain,
      [&tets](std::size_t begin, std::size_t end, std::vector<Edge>& edges) {
        adjacency::KeyTable others;
        for (std::size_t v = begin; v < end; ++v) {
          appendEdges(tets, static_cast<Index>(v), others, edges);
        }
      });
}

/// The faces whose smallest vertex this is, as half-faces of the first tet that has them.
void appendFaces(const adjacency::TetTopology& tets, Index vertex,
                 std::vector<adjacency::HalfFace>& faces) {
  const auto addIfFirst = [&](adjacency::HalfFace halfFace) {
    if (tets.mate[halfFace] > halfFace) faces.push_back(halfFace);  // kNone is larger than all
  };
  for (const adjacency::CornerIndex corner : tets.star(vertex)) {
    const Index t = corner / 4;
    const std::array<std::uint8_t, 4>& ascending = adjacency::kAscendingCorners[tets.order[t]];
    if (ascending[0] == corner % 4) {
      // The order of slots, if the tet lists its vertices in ascending order.
      for (const std::size_t opposite : {3U, 1U, 2U}) addIfFirst(4 * t + ascending[opposite]);
    } else if (ascending[1] == corner % 4) {
      addIfFirst(4 * t + ascending[0]);
    }
  }
}

/// Numbers the faces of tets and lists the half-edges of each.
class TetFaceLister {
 public:
  TetFaceLister(const adjacency::TetTopology& tets, OvmTopology& topology)
      : tets_(tets), topology_(topology), edges_(tets.pointCount, topology.edges) {}

  void run(Stage& stage) {
    const std::vector<adjacency::HalfFace> faces = collectFromBlocks<adjacency::HalfFace>(
        stage, tets_.pointCount, kOvmTopologyGrain,
        [this](std::size_t begin, std::size_t end, std::vector<adjacency::HalfFace>& list) {
          for (std::size_t v = begin; v < end; ++v) appendFaces(tets_, static_cast<Index>(v), list);
        });
    requireOvmCount(kMaxOvmEntities, faces.size(), "faces");
    topology_.cells.length = 4;
    topology_.cells.handles.resize(4 * tets_.tetCount());
    topology_.faces.length = 3;
    topology_.faces.handles.resize(3 * faces.size());
    parallelFor(stage, faces.size(), kOvmTopologyGrain,
                [&](std::size_t f) { listFace(static_cast<Index>(f), faces[f]); });
  }

 private:
  static Index slotOf(adjacency::HalfFace halfFace) { return kOvmTetOpposite[halfFace % 4]; }
  Index& handleOf(adjacency::HalfFace halfFace) {
    return topology_.cells.handles[4 * std::size_t{adjacency::tetOf(halfFace)} + slotOf(halfFace)];
  }

  void listFace(Index face, adjacency::HalfFace halfFace) {
    const adjacency::HalfFace mate = tets_.mate[halfFace];
    // The corners of a cell begin with its first slot, so a reader finds them in their order if the
    // face begins where that does.
    const bool mateOwns = mate != kNone && slotOf(mate) < slotOf(halfFace);
    const adjacency::HalfFace owner = mateOwns ? mate : halfFace;
    handleOf(owner) = 2 * face;
    if (mate != kNone) handleOf(mateOwns ? halfFace : mate) = 2 * face + 1;
    const Tet& tet = tets_.tets[adjacency::tetOf(owner)];
    const std::array<std::uint8_t, 3>& loop = kOvmTetFaces[slotOf(owner)];
    for (std::size_t i = 0; i < 3; ++i) {
      topology_.faces.handles[3 * std::size_t{face} + i] =
          edges_.halfEdge(tet[loop[i]], tet[loop[(i + 1) % 3]]);
    }
  }

  const adjacency::TetTopology& tets_;
  OvmTopology& topology_;
  OvmEdgeFinder edges_;
};

}  // namespace

OvmEdgeFinder::OvmEdgeFinder(std::size_t vertexCount, std::span<const std::array<Index, 2>> edges)
    : edges_(edges), begins_(vertexCount + 1) {
  std::size_t e = 0;
  for (std::size_t v = 0; v <= vertexCount; ++v) {
    while (e < edges_.size() && edges_[e][0] < v) ++e;
    begins_[v] = static_cast<Index>(e);
  }
}

Index OvmEdgeFinder::find(Index a, Index b) const noexcept {
  const Index low = std::min(a, b);
  const Index high = std::max(a, b);
  if (high + std::size_t{1} >= begins_.size()) return kNone;
  for (Index e = begins_[low]; e < begins_[low + 1]; ++e) {
    if (edges_[e][1] == high) return e;
  }
  return kNone;
}

OvmTopology buildOvmTopology(std::size_t vertexCount, std::span<const Tet> cells, Stage& stage) {
  requireCounts(vertexCount, cells.size(), 4);
  requireDifferentVertices(cells, stage);
  adjacency::TetTopology tets;
  tets.tets = cells;
  tets.pointCount = vertexCount;
  if (!adjacency::matchFaces(tets, stage)) throwFaceFault(vertexCount, cells, stage);
  adjacency::addStars(tets, stage);
  OvmTopology topology;
  topology.vertexCount = vertexCount;
  const std::vector<Edge> edges = listEdges(tets, stage);
  requireOvmCount(kMaxOvmEntities, edges.size(), "edges");
  topology.edges.assign(edges.begin(), edges.end());
  TetFaceLister(tets, topology).run(stage);
  return topology;
}

OvmTopology buildOvmTopology(std::size_t vertexCount, std::span<const Hex> cells, Stage& stage) {
  requireCounts(vertexCount, cells.size(), 6);
  std::optional<adjacency::HexMates> mates = adjacency::matchHexFaces(vertexCount, cells, stage);
  if (mates) {
    std::optional<OvmTopology> topology = numberHexes(vertexCount, cells, std::move(*mates), stage);
    if (topology) return std::move(*topology);
  }
  requireDifferentVertices(cells, stage);
  throwFaceFault(vertexCount, cells, stage);
}

}  // namespace hexhex::io
