#include <atomic>

#include <base/branchless.hpp>
#include <map/face_matching.hpp>

namespace hexhex {

namespace {

/// Vertices whose faces are matched in one go; small meshes must still have work for all threads.
constexpr std::size_t kVertexGrain = 256;

/// Tets are divided into at most as many parts: each part costs two numbers per vertex.
constexpr std::size_t kMaxParts = 8;

// As values, so that no branch is to be foretold: which one is smaller is as good as random.
constexpr Index smaller(Index a, Index b) { return a < b ? a : b; }
constexpr Index larger(Index a, Index b) { return a < b ? b : a; }

/// Each triangle is found at its smallest vertex. In a tet, that is the tet's smallest vertex for
/// three faces and the second smallest for the fourth: so each tet has two entries, 2 * tet and
/// 2 * tet + 1, in linked lists that start at these vertices. Each thread has lists of its own.
struct FaceLists {
  std::size_t parts = 1;
  std::size_t vertices = 0;
  Array<Index> head;      ///< per part and vertex: an entry, or kNone
  Array<Index> next;      ///< per entry
  Array<Index> smallest;  ///< per part and vertex: the smallest tet, or kNone
};

/// Enters tets [begin, end) into the lists of one part.
void listFaces(FaceLists& lists, std::span<const Tet> tets, std::size_t part, std::size_t begin,
               std::size_t end) {
  Index* const head = &lists.head[part * lists.vertices];
  Index* const smallest = &lists.smallest[part * lists.vertices];
  std::fill_n(head, lists.vertices, kNone);
  std::fill_n(smallest, lists.vertices, kNone);
  // Backwards, so that the last tet to write is the smallest.
  for (std::size_t t = end; t > begin; --t) {
    const Tet& tet = tets[t - 1];
    const auto index = static_cast<Index>(t - 1);
    for (const Index v : tet) smallest[v] = index;
    const Index low01 = smaller(tet[0], tet[1]);
    const Index low23 = smaller(tet[2], tet[3]);
    const Index high01 = larger(tet[0], tet[1]);
    const Index high23 = larger(tet[2], tet[3]);
    const Index first = smaller(low01, low23);
    const Index second = smaller(larger(low01, low23), smaller(high01, high23));
    lists.next[2 * index] = std::exchange(head[first], 2 * index);
    lists.next[2 * index + 1] = std::exchange(head[second], 2 * index + 1);
  }
}

FaceLists listFaces(TetTopology& topology, Stage& stage) {
  FaceLists lists;
  lists.parts = std::min(kMaxParts, static_cast<std::size_t>(currentThreads()));
  lists.vertices = topology.pointCount;
  lists.head.resize(lists.parts * lists.vertices);
  lists.smallest.resize(lists.parts * lists.vertices);
  lists.next.resize(2 * topology.tetCount());
  const std::size_t tets = topology.tetCount();
  parallelFor(stage, lists.parts, 1, [&](std::size_t part) {
    listFaces(lists, topology.tets, part, tets * part / lists.parts,
              tets * (part + 1) / lists.parts);
  });
  return lists;
}

/// How face f of a tet goes on from its corner i, in the order of kFaceCorners.
struct FaceTurn {
  std::uint8_t second = 0;
  std::uint8_t third = 0;
};

constexpr std::array<std::array<FaceTurn, 4>, 4> makeFaceTurns() {
  std::array<std::array<FaceTurn, 4>, 4> turns{};
  for (std::size_t f = 0; f < 4; ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      turns[static_cast<std::size_t>(kFaceCorners[f][k])][f] = {
          static_cast<std::uint8_t>(kFaceCorners[f][(k + 1) % 3]),
          static_cast<std::uint8_t>(kFaceCorners[f][(k + 2) % 3])};
    }
  }
  return turns;
}

constexpr std::array<std::array<FaceTurn, 4>, 4> kFaceTurns = makeFaceTurns();

/// The three faces at a corner.
constexpr std::array<std::array<std::uint8_t, 3>, 4> kFacesAt = {
    {{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}}};

/// Matches the half-faces whose smallest vertex is the same: a hash table of the triangles there.
class FaceMatcher {
 public:
  FaceMatcher(TetTopology& topology, const FaceLists& lists)
      : topology_(topology), lists_(lists), slots_(std::size_t{1} << (64 - kInitialShift)) {}

  /// False if something is wrong with a triangle of this vertex.
  bool run(Index v) {
    for (;;) {
      Pass pass{topology_.tets.data(), topology_.mate.data(), slots_.data(), shift_, ++group_};
      if (tryRun(v, pass)) return pass.sound;
      slots_.assign(2 * slots_.size(), Slot{});
      --shift_;
      group_ = 0;
    }
  }

 private:
  static constexpr int kInitialShift = 55;  ///< 2^(64 - 55) slots

  struct Slot {
    std::uint64_t key = 0;      ///< the other two vertices, the smaller one in the upper half
    std::uint32_t group = 0;    ///< the slot is empty for all vertices but one
    HalfFace halfFace = kNone;  ///< kNone after both were found
    bool turned = false;        ///< which of the two comes first in kFaceCorners
  };

  /// One vertex: what a loop should keep in registers.
  struct Pass {
    const Tet* tets;
    HalfFace* mate;
    Slot* slots;
    int shift;
    std::uint32_t group;
    std::size_t used = 0;
    bool sound = true;

    void match(const Tet& tet, Index t, std::size_t corner, std::size_t face) {
      const FaceTurn turn = kFaceTurns[corner][face];
      const Index a = tet[turn.second];
      const Index b = tet[turn.third];
      const bool turned = a > b;
      const std::uint64_t key = (std::uint64_t{smaller(a, b)} << 32) | larger(a, b);
      const HalfFace halfFace = 4 * t + static_cast<HalfFace>(face);
      Slot& slot = *find(key);
      // Half of them are the first ones of their triangles, and nobody could foretell which.
      const bool isFirst = slot.group != group;
      if (isFirst) {
        slot = {key, group, halfFace, turned};
        mate[halfFace] = kNone;
        ++used;
        return;
      }
      const bool fits = allOf(slot.halfFace != kNone, slot.turned != turned);
      sound = allOf(sound, fits);
      const HalfFace other = fits ? slot.halfFace : halfFace;
      mate[other] = halfFace;
      mate[halfFace] = fits ? other : kNone;
      slot.halfFace = kNone;
    }

    /// The slot of a key, or the one that it would get.
    [[nodiscard]] Slot* find(std::uint64_t key) const {
      const std::size_t last = (std::size_t{1} << (64 - shift)) - 1;
      // The upper bits of a product with an odd constant near 2^64 / golden ratio spread well.
      std::size_t i = (key * 0x9e3779b97f4a7c15U) >> shift;
      // While the slot is taken by another key; without a branch on whether it is taken.
      while (slots[i].group == group && slots[i].key != key) i = (i + 1) & last;
      return &slots[i];
    }
  };

  /// False if the table is too small.
  bool tryRun(Index v, Pass& pass) {
    const std::size_t limit = slots_.size() / 2;
    for (std::size_t part = 0; part < lists_.parts; ++part) {
      Index entry = lists_.head[part * lists_.vertices + v];
      for (; entry != kNone; entry = lists_.next[entry]) {
        const Index t = entry / 2;
        const Tet& tet = pass.tets[t];
        const auto corner = static_cast<std::size_t>(topology_.localCorner(t, v));
        if (entry % 2 == 0) {
          for (const std::uint8_t face : kFacesAt[corner]) pass.match(tet, t, corner, face);
        } else {
          // The face opposite the one vertex that is smaller.
          const std::size_t face =
              (tet[1] < v ? 1U : 0U) + (tet[2] < v ? 2U : 0U) + (tet[3] < v ? 3U : 0U);
          pass.match(tet, t, corner, face);
        }
        if (pass.used > limit) return false;
      }
    }
    return true;
  }

  TetTopology& topology_;
  const FaceLists& lists_;
  std::vector<Slot> slots_;
  int shift_ = kInitialShift;
  std::uint32_t group_ = 0;
};

}  // namespace

bool matchFaces(TetTopology& topology, Stage& stage) {
  const FaceLists lists = listFaces(topology, stage);
  topology.mate.resize(4 * topology.tetCount());
  topology.vertexTet.resize(topology.pointCount);
  std::atomic<bool> sound = true;
  parallelBlocks(stage, topology.pointCount, kVertexGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   FaceMatcher matcher(topology, lists);
                   for (std::size_t v = begin; v < end; ++v) {
                     Index smallest = kNone;
                     for (std::size_t part = lists.parts; part > 0; --part) {
                       smallest =
                           std::min(smallest, lists.smallest[(part - 1) * lists.vertices + v]);
                     }
                     topology.vertexTet[v] = smallest;
                     if (!matcher.run(static_cast<Index>(v))) sound = false;
                   }
                 });
  return sound;
}

}  // namespace hexhex
