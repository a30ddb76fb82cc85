#include <algorithm>
#include <array>
#include <atomic>
#include <utility>
#include <vector>

#include <adjacency/corner_order.hpp>
#include <adjacency/key_table.hpp>
#include <adjacency/tet_topology.hpp>

namespace hexhex {

namespace {

/// Vertices whose faces are matched in one go; small meshes must still have work for all threads.
constexpr std::size_t kVertexGrain = 256;

/// Tets are divided into at most as many parts: each part costs three numbers per vertex.
constexpr std::size_t kMaxParts = 8;

/// A way around a triangle, as a bit: vertices ascend but for a rotation, or descend.
using Direction = std::uint8_t;
constexpr Direction kAscending = 1;
constexpr Direction kDescending = 2;

/// By order and face: the direction of the face's corners in the order of kFaceCorners.
constexpr auto kDirections = byCornerOrder<std::array<Direction, 4>>([](const Tet& tet) {
  std::array<Direction, 4> directions{};
  for (std::size_t face = 0; face < 4; ++face) {
    const auto [a, b, c] = faceVertices(tet, face);
    const int descents = (b < a ? 1 : 0) + (c < b ? 1 : 0) + (a < c ? 1 : 0);
    directions[face] = descents == 1 ? kAscending : kDescending;
  }
  return directions;
});

/// Each triangle is found at its smallest vertex. In a tet, that is the tet's smallest vertex for
/// three faces and the second smallest for the fourth: so each tet is in two linked lists, one of
/// the tets whose smallest vertex it is and one of those whose second smallest. Each thread has
/// lists of its own.
struct FaceLists {
  struct Heads {
    Index threeFaces = kNone;  ///< the first tet of whom this is the smallest vertex,
    Index oneFace = kNone;     ///< and the second smallest
    Index smallest = kNone;    ///< tet of all
  };
  struct Next {
    Index threeFaces;
    Index oneFace;
  };
  std::size_t parts = 1;
  std::size_t vertices = 0;
  Array<Heads> heads;  ///< per part and vertex
  Array<Next> next;    ///< per tet: the tet behind it in both lists, or kNone

  [[nodiscard]] const Heads& at(std::size_t part, Index vertex) const {
    return heads[part * vertices + vertex];
  }
  [[nodiscard]] Index smallestTet(Index vertex) const {
    Index smallest = kNone;
    for (std::size_t part = 0; part < parts; ++part) {
      smallest = std::min(smallest, at(part, vertex).smallest);
    }
    return smallest;
  }
};

/// Enters tets [begin, end) into the lists of one part, and notes how their corners are ordered.
void listFaces(FaceLists& lists, TetTopology& topology, std::size_t part, std::size_t begin,
               std::size_t end) {
  FaceLists::Heads* const heads =
      lists.heads.data() + part * lists.vertices;  // null without vertices
  std::fill_n(heads, lists.vertices, FaceLists::Heads());
  // Backwards, so that the last tet to write is the smallest.
  for (std::size_t t = end; t > begin; --t) {
    const Tet& tet = topology.tets[t - 1];
    const auto index = static_cast<Index>(t - 1);
    for (const Index v : tet) heads[v].smallest = index;
    const CornerOrder order = cornerOrder(tet);
    const std::array<std::uint8_t, 4>& ascending = kAscendingCorners[order];
    topology.order[index] = order;
    lists.next[index] = {std::exchange(heads[tet[ascending[0]]].threeFaces, index),
                         std::exchange(heads[tet[ascending[1]]].oneFace, index)};
  }
}

FaceLists listFaces(TetTopology& topology, Stage& stage) {
  FaceLists lists;
  lists.parts = std::min(kMaxParts, static_cast<std::size_t>(currentThreads()));
  lists.vertices = topology.pointCount;
  lists.heads.resize(lists.parts * lists.vertices);
  lists.next.resize(topology.tetCount());
  topology.order.resize(topology.tetCount());
  const std::size_t tets = topology.tetCount();
  parallelFor(stage, lists.parts, 1, [&](std::size_t part) {
    listFaces(lists, topology, part, tets * part / lists.parts, tets * (part + 1) / lists.parts);
  });
  return lists;
}

/// Matches the half-faces at one vertex after the other.
class FaceMatcher {
 public:
  FaceMatcher(const FaceLists& lists, TetTopology& topology) : lists_(lists), topology_(topology) {}

  void matchAt(Index vertex) {
    triangles_.clear();
    firsts_.clear();
    for (std::size_t part = 0; part < lists_.parts; ++part) {
      const FaceLists::Heads& heads = lists_.at(part, vertex);
      for (Index t = heads.threeFaces; t != kNone; t = lists_.next[t].threeFaces) {
        for (std::size_t rank = 1; rank < 4; ++rank) match(t, rank);
      }
      for (Index t = heads.oneFace; t != kNone; t = lists_.next[t].oneFace) match(t, 0);
    }
  }

  /// Whether no triangle was there more than twice, or twice in the same direction.
  [[nodiscard]] bool isSound() const { return isSound_; }

 private:
  struct First {
    HalfFace halfFace;
    Direction directions;  ///< of all half-faces of the triangle so far
  };

  /// Matches a half-face with the first one of its triangle, or is that.
  /// @param rank  of the corner opposite it, by which the vertex is the smallest or second smallest
  void match(Index t, std::size_t rank) {
    const Tet& tet = topology_.tets[t];
    const CornerOrder order = topology_.order[t];
    const std::array<std::uint8_t, 4>& ascending = kAscendingCorners[order];
    const HalfFace halfFace = 4 * t + ascending[rank];
    const Direction direction = kDirections[order][ascending[rank]];
    const std::uint64_t low = tet[ascending[rank < 2 ? 2 : 1]];
    const Index number = triangles_.insert(low << 32 | tet[ascending[rank < 3 ? 3 : 2]]);
    if (number == firsts_.size()) {
      firsts_.push_back({halfFace, direction});
      topology_.mate[halfFace] = kNone;
      return;
    }
    First& first = firsts_[number];
    topology_.mate[halfFace] = first.halfFace;
    topology_.mate[first.halfFace] = halfFace;
    isSound_ = isSound_ && (first.directions & direction) == 0;
    first.directions = kAscending | kDescending;
  }

  const FaceLists& lists_;
  TetTopology& topology_;
  /// The triangles at a vertex by their other two vertices, the smaller one in the upper half.
  KeyTable<std::uint64_t> triangles_;
  std::vector<First> firsts_;
  bool isSound_ = true;
};

}  // namespace

bool matchFaces(TetTopology& topology, Stage& stage) {
  const FaceLists lists = listFaces(topology, stage);
  topology.mate.resize(4 * topology.tetCount());
  topology.vertexTet.resize(topology.pointCount);
  std::atomic<bool> sound = true;
  parallelBlocks(stage, topology.pointCount, kVertexGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   FaceMatcher matcher(lists, topology);
                   for (std::size_t i = begin; i < end; ++i) {
                     const auto v = static_cast<Index>(i);
                     topology.vertexTet[v] = lists.smallestTet(v);
                     matcher.matchAt(v);
                   }
                   if (!matcher.isSound()) sound = false;
                 });
  return sound;
}

}  // namespace hexhex
