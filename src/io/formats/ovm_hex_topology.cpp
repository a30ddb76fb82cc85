// Edges and faces of hexahedra belong to one of their cells each: away from seams (HexMates), a
// cell has the three edges and the three faces at its corner 0, so that a look at the neighbours
// tells all that it shares with them. Edges along seams are listed by themselves.
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <utility>

#include <adjacency/cell_faces.hpp>
#include <adjacency/vertex_lists.hpp>

#include <base/parallel.hpp>
#include <io/formats/ovm_cells.hpp>

namespace hexhex::io {

namespace {

constexpr std::size_t kOvmHexTopologyGrain = 2048;
/// The row of kHexFaces in each slot of kOvmHexFaces.
constexpr std::array<std::uint8_t, 6> kFaceOfSlot = {4, 5, 2, 3, 1, 0};
constexpr std::array<std::uint8_t, 6> kSlotOfFace = {5, 4, 2, 3, 0, 1};

/// By corner: bit k if it is across from corner 0 along axis k.
constexpr std::array<std::uint8_t, 8> kSteps = {0, 1, 3, 2, 4, 5, 7, 6};

/// What belongs to a cell, as bits: its edges at corner 0 by axis, and its faces by slot.
struct Own {
  Index firstEdge;  ///< number of the first of them
  Index firstFace;
  std::uint8_t edges;
  std::uint8_t faces;
};
constexpr std::uint8_t kAllEdges = 7;
constexpr std::uint8_t kNearSlots = 1 | 4 | 32;

/// Without a processor's instruction for it, std::popcount() would be a call.
constexpr auto kBitCounts = [] {
  std::array<std::uint8_t, 64> counts{};
  for (unsigned i = 0; i < 64; ++i) counts[i] = static_cast<std::uint8_t>(std::popcount(i));
  return counts;
}();

/// How many bits are set below bit i.
Index rankOf(unsigned bits, std::size_t i) { return kBitCounts[bits & ((1U << i) - 1)]; }

/// Whether a half-face has the face rather than its mate: a cell begins with its first slot, and so
/// does the face's loop; and faces at corner 0 have edges that are at hand.
bool owns(Index halfFace, Index mate) {
  if (mate == kNone) return true;
  const auto rank = [](Index each) {
    const std::size_t face = each % 6;
    return face == kFaceOfSlot[0] ? 0U : 1 + face % 2;
  };
  return std::pair(rank(halfFace), halfFace) < std::pair(rank(mate), mate);
}

using Edge = std::array<Index, 2>;

/// By edge of kHexEdges: one face and the other face that have it.
constexpr std::array<std::array<std::uint8_t, 12>, 2> kFacesAtEdges = {
    {{2, 1, 3, 0, 2, 1, 3, 0, 0, 1, 0, 1}, {4, 4, 4, 4, 5, 5, 5, 5, 2, 2, 3, 3}}};

/// The edges between vertices on seams, which cells cannot tell by themselves to be new.
Array<Edge> listSeamEdges(std::size_t vertexCount, std::span<const Hex> cells,
                          const adjacency::HexMates& mates, Stage& stage) {
  // Of the cells at an edge, the first one lists it, and few others.
  const auto isFirst = [&mates](std::size_t cell, std::size_t edge) {
    return std::all_of(kFacesAtEdges.begin(), kFacesAtEdges.end(), [&](const auto& faces) {
      return mates.mates[6 * cell + faces[edge]] > 6 * cell;  // kNone is larger than all
    });
  };
  const adjacency::VertexLists<Index, std::uint64_t> ends(vertexCount, stage, [&](const auto& add) {
    parallelFor(stage, cells.size(), kOvmHexTopologyGrain, [&](std::size_t c) {
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

  std::optional<OvmTopology> build() {
    number();
    listEdges();
    if (!listFaces()) return std::nullopt;
    listCells();
    return std::move(topology_);
  }

 private:
  /// Until cells are listed, their half-faces' places hold the mates of these.
  [[nodiscard]] const Index* matesOf(std::size_t cell) const {
    return topology_.cells.handles.data() + 6 * cell;
  }
  /// The neighbour across from corner 0.
  [[nodiscard]] std::size_t behind(std::size_t cell, std::size_t axis) const {
    return matesOf(cell)[2 * axis + 1] / 6;
  }
  [[nodiscard]] Index ownHalfEdge(std::size_t cell, std::size_t axis) const {
    const Own& own = own_[cell];
    return 2 * (own.firstEdge + rankOf(own.edges, axis));
  }

  /// Without numbers.
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
    parallelFor(stage_, cells_.size(), kOvmHexTopologyGrain,
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
    parallelFor(stage_, cells_.size(), kOvmHexTopologyGrain, [this](std::size_t c) {
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

  /// @return whether all cells have different vertices: asked here, where memory keeps processors
  /// waiting anyway. With a loop of its own, conversions of large meshes take 5 % longer.
  [[nodiscard]] bool listFaces() {
    const auto list = [this](std::size_t c) {
      Index* const halfEdges = topology_.faces.handles.data() + 4 * std::size_t{own_[c].firstFace};
      seamCorners_[c] == 0 ? listNearFaces(c, halfEdges) : listOwnFaces(c, halfEdges);
      return !hasVertexTwice(cells_[c]);
    };
    return firstFault(stage_, cells_.size(), list) == cells_.size();
  }

  /// The faces of a cell that is on no seam, in order.
  void listNearFaces(std::size_t cell, Index* halfEdges) const {
    const std::array<std::size_t, 3> next = {behind(cell, 0), behind(cell, 1), behind(cell, 2)};
    // As kOvmHexFaces passes corners 0, 1, 2, 3; 0, 4, 5, 1; and 0, 3, 7, 4.
    for (const std::size_t axis : {2U, 1U, 0U}) {
      const std::size_t a = (axis + 1) % 3;
      const std::size_t b = (axis + 2) % 3;
      *halfEdges++ = ownHalfEdge(cell, a);
      *halfEdges++ = ownHalfEdge(next[a], b);
      *halfEdges++ = ownHalfEdge(next[b], a) + 1;
      *halfEdges++ = ownHalfEdge(cell, b) + 1;
    }
  }

  /// The same of any cell.
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
    parallelFor(stage_, cells_.size(), kOvmHexTopologyGrain, [&](std::size_t c) {
      Index* const handles = topology_.cells.handles.data() + 6 * c;
      std::array<Index, 6> mates;  // NOLINT(*-member-init): all of it is set
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

std::optional<OvmTopology> numberHexes(std::size_t vertexCount, std::span<const Hex> cells,
                                       adjacency::HexMates mates, Stage& stage) {
  return HexTopologyBuilder(vertexCount, cells, std::move(mates), stage).build();
}

}  // namespace hexhex::io
