#include <algorithm>
#include <array>
#include <atomic>
#include <type_traits>
#include <utility>
#include <vector>

#include <adjacency/tet_topology.hpp>

namespace hexhex {

namespace {

/// Vertices whose faces are matched in one go; small meshes must still have work for all threads.
constexpr std::size_t kVertexGrain = 256;

/// Tets are divided into at most as many parts: each part costs three numbers per vertex.
constexpr std::size_t kMaxParts = 8;

/// A half-face as the hash table keeps it: its number in the lower half. In the upper half, bit 0
/// if its corners, in the order of kFaceCorners, ascend but for a rotation, and bit 1 if they
/// descend; both if it has been matched. So two that share a bit must not be matched.
using OpenFace = std::uint64_t;
constexpr OpenFace kAscends = std::uint64_t{1} << 32;
constexpr OpenFace kDescends = std::uint64_t{2} << 32;
/// Matched, or none yet.
constexpr OpenFace kMatched = kAscends | kDescends;
constexpr OpenFace kNoFace = kNone;

/// The corners and faces of a tet, in ascending order of vertices.
struct RankedTet {
  std::array<std::uint8_t, 4> corners{};  ///< by rank
  /// By rank of the opposite corner: number within the tet, and whether it ascends or descends.
  std::array<OpenFace, 4> faces{};
};

constexpr RankedTet rankedTet(const Tet& tet) {
  RankedTet ranked;
  for (std::size_t corner = 0; corner < 4; ++corner) {
    std::size_t rank = 0;
    for (const Index other : tet) rank += other < tet[corner] ? 1 : 0;
    ranked.corners[rank] = static_cast<std::uint8_t>(corner);
    const std::array<int, 3>& face = kFaceCorners[corner];
    int descents = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Index here = tet[static_cast<std::size_t>(face[k])];
      const Index next = tet[static_cast<std::size_t>(face[(k + 1) % 3])];
      descents += next < here ? 1 : 0;
    }
    ranked.faces[rank] = corner | (descents == 1 ? kAscends : kDescends);
  }
  return ranked;
}

constexpr std::array<RankedTet, kCornerOrders> kRankedTets = byCornerOrder<RankedTet>(rankedTet);

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
    const RankedTet& ranked = kRankedTets[order];
    topology.order[index] = order;
    lists.next[index] = {std::exchange(heads[tet[ranked.corners[0]]].threeFaces, index),
                         std::exchange(heads[tet[ranked.corners[1]]].oneFace, index)};
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

/// What a hash table has found at a vertex: a triangle's other two vertices, the smaller one in the
/// upper half, and its half-face.
struct FoundFace {
  std::uint64_t vertices = 0;
  OpenFace face = kNoFace;
};

/// Memory of a hash table for the half-faces at nearly every vertex, which is cleared in no time.
struct SmallTable {
  static constexpr int kBits = 8;
  std::array<std::uint8_t, 1 << kBits> slots;
  std::array<FoundFace, (1 << kBits) / 4 * 3> found;

  [[nodiscard]] static constexpr int bits() { return kBits; }
};

/// The same for any number.
struct LargeTable {
  explicit LargeTable(int bits)
      : bits_(bits), slots(std::size_t{1} << bits), found((std::size_t{1} << bits) / 4 * 3) {}
  [[nodiscard]] int bits() const { return bits_; }

  int bits_;
  std::vector<std::uint32_t> slots;
  std::vector<FoundFace> found;
};

/// Matches the half-faces at one vertex, by a hash table. Whether a triangle is found for the first
/// or the second time cannot be predicted, so both go the same path
/// (key_table.hpp has the figure).
template <class Table>
class FaceMatcher {
 public:
  FaceMatcher(Table& table, HalfFace* mate) : table_(table), mate_(mate) {
    std::fill(table.slots.begin(), table.slots.end(), 0);
    table.found[0].face = kNoFace;
  }

  /// Whether so many can be added.
  [[nodiscard]] bool hasRoom(std::size_t more) const { return count_ + more < table_.found.size(); }

  /// @param low,high  the other two vertices, low < high
  void add(Index low, Index high, OpenFace face) {
    const std::uint64_t key = (std::uint64_t{low} << 32) | high;
    auto& slot = slotOf(key);
    const std::uint64_t isKnown = slot == 0 ? 0 : ~std::uint64_t{0};
    const OpenFace other = table_.found[slot].face;
    slot = static_cast<std::remove_reference_t<decltype(slot)>>(++count_);
    table_.found[count_] = {key, face | (kMatched & isKnown)};
    shared_ |= face & other;
    const auto here = static_cast<HalfFace>(face);
    const auto there = static_cast<HalfFace>(other);
    mate_[here ^ ((here ^ there) & static_cast<HalfFace>(isKnown))] = here;
    mate_[here] = there;
  }

  /// Whether no triangle was there more than twice, or twice in the same orientation.
  [[nodiscard]] bool isSound() const { return (shared_ & kMatched) == 0; }

 private:
  /// The slot with the number of the last half-face of a triangle; 0 if there was none so far.
  [[nodiscard]] auto& slotOf(std::uint64_t key) {
    table_.found[0].vertices = key;  // ends the search at an empty slot
    // Odd, and near 2^64 / golden ratio: the upper bits of products with it spread well.
    std::size_t i = (key * 0x9e3779b97f4a7c15U) >> (64 - table_.bits());
    while (table_.found[table_.slots[i]].vertices != key) {
      i = (i + 1) & (table_.slots.size() - 1);
    }
    return table_.slots[i];
  }

  Table& table_;
  HalfFace* mate_;
  std::size_t count_ = 0;
  OpenFace shared_ = 0;
};

/// Matches the half-faces whose smallest vertex is the same.
/// @return false if they do not fit the table
template <class Table>
bool matchFacesAt(Index v, const FaceLists& lists, Table& table, TetTopology& topology,
                  bool& sound) {
  FaceMatcher<Table> matcher(table, topology.mate.data());
  for (std::size_t part = 0; part < lists.parts; ++part) {
    const FaceLists::Heads& heads = lists.at(part, v);
    for (Index t = heads.threeFaces; t != kNone; t = lists.next[t].threeFaces) {
      if (!matcher.hasRoom(3)) return false;
      const Tet& tet = topology.tets[t];
      const RankedTet& ranked = kRankedTets[topology.order[t]];
      const Index a = tet[ranked.corners[1]];
      const Index b = tet[ranked.corners[2]];
      const Index c = tet[ranked.corners[3]];
      matcher.add(b, c, 4 * t + ranked.faces[1]);
      matcher.add(a, c, 4 * t + ranked.faces[2]);
      matcher.add(a, b, 4 * t + ranked.faces[3]);
    }
    for (Index t = heads.oneFace; t != kNone; t = lists.next[t].oneFace) {
      if (!matcher.hasRoom(1)) return false;
      const Tet& tet = topology.tets[t];
      const RankedTet& ranked = kRankedTets[topology.order[t]];
      matcher.add(tet[ranked.corners[2]], tet[ranked.corners[3]], 4 * t + ranked.faces[0]);
    }
  }
  sound = sound && matcher.isSound();
  return true;
}

/// The same with a table that is large enough.
void matchManyFacesAt(Index v, const FaceLists& lists, TetTopology& topology, bool& sound) {
  for (int bits = SmallTable::kBits + 2;; bits += 2) {
    LargeTable table(bits);
    if (matchFacesAt(v, lists, table, topology, sound)) return;
  }
}

}  // namespace

bool matchFaces(TetTopology& topology, Stage& stage) {
  const FaceLists lists = listFaces(topology, stage);
  topology.mate.resize(4 * topology.tetCount());
  topology.vertexTet.resize(topology.pointCount);
  std::atomic<bool> sound = true;
  parallelBlocks(stage, topology.pointCount, kVertexGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   SmallTable table;  // NOLINT: written before it is read
                   bool isSound = true;
                   for (std::size_t i = begin; i < end; ++i) {
                     const auto v = static_cast<Index>(i);
                     topology.vertexTet[v] = lists.smallestTet(v);
                     if (!matchFacesAt(v, lists, table, topology, isSound)) {
                       matchManyFacesAt(v, lists, topology, isSound);
                     }
                   }
                   if (!isSound) sound = false;
                 });
  return sound;
}

}  // namespace hexhex
