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
};

/// Enters tets [begin, end) into the lists of one part.
void listFaces(FaceLists& lists, std::span<const Tet> tets, std::size_t part, std::size_t begin,
               std::size_t end) {
  FaceLists::Heads* const heads = &lists.heads[part * lists.vertices];
  std::fill_n(heads, lists.vertices, FaceLists::Heads());
  // Backwards, so that the last tet to write is the smallest.
  for (std::size_t t = end; t > begin; --t) {
    const Tet& tet = tets[t - 1];
    const auto index = static_cast<Index>(t - 1);
    for (const Index v : tet) heads[v].smallest = index;
    const Index low01 = smaller(tet[0], tet[1]);
    const Index low23 = smaller(tet[2], tet[3]);
    const Index high01 = larger(tet[0], tet[1]);
    const Index high23 = larger(tet[2], tet[3]);
    const Index first = smaller(low01, low23);
    const Index second = smaller(larger(low01, low23), smaller(high01, high23));
    lists.next[index] = {std::exchange(heads[first].threeFaces, index),
                         std::exchange(heads[second].oneFace, index)};
  }
}

FaceLists listFaces(TetTopology& topology, Stage& stage) {
  FaceLists lists;
  lists.parts = std::min(kMaxParts, static_cast<std::size_t>(currentThreads()));
  lists.vertices = topology.pointCount;
  lists.heads.resize(lists.parts * lists.vertices);
  lists.next.resize(topology.tetCount());
  const std::size_t tets = topology.tetCount();
  parallelFor(stage, lists.parts, 1, [&](std::size_t part) {
    listFaces(lists, topology.tets, part, tets * part / lists.parts,
              tets * (part + 1) / lists.parts);
  });
  return lists;
}

/// The other corners of a tet, in the order in which kFaceCorners has the last two of them after
/// this one, in the face opposite the first.
constexpr std::array<std::array<std::uint8_t, 3>, 4> kTurns = [] {
  std::array<std::array<std::uint8_t, 3>, 4> turns{};
  for (std::size_t corner = 0; corner < 4; ++corner) {
    const std::size_t face = corner == 0 ? 1 : 0;
    for (std::size_t k = 0; k < 3; ++k) {
      if (kFaceCorners[face][k] != static_cast<int>(corner)) continue;
      turns[corner] = {static_cast<std::uint8_t>(face),
                       static_cast<std::uint8_t>(kFaceCorners[face][(k + 1) % 3]),
                       static_cast<std::uint8_t>(kFaceCorners[face][(k + 2) % 3])};
    }
  }
  return turns;
}();

/// By corner and face: the other two corners of the face, in the order of kFaceCorners.
constexpr std::array<std::array<std::array<std::uint8_t, 2>, 4>, 4> kTurnsInFace = [] {
  std::array<std::array<std::array<std::uint8_t, 2>, 4>, 4> turns{};
  for (std::size_t corner = 0; corner < 4; ++corner) {
    for (std::size_t k = 0; k < 3; ++k) {
      turns[corner][kTurns[corner][k]] = {kTurns[corner][(k + 1) % 3], kTurns[corner][(k + 2) % 3]};
    }
  }
  return turns;
}();

/// A half-face at a vertex.
struct Entry {
  std::uint64_t key;  ///< the triangle's other two vertices, the smaller one in the upper half
  HalfFace halfFace;
  std::uint32_t turned;  ///< 1 if the larger one comes first in kFaceCorners

  Entry(Index a, Index b, HalfFace h)
      : key((std::uint64_t{smaller(a, b)} << 32) | larger(a, b)),
        halfFace(h),
        turned(a > b ? 1 : 0) {}
  Entry() = default;
};

/// Collects the half-faces whose smallest vertex is the same.
class EntryList {
 public:
  EntryList(const TetTopology& topology, const FaceLists& lists)
      : topology_(topology), lists_(lists) {}

  std::span<const Entry> collect(Index v) {
    const Tet* const tets = topology_.tets.data();
    const FaceLists::Next* const next = lists_.next.data();
    std::size_t count = 0;
    for (std::size_t part = 0; part < lists_.parts; ++part) {
      const FaceLists::Heads& heads = lists_.at(part, v);
      for (Index t = heads.threeFaces; t != kNone; t = next[t].threeFaces) {
        const Tet& tet = tets[t];
        const std::array<std::uint8_t, 3>& turn = kTurns[localCorner(tet, v)];
        const std::array<Index, 3> others = {tet[turn[0]], tet[turn[1]], tet[turn[2]]};
        Entry* const added = roomFor(count, 3);
        added[0] = Entry(others[1], others[2], 4 * t + turn[0]);
        added[1] = Entry(others[2], others[0], 4 * t + turn[1]);
        added[2] = Entry(others[0], others[1], 4 * t + turn[2]);
        count += 3;
      }
      for (Index t = heads.oneFace; t != kNone; t = next[t].oneFace) {
        const Tet& tet = tets[t];
        // The face opposite the one vertex that is smaller.
        const Index isLast = tet[3] < v ? 1 : 0;
        const Index low = (tet[1] < v ? 1U : 0U) | isLast;
        const Index high = (tet[2] < v ? 1U : 0U) | isLast;
        const Index face = low | (high << 1);
        const std::array<std::uint8_t, 2>& turn = kTurnsInFace[localCorner(tet, v)][face];
        *roomFor(count, 1) = Entry(tet[turn[0]], tet[turn[1]], 4 * t + face);
        ++count;
      }
    }
    return {entries_.data(), count};
  }

 private:
  /// Behind the first `count` entries, for so many more.
  Entry* roomFor(std::size_t count, std::size_t more) {
    if (entries_.size() < count + more) entries_.resize(2 * (count + more));
    return &entries_[count];
  }

  const TetTopology& topology_;
  const FaceLists& lists_;
  std::vector<Entry> entries_ = std::vector<Entry>(256);
};

/// Matches the half-faces at one vertex after the other by a hash table. Whether a triangle is
/// found for the first or the second time is as good as random, so that all is done alike for both.
class FaceMatcher {
 public:
  explicit FaceMatcher(HalfFace* mate) : mate_(mate) {}

  /// False if a triangle is there more than twice, or twice in the same orientation.
  [[nodiscard]] bool run(std::span<const Entry> entries) {
    makeRoom(entries.size());
    const Table table{slots_.data(), slots_.size() - 1, shift_, ++group_ << 1};
    HalfFace* const mate = mate_;
    std::uint32_t faults = 0;
    for (const Entry& entry : entries) {
      Slot& slot = *table.find(entry.key);
      const std::uint32_t tag = table.tag | entry.turned;
      const std::uint32_t difference = slot.tag ^ tag;
      const std::uint32_t isKnown = difference < 2 ? 1 : 0;
      const std::uint32_t isPair = isKnown & difference & (slot.halfFace != kNone ? 1U : 0U);
      const HalfFace pairMask = 0 - isPair;
      const HalfFace other = entry.halfFace ^ ((entry.halfFace ^ slot.halfFace) & pairMask);
      mate[other] = entry.halfFace | ~pairMask;
      mate[entry.halfFace] = other | ~pairMask;
      slot = {entry.key, tag, entry.halfFace | (0 - isKnown)};
      faults |= isKnown ^ isPair;
    }
    return faults == 0;
  }

 private:
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t tag = 0;      ///< a number per vertex, and Entry::turned
    HalfFace halfFace = kNone;  ///< kNone after both were found
  };

  /// What a loop should keep in registers.
  struct Table {
    Slot* slots;
    std::size_t last;
    int shift;
    std::uint32_t tag;

    /// The slot of a key, or the one that it would get.
    [[nodiscard]] Slot* find(std::uint64_t key) const {
      // Odd, and near 2^64 / golden ratio: the upper bits of products with it spread well.
      std::size_t i = (key * 0x9e3779b97f4a7c15U) >> shift;
      while (isTakenByOther(slots[i], key)) i = (i + 1) & last;
      return &slots[i];
    }
    /// By arithmetic, as of two conditions each would make a branch.
    [[nodiscard]] bool isTakenByOther(const Slot& slot, std::uint64_t key) const {
      const std::uint64_t otherKey = slot.key ^ key;
      const std::uint64_t otherVertex = (slot.tag ^ tag) >> 1;
      // The highest bit is set if the former is not zero and the latter is.
      return static_cast<std::int64_t>((otherKey | (0 - otherKey)) & (otherVertex - 1)) < 0;
    }
  };

  /// Keeps the table, in which each number of a vertex is used once, at most half full.
  void makeRoom(std::size_t count) {
    const bool isUsedUp = group_ == kLastGroup;
    if (slots_.size() >= 2 * count && !isUsedUp) return;
    while (slots_.size() < 2 * count) {
      slots_.resize(2 * slots_.size());
      --shift_;
    }
    std::fill(slots_.begin(), slots_.end(), Slot{});
    group_ = 0;
  }

  static constexpr int kInitialShift = 55;
  static constexpr std::uint32_t kLastGroup = 0x7fffffff;

  HalfFace* mate_;
  std::vector<Slot> slots_ = std::vector<Slot>(std::size_t{1} << (64 - kInitialShift));
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
                   EntryList entries(topology, lists);
                   FaceMatcher matcher(topology.mate.data());
                   for (std::size_t i = begin; i < end; ++i) {
                     const auto v = static_cast<Index>(i);
                     Index smallest = kNone;
                     for (std::size_t part = 0; part < lists.parts; ++part) {
                       smallest = std::min(smallest, lists.at(part, v).smallest);
                     }
                     topology.vertexTet[v] = smallest;
                     if (!matcher.run(entries.collect(v))) sound = false;
                   }
                 });
  return sound;
}

}  // namespace hexhex
