// Finds the edges and faces of tets and of hexahedra (see ovm_mesh.hpp).
// Included first: OvmEntity::HalfFace and OvmInteger::CornerOrder would shadow types of adjacency.
// clang-format off
#include <base/concat.hpp>
#include <io/formats/ovm_mesh.hpp>
// clang-format on

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <adjacency/cell_faces.hpp>
#include <adjacency/corner_order.hpp>
#include <adjacency/hex_topology.hpp>
#include <adjacency/key_table.hpp>
#include <adjacency/tet_topology.hpp>
#include <adjacency/vertex_lists.hpp>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>

namespace hexhex::io {

namespace {

/// @param what  plural, e.g. "edges"
void requireOvmCount(std::uint64_t limit, std::uint64_t count, const char* what) {
  if (count <= limit) return;
  throw Error(ErrorCode::TooLarge, concat("The mesh has ", count, " ", what,
                                          "; files of OpenVolumeMesh hold at most ", limit, "."));
}

constexpr std::size_t kOvmTopologyGrain = 2048;

void requireCounts(std::size_t vertexCount, std::size_t cellCount, std::size_t facesPerCell) {
  requireOvmCount(kMaxOvmEntities, vertexCount, "vertices");
  // Half-faces are numbered with 32 bits.
  requireOvmCount((kNone - 1) / facesPerCell, cellCount, "cells");
}

template <class Cell>
void requireDifferentVertices(std::span<const Cell> cells, Stage& stage) {
  const std::size_t fault =
      firstFault(stage, cells.size(), [cells](std::size_t c) { return !hasVertexTwice(cells[c]); });
  if (fault == cells.size()) return;
  throw Error(
      ErrorCode::RepeatedVertex,
      concat("Cell ", fault, " has a vertex twice; files of OpenVolumeMesh cannot hold that."),
      Place{PlaceKind::Cell, fault});
}

/// Throws if a face has more than two cells, or two on the same side.
template <class Cell>
void requireManifold(std::span<const Cell> cells,
                     std::span<const adjacency::CellFace<Cell>> halfFaces) {
  if (halfFaces.size() == 1) return;
  const adjacency::CellFace<Cell>& a = halfFaces[0];
  const adjacency::CellFace<Cell>& b = halfFaces[1];
  const std::string names = concat("cells ", a.cell, " and ", b.cell);
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

/// Throws the error of a mesh whose faces could not be matched.
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

/// Appends the edges from a vertex to larger ones, in the order in which its tets have them.
/// @param others  scratch, reused between calls
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

/// Appends the faces with this smallest vertex, as half-faces of the first tet that has them.
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
    // A reader derives a cell's corners from its first slot, so the face starts where that slot
    // does in its owner.
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

// Each edge and face of a hexahedron is owned by one of its cells. Away from seams (HexMates), a
// cell owns the three edges and three faces at its corner 0, so that its neighbours determine all
// elements that it shares. Edges along seams are listed separately.

/// The row of kHexFaces in each slot of kOvmHexFaces.
constexpr std::array<std::uint8_t, 6> kFaceOfSlot = {4, 5, 2, 3, 1, 0};
constexpr std::array<std::uint8_t, 6> kSlotOfFace = {5, 4, 2, 3, 0, 1};

/// By corner: bit k is set if it is opposite corner 0 along axis k.
constexpr std::array<std::uint8_t, 8> kSteps = {0, 1, 3, 2, 4, 5, 7, 6};

/// The elements owned by a cell, as bits: edges at corner 0 by axis, faces by slot.
struct Own {
  Index firstEdge;  ///< number of the first owned edge
  Index firstFace;
  std::uint8_t edges;
  std::uint8_t faces;
};
constexpr std::uint8_t kAllEdges = 7;
constexpr std::uint8_t kNearSlots = 1 | 4 | 32;

/// A table, since std::popcount() is a function call without a native instruction.
constexpr auto kBitCounts = [] {
  std::array<std::uint8_t, 64> counts{};
  for (unsigned i = 0; i < 64; ++i) counts[i] = static_cast<std::uint8_t>(std::popcount(i));
  return counts;
}();

/// The number of bits set below bit i.
Index rankOf(unsigned bits, std::size_t i) { return kBitCounts[bits & ((1U << i) - 1)]; }

/// Whether a half-face owns its face rather than its mate: preferably in the first slot of its
/// cell, where the cell's corners and the loop start; then at corner 0, whose edges are at hand.
bool owns(Index halfFace, Index mate) {
  if (mate == kNone) return true;
  const auto rank = [](Index each) {
    const std::size_t face = each % 6;
    return face == kFaceOfSlot[0] ? 0U : 1 + face % 2;
  };
  return std::pair(rank(halfFace), halfFace) < std::pair(rank(mate), mate);
}

/// By edge of kHexEdges: its two faces.
constexpr std::array<std::array<std::uint8_t, 12>, 2> kFacesAtEdges = {
    {{2, 1, 3, 0, 2, 1, 3, 0, 0, 1, 0, 1}, {4, 4, 4, 4, 5, 5, 5, 5, 2, 2, 3, 3}}};

/// Lists the edges between vertices on seams, whose ownership cells cannot determine by themselves.
Array<Edge> listSeamEdges(std::size_t vertexCount, std::span<const Hex> cells,
                          const adjacency::HexMates& mates, Stage& stage) {
  // The first cell at an edge lists it; rarely another one as well.
  const auto isFirst = [&mates](std::size_t cell, std::size_t edge) {
    return std::all_of(kFacesAtEdges.begin(), kFacesAtEdges.end(), [&](const auto& faces) {
      return mates.mates[6 * cell + faces[edge]] > 6 * cell;  // kNone is larger than all
    });
  };
  const adjacency::VertexLists<Index, std::uint64_t> ends(vertexCount, stage, [&](const auto& add) {
    parallelFor(stage, cells.size(), kOvmTopologyGrain, [&](std::size_t c) {
      const unsigned seams = mates.seamCorners[c];
      for (std::size_t e = 0; seams != 0 && e < 12; ++e) {
        const auto& [i, k] = adjacency::kHexEdges[e];
        if ((seams >> i & seams >> k & 1U) == 0 || !isFirst(c, e)) continue;
        add(std::min(cells[c][i], cells[c][k]), std::max(cells[c][i], cells[c][k]));
      }
    });
  });
  Array<Edge> edges;
  for (std::size_t v = 0; v < vertexCount; ++v) {
    Index last = kNone;
    for (const Index end : ends(v)) {
      if (end != last) edges.push_back({static_cast<Index>(v), end});
      last = end;
    }
  }
  return edges;
}

class HexTopologyBuilder {
 public:
  HexTopologyBuilder(std::size_t vertexCount, std::span<const Hex> cells,
                     adjacency::HexMates&& mates, Stage& stage)
      : cells_(cells),
        stage_(stage),
        seamEdges_(listSeamEdges(vertexCount, cells, mates, stage)),
        seamEdgeFinder_(vertexCount, seamEdges_) {
    topology_.vertexCount = vertexCount;
    topology_.cells.length = 6;
    topology_.cells.handles = std::move(mates.mates);
    seamCorners_ = std::move(mates.seamCorners);
  }

  /// @return empty if a cell has a vertex twice
  std::optional<OvmTopology> build() {
    number();
    listEdges();
    if (!listFaces()) return std::nullopt;
    listCells();
    return std::move(topology_);
  }

 private:
  /// The mates of a cell's half-faces, stored in place of its half-faces until listCells().
  [[nodiscard]] const Index* matesOf(std::size_t cell) const {
    return topology_.cells.handles.data() + 6 * cell;
  }
  /// The neighbour behind corner 0 along an axis.
  [[nodiscard]] std::size_t behind(std::size_t cell, std::size_t axis) const {
    return matesOf(cell)[2 * axis + 1] / 6;
  }
  [[nodiscard]] Index ownHalfEdge(std::size_t cell, std::size_t axis) const {
    const Own& own = own_[cell];
    return 2 * (own.firstEdge + rankOf(own.edges, axis));
  }

  /// The elements owned by a cell, not numbered yet.
  [[nodiscard]] Own ownOf(std::size_t cell) const {
    const unsigned seams = seamCorners_[cell];
    if (seams == 0) return {0, 0, kAllEdges, kNearSlots};
    unsigned edges = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      edges |= (seams & seams >> adjacency::kNextCorner[axis] & 1U) == 0 ? 1U << axis : 0U;
    }
    unsigned faces = 0;
    for (std::size_t slot = 0; slot < 6; ++slot) {
      const std::size_t face = kFaceOfSlot[slot];
      faces |= owns(static_cast<Index>(6 * cell + face), matesOf(cell)[face]) ? 1U << slot : 0U;
    }
    return {0, 0, static_cast<std::uint8_t>(edges), static_cast<std::uint8_t>(faces)};
  }

  /// Numbers edges and faces.
  void number() {
    own_.resize(cells_.size());
    parallelFor(stage_, cells_.size(), kOvmTopologyGrain,
                [this](std::size_t c) { own_[c] = ownOf(c); });
    std::uint64_t edges = seamEdges_.size();
    std::uint64_t faces = 0;
    for (Own& own : own_) {
      own.firstEdge = static_cast<Index>(std::exchange(edges, edges + kBitCounts[own.edges]));
      own.firstFace = static_cast<Index>(std::exchange(faces, faces + kBitCounts[own.faces]));
    }
    requireOvmCount(kMaxOvmEntities, faces, "faces");
    requireOvmCount(kMaxOvmEntities, edges, "edges");
    topology_.edges.resize(static_cast<std::size_t>(edges));
    topology_.faces.length = 4;
    topology_.faces.handles.resize(static_cast<std::size_t>(4 * faces));
  }

  void listEdges() {
    std::copy(seamEdges_.begin(), seamEdges_.end(), topology_.edges.begin());
    parallelFor(stage_, cells_.size(), kOvmTopologyGrain, [this](std::size_t c) {
      Edge* edge = topology_.edges.data() + own_[c].firstEdge;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if ((own_[c].edges >> axis & 1U) != 0)
          *edge++ = {cells_[c][0], cells_[c][adjacency::kNextCorner[axis]]};
      }
    });
  }

  /// The half-edge between two corners of a cell.
  [[nodiscard]] Index halfEdge(std::size_t cell, std::size_t from, std::size_t to) const {
    const unsigned seams = seamCorners_[cell];
    if ((seams >> from & seams >> to & 1U) != 0) {
      return seamEdgeFinder_.halfEdge(cells_[cell][from], cells_[cell][to]);
    }
    const unsigned along = kSteps[from] ^ kSteps[to];
    const unsigned steps = kSteps[from] & kSteps[to];
    std::size_t owner = cell;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if ((steps >> axis & 1U) != 0) owner = behind(owner, axis);
    }
    return ownHalfEdge(owner, along / 2) + ((kSteps[from] & along) != 0 ? 1U : 0U);
  }

  /// Lists the half-edges of faces.
  /// @return whether the vertices of every cell are distinct. Checked here, while the loop waits
  /// for
  ///         memory; a separate loop makes conversions of large meshes 5 % slower.
  [[nodiscard]] bool listFaces() {
    const auto list = [this](std::size_t c) {
      Index* const halfEdges = topology_.faces.handles.data() + 4 * std::size_t{own_[c].firstFace};
      seamCorners_[c] == 0 ? listNearFaces(c, halfEdges) : listOwnFaces(c, halfEdges);
      return !hasVertexTwice(cells_[c]);
    };
    return firstFault(stage_, cells_.size(), list) == cells_.size();
  }

  /// Lists the faces owned by a cell that touches no seam.
  void listNearFaces(std::size_t cell, Index* halfEdges) const {
    const std::array<std::size_t, 3> next = {behind(cell, 0), behind(cell, 1), behind(cell, 2)};
    // As kOvmHexFaces traverses corners 0, 1, 2, 3; 0, 4, 5, 1; and 0, 3, 7, 4.
    for (const std::size_t axis : {2U, 1U, 0U}) {
      const std::size_t a = (axis + 1) % 3;
      const std::size_t b = (axis + 2) % 3;
      *halfEdges++ = ownHalfEdge(cell, a);
      *halfEdges++ = ownHalfEdge(next[a], b);
      *halfEdges++ = ownHalfEdge(next[b], a) + 1;
      *halfEdges++ = ownHalfEdge(cell, b) + 1;
    }
  }

  /// The same for any cell.
  void listOwnFaces(std::size_t cell, Index* halfEdges) const {
    for (std::size_t slot = 0; slot < 6; ++slot) {
      if ((own_[cell].faces >> slot & 1U) == 0) continue;
      const std::array<std::uint8_t, 4>& corners = kOvmHexFaces[slot];
      for (std::size_t i = 0; i < 4; ++i) {
        *halfEdges++ = halfEdge(cell, corners[i], corners[(i + 1) % 4]);
      }
    }
  }

  /// Replaces mates by half-faces.
  void listCells() {
    const auto numberOf = [this](std::size_t cell, std::size_t slot) {
      return own_[cell].firstFace + rankOf(own_[cell].faces, slot);
    };
    parallelFor(stage_, cells_.size(), kOvmTopologyGrain, [&](std::size_t c) {
      Index* const handles = topology_.cells.handles.data() + 6 * c;
      std::array<Index, 6> mates;  // NOLINT(*-member-init): fully overwritten
      std::copy_n(handles, 6, mates.begin());
      for (std::size_t slot = 0; slot < 6; ++slot) {
        const Index mate = mates[kFaceOfSlot[slot]];
        handles[slot] = (own_[c].faces >> slot & 1U) != 0
                            ? 2 * numberOf(c, slot)
                            : 2 * numberOf(mate / 6, kSlotOfFace[mate % 6]) + 1;
      }
    });
  }

  std::span<const Hex> cells_;
  Stage& stage_;
  OvmTopology topology_;
  Array<std::uint8_t> seamCorners_;  ///< see HexMates
  Array<Edge> seamEdges_;
  OvmEdgeFinder seamEdgeFinder_;
  Array<Own> own_;  ///< per cell
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
    std::optional<OvmTopology> topology =
        HexTopologyBuilder(vertexCount, cells, std::move(*mates), stage).build();
    if (topology) return std::move(*topology);
  }
  requireDifferentVertices(cells, stage);
  throwFaceFault(vertexCount, cells, stage);
}

}  // namespace hexhex::io
