// Matches the half-faces of tets: each triangle at its smallest vertex, by a small hash table.
#include <algorithm>
#include <array>
#include <atomic>
#include <utility>
#include <vector>

#include <adjacency/tet_topology.hpp>

namespace hexhex::adjacency {

namespace {

/// Vertices per block; small meshes must still have work for all threads.
constexpr std::size_t kVertexGrain = 256;

/// Tets are divided into at most this many parts: each costs three numbers per vertex.
constexpr std::size_t kMaxParts = 8;

/// A half-face in the hash table: the lower half is its number. In the upper half, bit 0 is set if
/// its corners, in the order of kFaceCorners, ascend up to rotation, bit 1 if they descend, and
/// both if it has been matched. So two that share a bit must not be matched.
using OpenFace = std::uint64_t;
constexpr OpenFace kAscends = std::uint64_t{1} << 32;
constexpr OpenFace kDescends = std::uint64_t{2} << 32;
/// A matched half-face; no half-face yet.
constexpr OpenFace kMatched = kAscends | kDescends;
constexpr OpenFace kNoFace = kNone;

/// Per order of a tet, and per rank of the corner opposite a face: the face's number within the
/// tet, and whether it ascends or descends.
constexpr auto kRankedFaces = byCornerOrder<std::array<OpenFace, 4>>([](const Tet& tet) {
  std::array<OpenFace, 4> faces{};
  for (std::size_t rank = 0; rank < 4; ++rank) {
    const std::size_t corner = kAscendingCorners[cornerOrder(tet)][rank];
    const std::array<int, 3>& face = lattice::kFaceCorners[corner];
    int descents = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Index here = tet[static_cast<std::size_t>(face[k])];
      const Index next = tet[static_cast<std::size_t>(face[(k + 1) % 3])];
      descents += next < here ? 1 : 0;
    }
    faces[rank] = corner | (descents == 1 ? kAscends : kDescends);
  }
  return faces;
});

/// Each triangle is found at its smallest vertex. That is the tet's smallest vertex for three
/// faces, and its second smallest for the fourth: so each tet is in two linked lists, one of the
/// tets with this smallest vertex and one of those with this second smallest. Each thread has its
/// own lists.
struct FaceLists {
  struct Heads {
    Index threeFaces = kNone;  ///< the first tet whose smallest vertex this is,
    Index oneFace = kNone;     ///< and whose second smallest it is
    Index smallest = kNone;    ///< the smallest tet of all at it
  };
  struct Next {
    Index threeFaces;
    Index oneFace;
  };
  std::size_t parts = 1;
  std::size_t vertices = 0;
  Array<Heads> heads;  ///< per part and vertex
  Array<Next> next;    ///< per tet: the next one in both lists, or kNone

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

/// Enters tets [begin, end) into the lists of one part, and records the order of their corners.
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
    const std::array<std::uint8_t, 4>& corners = kAscendingCorners[order];
    topology.order[index] = order;
    lists.next[index] = {std::exchange(heads[tet[corners[0]]].threeFaces, index),
                         std::exchange(heads[tet[corners[1]]].oneFace, index)};
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

/// An entry of the hash table at a vertex: a triangle's other two vertices, the smaller one in the
/// upper half, and its half-face.
struct FoundFace {
  std::uint64_t vertices = 0;
  OpenFace face = kNoFace;
};

/// Memory of a hash table for the half-faces at a vertex.
struct FaceTable {
  /// Enough at nearly every vertex, and cleared in no time.
  static constexpr int kBits = 8;

  std::vector<std::uint32_t> slots;  ///< indices in `found`; 0: empty
  std::vector<FoundFace> found;
};

/// Matches the half-faces at one vertex, by a hash table. Whether a triangle is found for the first
/// or the second time cannot be predicted, so both cases take the same path (key_table.hpp has the
/// figure).
class FaceMatcher {
 public:
  /// @param bits  of the table's size
  FaceMatcher(FaceTable& table, int bits, HalfFace* mate) : mate_(mate), shift_(64 - bits) {
    table.slots.assign(std::size_t{1} << bits, 0);
    table.found.resize(table.slots.size() / 4 * 3);
    table.found[0].face = kNoFace;
    slots_ = table.slots;
    found_ = table.found;
  }

  /// Whether this many more can be added.
  [[nodiscard]] bool hasRoom(std::size_t more) const { return count_ + more < found_.size(); }

  /// @param low,high  the other two vertices, low < high
  void add(Index low, Index high, OpenFace face) {
    const std::uint64_t key = (std::uint64_t{low} << 32) | high;
    std::uint32_t& slot = slotOf(key);
    const std::uint64_t isKnown = slot == 0 ? 0 : ~std::uint64_t{0};
    const OpenFace other = found_[slot].face;
    slot = ++count_;
    found_[count_] = {key, face | (kMatched & isKnown)};
    shared_ |= face & other;
    const auto here = static_cast<HalfFace>(face);
    const auto there = static_cast<HalfFace>(other);
    mate_[here ^ ((here ^ there) & static_cast<HalfFace>(isKnown))] = here;
    mate_[here] = there;
  }

  /// Whether no triangle occurred more than twice, or twice with the same orientation.
  [[nodiscard]] bool isSound() const { return (shared_ & kMatched) == 0; }

 private:
  /// The slot with the number of a triangle's last half-face; 0 if there has been none.
  [[nodiscard]] std::uint32_t& slotOf(std::uint64_t key) {
    found_[0].vertices = key;  // ends the search at an empty slot
    // Odd, and near 2^64 / golden ratio: the upper bits of products with it spread well.
    std::size_t i = (key * 0x9e3779b97f4a7c15U) >> shift_;
    while (found_[slots_[i]].vertices != key) i = (i + 1) & (slots_.size() - 1);
    return slots_[i];
  }

  HalfFace* mate_;
  int shift_;
  std::span<std::uint32_t> slots_;
  std::span<FoundFace> found_;
  std::uint32_t count_ = 0;
  OpenFace shared_ = 0;
};

/// Matches the half-faces with the same smallest vertex.
/// @return false if they do not fit the table
bool matchFacesAt(Index v, const FaceLists& lists, TetTopology& topology, FaceTable& table,
                  int bits, bool& sound) {
  FaceMatcher matcher(table, bits, topology.mate.data());
  for (std::size_t part = 0; part < lists.parts; ++part) {
    const FaceLists::Heads& heads = lists.at(part, v);
    for (Index t = heads.threeFaces; t != kNone; t = lists.next[t].threeFaces) {
      if (!matcher.hasRoom(3)) return false;
      const Tet& tet = topology.tets[t];
      const auto& corners = kAscendingCorners[topology.order[t]];
      const auto& faces = kRankedFaces[topology.order[t]];
      const Index a = tet[corners[1]];
      const Index b = tet[corners[2]];
      const Index c = tet[corners[3]];
      matcher.add(b, c, 4 * t + faces[1]);
      matcher.add(a, c, 4 * t + faces[2]);
      matcher.add(a, b, 4 * t + faces[3]);
    }
    for (Index t = heads.oneFace; t != kNone; t = lists.next[t].oneFace) {
      if (!matcher.hasRoom(1)) return false;
      const Tet& tet = topology.tets[t];
      const auto& corners = kAscendingCorners[topology.order[t]];
      matcher.add(tet[corners[2]], tet[corners[3]], 4 * t + kRankedFaces[topology.order[t]][0]);
    }
  }
  sound = sound && matcher.isSound();
  return true;
}

}  // namespace

bool matchFaces(TetTopology& topology, Stage& stage) {
  const FaceLists lists = listFaces(topology, stage);
  topology.mate.resize(4 * topology.tetCount());
  topology.vertexTet.resize(topology.pointCount);
  std::atomic<bool> sound = true;
  parallelBlocks(stage, topology.pointCount, kVertexGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   FaceTable table;
                   bool isSound = true;
                   for (std::size_t i = begin; i < end; ++i) {
                     const auto v = static_cast<Index>(i);
                     topology.vertexTet[v] = lists.smallestTet(v);
                     int bits = FaceTable::kBits;
                     while (!matchFacesAt(v, lists, topology, table, bits, isSound)) bits += 2;
                   }
                   if (!isSound) sound = false;
                 });
  return sound;
}

}  // namespace hexhex::adjacency
