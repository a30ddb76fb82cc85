// Edges and faces of hexahedra that are joined as usual, found in few steps that hardly branch.
//
// A vertex has three edges to larger vertices on average, which its row lists. A face is a pair of
// edges of its smallest vertex: a bit of 28, if a row has eight places. So a vertex knows its faces
// by a word, and the number of a face is that of the first face of the vertex plus the number of
// bits below its own. Threads set bits in any order; the result is the same.
//
// Most neighbours number their corners alike and find each other at once (aligned_cells.hpp). Of
// what they share, only one of them tells: a cell leaves its faces away from corner 0, and the
// edges of them, to the neighbours behind these faces. So most cells tell of three edges and three
// faces instead of twelve and six.
#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <limits>
#include <utility>

#include <base/parallel.hpp>
#include <base/prefetch.hpp>
#include <io/ovm_cells.hpp>
#include <io/ovm_hex_topology.hpp>
#include <io/ovm_topology.hpp>
#include <mesh/aligned_cells.hpp>

namespace hexhex {
namespace {

constexpr std::size_t kGrain = 2048;

constexpr std::size_t kPlaces = 8;
/// Larger vertices that edges lead to, in ascending order. Signed, since processors compare such
/// numbers at once.
using Row = std::array<std::int32_t, kPlaces>;
constexpr std::int32_t kFree = std::numeric_limits<std::int32_t>::max();

/// The same while threads fill it: two places in each word, so that a look takes few steps.
using Words = std::array<std::uint64_t, kPlaces / 2>;
constexpr std::uint64_t kBothPlaces = 0x0000000100000001U;
constexpr std::uint64_t kFreeWord = kFree * kBothPlaces;

/// Puts a vertex into a row unless it is there. Places are filled in order, each only once, so
/// that threads with the same vertex meet.
/// @param alone  no other thread is at work, so that nothing has to be exchanged at once, which
///               takes a processor much longer
/// @return false if there is no place
bool insert(Words& words, std::uint64_t vertex, bool alone) {
  constexpr std::uint64_t kSigns = 0x80000000U * kBothPlaces;
  for (std::uint64_t& places : words) {
    const std::atomic_ref word(places);
    std::uint64_t before = word.load(std::memory_order_relaxed);
    for (;;) {
      // No number has a sign, so that one appears where 1 is taken from a place that is equal.
      const std::uint64_t equal = (before ^ (vertex * kBothPlaces)) - kBothPlaces;
      if ((equal & kSigns) != 0) return true;
      if (before >> 32U != kFree) break;
      const unsigned shift = (before & kFree) == kFree ? 0 : 32;
      const std::uint64_t after = before ^ ((kFree ^ vertex) << shift);
      if (alone) {
        word.store(after, std::memory_order_relaxed);
        return true;
      }
      if (word.compare_exchange_weak(before, after, std::memory_order_relaxed)) return true;
    }
  }
  return false;
}

/// A row that is filled.
Row sorted(const Words& words) {
  Row row;
  for (std::size_t i = 0; i < kPlaces; ++i) {
    row[i] = static_cast<std::int32_t>(words[i / 2] >> (32 * (i % 2)) & kFree);
  }
  // Few places are taken, so that this is quick: most rows have no more than four.
  const auto order = [&row](std::size_t i, std::size_t k) {
    const std::int32_t a = row[i];
    const std::int32_t b = row[k];
    row[i] = std::min(a, b);
    row[k] = std::max(a, b);
  };
  order(0, 1);
  order(2, 3);
  order(0, 2);
  order(1, 3);
  order(1, 2);
  for (std::size_t i = 4; i < kPlaces && row[i] != kFree; ++i) {
    for (std::size_t k = i; k > 0 && row[k] < row[k - 1]; --k) std::swap(row[k], row[k - 1]);
  }
  return row;
}

/// Two places of a row, the first one smaller.
struct PlacePair {
  std::uint8_t first = 0;
  std::uint8_t second = 0;
};
constexpr std::size_t kPairs = kPlaces * (kPlaces - 1) / 2;

constexpr std::array<PlacePair, kPairs> makePairs() {
  std::array<PlacePair, kPairs> pairs;
  std::size_t next = 0;
  for (std::uint8_t i = 0; i < kPlaces; ++i) {
    for (std::uint8_t j = i + 1; j < kPlaces; ++j) pairs[next++] = {i, j};
  }
  return pairs;
}
constexpr std::array<PlacePair, kPairs> kPairOf = makePairs();

/// The number of a pair, with its places in either order.
constexpr std::array<std::uint8_t, kPlaces * kPlaces> makePairNumbers() {
  std::array<std::uint8_t, kPlaces * kPlaces> numbers{};
  for (std::uint8_t pair = 0; pair < kPairs; ++pair) {
    const PlacePair& p = kPairOf[pair];
    numbers[p.first * kPlaces + p.second] = numbers[p.second * kPlaces + p.first] = pair;
  }
  return numbers;
}
constexpr std::array<std::uint8_t, kPlaces* kPlaces> kPairNumbers = makePairNumbers();

// How a side names its face: the pair, whether it passes the second edge's vertex first, and which
// of its corners is the smallest one.
constexpr std::uint8_t kPairMask = 31;
constexpr std::uint8_t kBackwards = 32;
constexpr unsigned kBeginShift = 6;
/// The name of a side that is left to the neighbour; no pair has this number.
constexpr std::uint8_t kOfNeighbour = kPairMask;

/// By axis: the slots of the faces at corner 0 and of those across from them.
constexpr std::array<std::size_t, 3> kNearSlots = {5, 2, 0};
constexpr std::array<std::size_t, 3> kFarSlots = {4, 3, 1};

/// An edge of a cell, by corners, and the axes whose neighbours have it, too, and tell of it.
struct SharedEdge {
  std::uint8_t from;
  std::uint8_t to;
  std::uint8_t axes;  ///< bit k for axis k
};
constexpr std::array<SharedEdge, 9> kSharedEdges = {{{1, 2, 1},
                                                     {1, 5, 1},
                                                     {3, 2, 2},
                                                     {3, 7, 2},
                                                     {4, 5, 4},
                                                     {4, 7, 4},
                                                     {2, 6, 1 | 2},
                                                     {5, 6, 1 | 4},
                                                     {7, 6, 2 | 4}}};

// What is known of a half-face: that a side has it, and where the corners of the side's cell begin
// in the face if it is the cell's first side.
constexpr std::uint8_t kTaken = 4;
constexpr std::uint8_t kFirstSide = 8;
constexpr std::uint8_t kBeginMask = 3;

/// std::popcount() without a processor's instruction for it would be a call.
unsigned countBits(std::uint32_t bits) {
  bits -= (bits >> 1U) & 0x55555555U;
  bits = (bits & 0x33333333U) + ((bits >> 2U) & 0x33333333U);
  return ((bits + (bits >> 4U)) & 0x0f0f0f0fU) * 0x01010101U >> 24U;
}

/// A corner of a side.
Index cornerOf(const Hex& cell, std::size_t slot, std::size_t i) {
  return cell[kOvmHexFaces[slot][i % 4]];
}

/// Where the smallest corner of a side stands in its loop.
template <std::size_t slot>
std::size_t beginOf(const Hex& cell) {
  constexpr std::array<std::uint8_t, 4> kCorners = kOvmHexFaces[slot];
  const Index a = cell[kCorners[0]];
  const Index b = cell[kCorners[1]];
  const Index c = cell[kCorners[2]];
  const Index d = cell[kCorners[3]];
  return std::min(c, d) < std::min(a, b) ? (d < c ? 3 : 2) : (b < a ? 1 : 0);
}

/// The places of two vertices that a row has: how many entries are smaller.
std::array<unsigned, 2> placesIn(const Row& row, Index one, Index other) {
  const auto a = static_cast<std::int32_t>(one);
  const auto b = static_cast<std::int32_t>(other);
  std::int32_t smaller = 0;
  for (const std::int32_t end : row) smaller += (end < a ? 1 : 0) + (end < b ? 16 : 0);
  return {static_cast<unsigned>(smaller) % 16, static_cast<unsigned>(smaller) / 16};
}
unsigned placeIn(const Row& row, Index vertex) {
  const auto wanted = static_cast<std::int32_t>(vertex);
  std::int32_t smaller = 0;
  for (const std::int32_t end : row) smaller += end < wanted ? 1 : 0;
  return static_cast<unsigned>(smaller);
}

/// What a vertex knows of its edges to larger vertices and of the faces whose smallest vertex it
/// is. Together, as they are asked for together, and vertices may be far from each other in memory.
struct Star {
  Words words;          ///< at last, a row as it is in memory
  std::uint32_t faces;  ///< a bit for each pair that is a face
  Index firstEdge;
  Index firstFace;
};

class HexTopologyBuilder {
 public:
  HexTopologyBuilder(std::size_t vertexCount, std::span<const Hex> cells, Stage& stage)
      : cells_(cells), stage_(stage) {
    topology_.vertexCount = vertexCount;
  }

  std::optional<OvmTopology> build() {
    findNeighbours();
    if (!collectEdges()) return std::nullopt;
    if (!numberEdges()) return std::nullopt;
    collectFaces();
    if (!numberFaces()) return std::nullopt;
    nameSides();
    if (!copySides() || !allTaken()) return std::nullopt;
    linkFacesToEdges();
    return std::move(topology_);
  }

 private:
  void findNeighbours();
  bool collectEdges();
  bool addEdges(std::size_t c);
  [[nodiscard]] static Row rowOf(const Star& star) { return std::bit_cast<Row>(star.words); }
  bool numberEdges();
  void collectFaces();
  template <std::size_t slot>
  void nameFace(std::size_t c);
  bool numberFaces();
  void nameSides();
  Index nameSide(std::size_t c, std::size_t slot);
  bool copySides();
  Index copySide(std::size_t c, std::size_t slot);
  [[nodiscard]] bool allTaken() const;
  void take(Index halfFace, std::uint8_t what) {
    std::atomic_ref(halfFaces_[halfFace]).store(what, std::memory_order_relaxed);
  }
  [[nodiscard]] Index halfEdge(Index from, Index to) const;
  void linkFacesToEdges();
  void fetchNeighbours(std::size_t vertex) const;
  void linkFaces(const Star& star);

  std::span<const Hex> cells_;
  Stage& stage_;
  OvmTopology topology_;
  const bool alone_ = currentThreads() == 1;
  Array<Star> stars_;              ///< per vertex
  Array<std::uint8_t> sides_;      ///< per side: its face among those of its smallest vertex
  Array<std::uint8_t> shared_;     ///< per cell: bit k if it has a neighbour behind along axis k
  Array<Index> opposites_;         ///< per face: the vertex opposite the smallest one
  Array<std::uint8_t> halfFaces_;  ///< per half-face: what is known of it
};

/// Until sides have numbers, the places of those that are left to neighbours hold the neighbours.
void HexTopologyBuilder::findNeighbours() {
  const AlignedCells aligned(topology_.vertexCount, cells_, stage_);
  topology_.cells.length = 6;
  topology_.cells.handles.resize(6 * cells_.size());
  shared_.resize(cells_.size());
  const auto note = [shared = shared_.data(), handles = topology_.cells.handles.data()](
                        std::size_t c, const std::array<Index, 3>& behind) {
    unsigned bits = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      handles[6 * c + kFarSlots[axis]] = behind[axis];
      bits |= behind[axis] != kNone ? 1U << axis : 0U;
    }
    shared[c] = static_cast<std::uint8_t>(bits);
  };
  parallelBlocks(stage_, cells_.size(), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   aligned.forEach(begin, end, note);
                 });
}

bool HexTopologyBuilder::collectEdges() {
  stars_.resize(topology_.vertexCount);
  parallelFor(stage_, stars_.size(), kGrain, [stars = stars_.data()](std::size_t v) {
    stars[v].words.fill(kFreeWord);
    stars[v].faces = 0;
  });
  std::atomic<bool> fits{true};
  parallelBlocks(stage_, cells_.size(), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   bool good = true;
                   for (std::size_t c = begin; c < end; ++c) good = addEdges(c) && good;
                   if (!good) fits.store(false, std::memory_order_relaxed);
                 });
  return fits;
}

/// @return false if there is no place for an edge, or the cell has a vertex twice
bool HexTopologyBuilder::addEdges(std::size_t c) {
  const Hex& cell = cells_[c];
  bool good = !hasVertexTwice(cell);
  const auto add = [&](std::size_t i, std::size_t j) {
    good = insert(stars_[std::min(cell[i], cell[j])].words, std::max(cell[i], cell[j]), alone_) &&
           good;
  };
  add(0, 1);
  add(0, 3);
  add(0, 4);
  if (shared_[c] == 7) return good;
  for (const SharedEdge& edge : kSharedEdges) {
    if ((shared_[c] & edge.axes) == 0) add(edge.from, edge.to);
  }
  return good;
}

/// Sorts rows, and lists their edges.
bool HexTopologyBuilder::numberEdges() {
  const std::size_t vertices = topology_.vertexCount;
  Array<std::uint64_t> begins(blockCount(vertices, kGrain) + 1, 0);
  parallelBlocks(stage_, vertices, kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   std::size_t edges = 0;
                   for (std::size_t v = begin; v < end; ++v) {
                     const Row row = sorted(stars_[v].words);
                     for (const std::int32_t other : row) edges += other != kFree ? 1 : 0;
                     stars_[v].words = std::bit_cast<Words>(row);
                   }
                   begins[block] = edges;
                 });
  const std::uint64_t edges = exclusiveScan(std::span(begins));
  if (edges > kMaxOvmEntities) return false;
  topology_.edges.resize(static_cast<std::size_t>(edges));
  parallelBlocks(stage_, vertices, kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   auto edge = static_cast<Index>(begins[block]);
                   for (auto v = static_cast<Index>(begin); v < end; ++v) {
                     stars_[v].firstEdge = edge;
                     for (const std::int32_t other : rowOf(stars_[v])) {
                       if (other == kFree) break;
                       topology_.edges[edge++] = {v, static_cast<Index>(other)};
                     }
                   }
                 });
  return true;
}

/// Sets the bits of all faces, and names them for their sides.
void HexTopologyBuilder::collectFaces() {
  sides_.resize(6 * cells_.size());
  parallelFor(stage_, cells_.size(), kGrain, [this](std::size_t c) {
    nameFace<kNearSlots[0]>(c);
    nameFace<kNearSlots[1]>(c);
    nameFace<kNearSlots[2]>(c);
    for (const std::size_t slot : kFarSlots) sides_[6 * c + slot] = kOfNeighbour;
    if (shared_[c] == 7) return;
    if ((shared_[c] & 1U) == 0) nameFace<kFarSlots[0]>(c);
    if ((shared_[c] & 2U) == 0) nameFace<kFarSlots[1]>(c);
    if ((shared_[c] & 4U) == 0) nameFace<kFarSlots[2]>(c);
  });
}

template <std::size_t slot>
void HexTopologyBuilder::nameFace(std::size_t c) {
  const Hex& cell = cells_[c];
  const std::size_t begin = beginOf<slot>(cell);
  const Index smallest = cornerOf(cell, slot, begin);
  Star& star = stars_[smallest];
  const auto [next, previous] =
      placesIn(rowOf(star), cornerOf(cell, slot, begin + 1), cornerOf(cell, slot, begin + 3));
  const unsigned pair = kPairNumbers[next * kPlaces + previous];
  sides_[6 * c + slot] = static_cast<std::uint8_t>(pair | (next < previous ? 0U : kBackwards) |
                                                   (begin << kBeginShift));
  const std::atomic_ref faces(star.faces);
  const std::uint32_t known = faces.load(std::memory_order_relaxed);
  const std::uint32_t bit = std::uint32_t{1} << pair;
  if (alone_) {
    faces.store(known | bit, std::memory_order_relaxed);
  } else if ((known & bit) == 0) {
    faces.fetch_or(bit, std::memory_order_relaxed);
  }
}

bool HexTopologyBuilder::numberFaces() {
  const std::size_t vertices = topology_.vertexCount;
  Array<std::uint64_t> begins(blockCount(vertices, kGrain) + 1, 0);
  parallelBlocks(stage_, vertices, kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   std::uint64_t faces = 0;
                   for (std::size_t v = begin; v < end; ++v) faces += countBits(stars_[v].faces);
                   begins[block] = faces;
                 });
  const std::uint64_t faces = exclusiveScan(std::span(begins));
  if (faces > kMaxOvmEntities) return false;
  parallelBlocks(stage_, vertices, kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   auto face = static_cast<Index>(begins[block]);
                   for (std::size_t v = begin; v < end; ++v) {
                     stars_[v].firstFace = face;
                     face += countBits(stars_[v].faces);
                   }
                 });
  topology_.faces.length = 4;
  topology_.faces.handles.resize(static_cast<std::size_t>(4 * faces));
  return true;
}

/// Gives sides the numbers of their half-faces, which learn of them.
void HexTopologyBuilder::nameSides() {
  const std::size_t faces = topology_.faces.size();
  opposites_.resize(faces);
  halfFaces_.resize(2 * faces);
  parallelFor(stage_, faces, 8 * kGrain,
              [this](std::size_t f) { halfFaces_[2 * f] = halfFaces_[2 * f + 1] = 0; });
  parallelFor(stage_, cells_.size(), kGrain, [this](std::size_t c) {
    for (std::size_t slot = 0; slot < 6; ++slot) {
      if (sides_[6 * c + slot] == kOfNeighbour) continue;
      topology_.cells.handles[6 * c + slot] = nameSide(c, slot);
    }
  });
}

Index HexTopologyBuilder::nameSide(std::size_t c, std::size_t slot) {
  const std::uint8_t name = sides_[6 * c + slot];
  const std::size_t begin = name >> kBeginShift;
  const Star& star = stars_[cornerOf(cells_[c], slot, begin)];
  const std::uint32_t below = (std::uint32_t{1} << (name & kPairMask)) - 1;
  const Index face = star.firstFace + countBits(star.faces & below);
  const bool reversed = (name & kBackwards) != 0;
  // The cell's first corner is the first one of the side as listed.
  const std::size_t first = (reversed ? begin : 4 - begin) & kBeginMask;
  const Index halfFace = 2 * face + (reversed ? 1 : 0);
  take(halfFace, static_cast<std::uint8_t>(slot == 0 ? kFirstSide | first : kTaken));
  std::atomic_ref(opposites_[face])
      .store(cornerOf(cells_[c], slot, begin + 2), std::memory_order_relaxed);
  return halfFace;
}

/// Asks neighbours for the sides that are left to them.
/// @return whether all sides of a face have its four vertices
bool HexTopologyBuilder::copySides() {
  constexpr std::size_t kAhead = 16;
  const Array<Index>& handles = topology_.cells.handles;
  std::atomic<bool> fit{true};
  parallelBlocks(stage_, cells_.size(), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   Index different = 0;
                   for (std::size_t c = begin; c < end; ++c) {
                     if (c + kAhead < end && shared_[c + kAhead] == 7) {
                       for (const std::size_t slot : kFarSlots) {
                         prefetch(&handles[6 * std::size_t{handles[6 * (c + kAhead) + slot]}]);
                       }
                     }
                     for (std::size_t slot = 0; slot < 6; ++slot) different |= copySide(c, slot);
                   }
                   if (different != 0) fit.store(false, std::memory_order_relaxed);
                 });
  return fit;
}

/// @return 0 if the face of the side has its vertices
Index HexTopologyBuilder::copySide(std::size_t c, std::size_t slot) {
  Array<Index>& handles = topology_.cells.handles;
  Index& halfFace = handles[6 * c + slot];
  const std::uint8_t name = sides_[6 * c + slot];
  if (name != kOfNeighbour) {
    return opposites_[halfFace / 2] ^ cornerOf(cells_[c], slot, (name >> kBeginShift) + 2U);
  }
  // The neighbour's side is in the other slot of the axis, and has the same vertices.
  halfFace = handles[6 * std::size_t{halfFace} + (slot ^ 1U)] ^ 1U;
  take(halfFace, kTaken);
  return 0;
}

/// Whether each half-face belongs to one side only.
bool HexTopologyBuilder::allTaken() const {
  std::atomic<std::size_t> taken{0};
  parallelBlocks(stage_, halfFaces_.size(), 16 * kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   std::size_t sum = 0;
                   for (std::size_t i = begin; i < end; ++i) sum += halfFaces_[i] != 0 ? 1U : 0U;
                   taken.fetch_add(sum, std::memory_order_relaxed);
                 });
  return taken == 6 * cells_.size();
}

Index HexTopologyBuilder::halfEdge(Index from, Index to) const {
  const Star& low = stars_[std::min(from, to)];
  return 2 * (low.firstEdge + placeIn(rowOf(low), std::max(from, to))) + (from < to ? 0U : 1U);
}

/// Lists the half-edges of faces, from where the cell begins that has the face first in its list.
void HexTopologyBuilder::linkFacesToEdges() {
  constexpr std::size_t kAhead = 16;
  parallelBlocks(stage_, stars_.size(), kGrain,
                 [this](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   for (std::size_t v = begin; v < end; ++v) {
                     if (v + kAhead < end) fetchNeighbours(v + kAhead);
                     linkFaces(stars_[v]);
                   }
                 });
}

/// Of the vertices that faces here lead to.
void HexTopologyBuilder::fetchNeighbours(std::size_t vertex) const {
  constexpr std::size_t kUsual = 3;
  const Row row = rowOf(stars_[vertex]);
  for (std::size_t i = 0; i < kUsual; ++i) {
    if (row[i] != kFree) prefetch(&stars_[static_cast<std::size_t>(row[i])]);
  }
}

void HexTopologyBuilder::linkFaces(const Star& star) {
  const Row row = rowOf(star);
  Index* handles = topology_.faces.handles.data() + 4 * std::size_t{star.firstFace};
  std::size_t face = star.firstFace;
  for (std::uint32_t bits = star.faces; bits != 0; bits &= bits - 1, ++face, handles += 4) {
    const PlacePair& places = kPairOf[static_cast<std::size_t>(std::countr_zero(bits))];
    const auto first = static_cast<Index>(row[places.first]);
    const auto second = static_cast<Index>(row[places.second]);
    const Index opposite = opposites_[face];
    const std::array<Index, 4> loop = {2 * (star.firstEdge + places.first),
                                       halfEdge(first, opposite), halfEdge(opposite, second),
                                       2 * (star.firstEdge + places.second) + 1};
    const bool atFirst = (halfFaces_[2 * face] & kFirstSide) != 0;
    const std::size_t begin = halfFaces_[2 * face + (atFirst ? 0 : 1)] & kBeginMask;
    for (std::size_t i = 0; i < 4; ++i) handles[i] = loop[(begin + i) % 4];
  }
}

}  // namespace

std::optional<OvmTopology> buildOvmHexTopology(std::size_t vertexCount, std::span<const Hex> cells,
                                               Stage& stage) {
  return HexTopologyBuilder(vertexCount, cells, stage).build();
}

}  // namespace hexhex
