// Edges and faces of tets, found vertex by vertex: those whose smallest vertex it is. A vertex
// numbers its edges as its tets come, and a face there is a pair of edges, so that a small table
// with a place for each pair tells whether the face is new.
#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <utility>
#include <vector>

#include <adjacency/vertex_lists.hpp>

#include <base/branchless.hpp>
#include <base/parallel.hpp>
#include <io/ovm/ovm_tet_topology.hpp>
#include <io/ovm/ovm_topology.hpp>

namespace hexhex {
namespace {

constexpr std::size_t kGrain = 2048;
/// Vertices are divided into so many parts if there are several threads: each has a number per
/// vertex of the mesh.
constexpr std::size_t kParts = 16;
/// The table of a vertex has the square of this many places at most.
constexpr std::size_t kMostEdges = 256;

/// The slot of kOvmTetFaces opposite each corner.
constexpr std::array<std::uint8_t, 4> kSlotOpposite = {3, 1, 2, 0};

/// The place of the edge between two corners among the six of a tet.
constexpr std::array<std::array<std::uint8_t, 4>, 4> kPairs = {
    {{6, 0, 1, 2}, {0, 6, 3, 4}, {1, 3, 6, 5}, {2, 4, 5, 6}}};

/// The corners of a tet from the smallest vertex to the largest.
struct SortedTet {
  std::array<Index, 4> vertices;
  std::array<std::uint8_t, 4> corners;  ///< where the tet lists them
  bool odd;                             ///< whether that is an odd permutation
};

SortedTet sortTet(const Tet& tet) {
  std::array<std::uint64_t, 4> keys;  // NOLINT(*-member-init): all of it is set
  for (std::size_t i = 0; i < 4; ++i) keys[i] = std::uint64_t{tet[i]} << 2U | i;
  unsigned exchanges = 0;
  const auto order = [&](std::size_t i, std::size_t k) {
    const std::uint64_t a = keys[i];
    const std::uint64_t b = keys[k];
    exchanges += b < a ? 1U : 0U;
    keys[i] = std::min(a, b);
    keys[k] = std::max(a, b);
  };
  order(0, 1);
  order(2, 3);
  order(0, 2);
  order(1, 3);
  order(1, 2);
  SortedTet sorted;  // NOLINT(*-member-init): all of it is set
  for (std::size_t i = 0; i < 4; ++i) {
    sorted.vertices[i] = static_cast<Index>(keys[i] >> 2U);
    sorted.corners[i] = static_cast<std::uint8_t>(keys[i] & 3U);
  }
  sorted.odd = exchanges % 2 == 1;
  return sorted;
}

/// What is found at the vertices from `begin` to `end`, numbered from 0 on.
struct Part {
  std::size_t begin = 0;
  std::size_t end = 0;
  Array<std::array<Index, 2>> edges;
  Array<Index> owners;  ///< per face: the side, 4 * tet + slot, whose loop is half-face 2f
};

class TetTopologyBuilder {
 public:
  TetTopologyBuilder(std::size_t vertexCount, std::span<const Tet> tets, Stage& stage)
      : tets_(tets), stage_(stage), lists_(vertexCount, stage), parts_(alone() ? 1 : kParts) {
    topology_.vertexCount = vertexCount;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      parts_[i].begin = vertexCount * i / parts_.size();
      parts_[i].end = vertexCount * (i + 1) / parts_.size();
    }
  }

  std::optional<OvmTopology> build() {
    listTets();
    if (!sound_) return std::nullopt;
    findAtVertices();
    if (!sound_ || !joinParts()) return std::nullopt;
    listFaces();
    return std::move(topology_);
  }

 private:
  static bool alone() { return currentThreads() == 1; }
  void listTets();
  void findAtVertices();
  bool joinParts();
  [[nodiscard]] const Part& partOf(Index vertex) const;
  void addOffsets(std::span<const Index> edges, std::span<const Index> faces);
  void listFaces();

  friend class VertexWork;

  std::span<const Tet> tets_;
  Stage& stage_;
  OvmTopology topology_;
  /// Per vertex: 4 * tet + its rank among the tet's vertices, except for the largest one.
  VertexLists<Index> lists_;
  std::vector<Part> parts_;
  std::atomic<bool> sound_{true};
  Array<std::array<Index, 6>> tetEdges_;  ///< per tet: its edges, by the ranks of their vertices
};

/// Finds the edges and faces of one vertex after the other.
class VertexWork {
 public:
  VertexWork(TetTopologyBuilder& builder, Part& part)
      : builder_(builder), part_(part), edgeTo_(builder.topology_.vertexCount, 0) {}

  /// @return whether all is well
  bool run(std::size_t vertex) {
    const std::span<Index> tets = builder_.lists_.at(vertex);
    if (!std::is_sorted(tets.begin(), tets.end())) std::sort(tets.begin(), tets.end());
    firstEdge_ = static_cast<Index>(part_.edges.size());
    for (const Index entry : tets) addEdges(entry / 4, entry % 4);
    edgeCount_ = part_.edges.size() - firstEdge_;
    if (edgeCount_ > kMostEdges) return false;
    table_.assign(edgeCount_ * edgeCount_, Face{});
    bool good = true;
    for (const Index entry : tets) good = addFaces(entry / 4, entry % 4) && good;
    return good;
  }

 private:
  /// A face that was found at the vertex.
  struct Face {
    Index number = kNone;
    Index side = kNone;  ///< the one that it has so far; kNone after both
    bool odd = false;    ///< in which direction that side passes it
  };

  void addEdges(Index t, std::size_t rank) {
    const SortedTet tet = sortTet(builder_.tets_[t]);
    for (std::size_t i = rank + 1; i < 4; ++i) {
      Index& edge = edgeTo_[tet.vertices[i]];
      if (edge <= firstEdge_) {  // that of an earlier vertex
        part_.edges.push_back({tet.vertices[rank], tet.vertices[i]});
        edge = static_cast<Index>(part_.edges.size());
      }
      builder_.tetEdges_[t][kPairs[rank][i]] = edge - 1;
    }
  }

  bool addFaces(Index t, std::size_t rank) {
    if (rank == 2) return true;
    const SortedTet tet = sortTet(builder_.tets_[t]);
    const auto add = [&](std::size_t i, std::size_t k) {
      const std::size_t opposite = 6 - rank - i - k;
      return addSide(4 * t + kSlotOpposite[tet.corners[opposite]], (opposite % 2 == 1) != tet.odd,
                     builder_.tetEdges_[t][kPairs[rank][i]] - firstEdge_,
                     builder_.tetEdges_[t][kPairs[rank][k]] - firstEdge_);
    };
    if (rank == 1) return add(2, 3);
    // In the order of slots, if the tet lists its vertices like this.
    const bool first = add(1, 2);
    const bool second = add(2, 3);
    return add(1, 3) && first && second;
  }

  /// @param a, b  the vertex's edges in the side
  bool addSide(Index side, bool odd, std::size_t a, std::size_t b) {
    Index* const halfFaces = builder_.topology_.cells.handles.data();
    Face& face = table_[std::min(a, b) * edgeCount_ + std::max(a, b)];
    if (face.number == kNone) {
      face = {static_cast<Index>(part_.owners.size()), side, odd};
      part_.owners.push_back(side);
      halfFaces[side] = 2 * face.number;
      return true;
    }
    if (face.side == kNone || face.odd == odd) return false;
    // The corners of a cell begin with its first slot, so a reader finds them in their order if the
    // face begins where that does.
    const Index owns = side % 4 < face.side % 4 ? 1 : 0;
    halfFaces[side] = 2 * face.number + 1 - owns;
    halfFaces[face.side] = 2 * face.number + owns;
    if (owns != 0) part_.owners[face.number] = side;
    face.side = kNone;
    return true;
  }

  TetTopologyBuilder& builder_;
  Part& part_;
  Array<Index> edgeTo_;  ///< per vertex: one more than the number of the last edge to it
  Index firstEdge_ = 0;
  std::size_t edgeCount_ = 0;
  std::vector<Face> table_;  ///< by pair of edges
};

void TetTopologyBuilder::listTets() {
  const auto forEach = [this](const auto& f) {
    parallelFor(stage_, tets_.size(), kGrain, [&](std::size_t t) { f(t, sortTet(tets_[t])); });
  };
  forEach([this](std::size_t /*t*/, const SortedTet& tet) {
    const auto& v = tet.vertices;
    if (anyOf(v[0] == v[1], v[1] == v[2], v[2] == v[3])) sound_ = false;
    for (std::size_t rank = 0; rank < 3; ++rank) lists_.count(v[rank]);
  });
  lists_.makeRoom();
  forEach([this](std::size_t t, const SortedTet& tet) {
    for (std::size_t rank = 0; rank < 3; ++rank) {
      lists_.enter(tet.vertices[rank], static_cast<Index>(4 * t + rank));
    }
  });
}

void TetTopologyBuilder::findAtVertices() {
  topology_.cells.length = 4;
  topology_.cells.handles.resize(4 * tets_.size());
  tetEdges_.resize(tets_.size());
  LoopProgress progress(stage_, topology_.vertexCount);
  parallelFor(stage_, parts_.size(), 1, [&](std::size_t i) {
    VertexWork work(*this, parts_[i]);
    for (std::size_t v = parts_[i].begin; v < parts_[i].end && sound_; ++v) {
      if (!work.run(v)) sound_ = false;
      if (v % kGrain == 0) progress.advance(kGrain);
    }
  });
}

/// Numbers everything from the first part on.
/// @return false if there is too much of it
bool TetTopologyBuilder::joinParts() {
  std::vector<Index> edges;
  std::vector<Index> faces;
  std::uint64_t edgeCount = 0;
  std::uint64_t faceCount = 0;
  for (const Part& part : parts_) {
    edges.push_back(static_cast<Index>(edgeCount));
    faces.push_back(static_cast<Index>(faceCount));
    edgeCount += part.edges.size();
    faceCount += part.owners.size();
  }
  if (std::max(edgeCount, faceCount) > kMaxOvmEntities) return false;
  if (parts_.size() == 1) {
    topology_.edges = std::move(parts_[0].edges);
    return true;
  }
  topology_.edges.resize(static_cast<std::size_t>(edgeCount));
  parallelFor(stage_, parts_.size(), 1, [&](std::size_t i) {
    std::copy(parts_[i].edges.begin(), parts_[i].edges.end(), topology_.edges.data() + edges[i]);
  });
  addOffsets(edges, faces);
  return true;
}

const Part& TetTopologyBuilder::partOf(Index vertex) const {
  return *std::find_if(parts_.begin(), parts_.end(),
                       [vertex](const Part& part) { return vertex < part.end; });
}

/// @param edges, faces  how many the parts before each part have
void TetTopologyBuilder::addOffsets(std::span<const Index> edges, std::span<const Index> faces) {
  parallelFor(stage_, tets_.size(), kGrain, [&](std::size_t t) {
    const SortedTet tet = sortTet(tets_[t]);
    std::array<std::size_t, 3> parts;  // NOLINT(*-member-init): all of it is set
    for (std::size_t rank = 0; rank < 3; ++rank) {
      parts[rank] = static_cast<std::size_t>(&partOf(tet.vertices[rank]) - parts_.data());
      for (std::size_t i = rank + 1; i < 4; ++i) {
        tetEdges_[t][kPairs[rank][i]] += edges[parts[rank]];
      }
    }
    for (std::size_t opposite = 0; opposite < 4; ++opposite) {
      topology_.cells.handles[4 * t + kSlotOpposite[tet.corners[opposite]]] +=
          2 * faces[parts[opposite == 0 ? 1 : 0]];
    }
  });
}

void TetTopologyBuilder::listFaces() {
  std::size_t faces = 0;
  for (const Part& part : parts_) faces += part.owners.size();
  topology_.faces.length = 3;
  topology_.faces.handles.resize(3 * faces);
  Index* next = topology_.faces.handles.data();
  for (const Part& part : parts_) {
    parallelFor(stage_, part.owners.size(), kGrain, [&, begin = next](std::size_t f) {
      const Index t = part.owners[f] / 4;
      const std::array<std::uint8_t, 3>& corners = kOvmTetFaces[part.owners[f] % 4];
      const SortedTet tet = sortTet(tets_[t]);
      std::array<std::uint8_t, 4> ranks;  // NOLINT(*-member-init): all of it is set
      for (std::uint8_t i = 0; i < 4; ++i) ranks[tet.corners[i]] = i;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint8_t from = ranks[corners[i]];
        const std::uint8_t to = ranks[corners[(i + 1) % 3]];
        begin[3 * f + i] = 2 * tetEdges_[t][kPairs[from][to]] + (from < to ? 0U : 1U);
      }
    });
    next += 3 * part.owners.size();
  }
}

}  // namespace

std::optional<OvmTopology> buildOvmTetTopology(std::size_t vertexCount, std::span<const Tet> tets,
                                               Stage& stage) {
  return TetTopologyBuilder(vertexCount, tets, stage).build();
}

}  // namespace hexhex
