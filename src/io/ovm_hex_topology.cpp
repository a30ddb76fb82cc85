// Edges and faces of hexahedra that are joined as usual, found in few steps that hardly branch.
//
// A vertex has three edges to larger vertices on average, which its row lists. A face is a pair of
// edges of its smallest vertex: a bit of 28, if a row has eight places. So a vertex knows its faces
// by a word, and the number of a face is that of the first face of the vertex plus the number of
// bits below its own. Threads set bits in any order; the result is the same.
#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <limits>
#include <utility>

#include <base/parallel.hpp>
#include <io/ovm_cells.hpp>
#include <io/ovm_hex_topology.hpp>
#include <io/ovm_topology.hpp>

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
/// @return false if there is no place
bool insert(Words& words, std::uint64_t vertex) {
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
  // Few places are taken, so that this is quick.
  for (std::size_t i = 1; i < kPlaces && row[i] != kFree; ++i) {
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

class HexTopologyBuilder {
 public:
  HexTopologyBuilder(std::size_t vertexCount, std::span<const Hex> cells, Stage& stage)
      : cells_(cells), stage_(stage) {
    topology_.vertexCount = vertexCount;
  }

  std::optional<OvmTopology> build() {
    if (!collectEdges()) return std::nullopt;
    if (!numberEdges()) return std::nullopt;
    collectFaces();
    if (!numberFaces()) return std::nullopt;
    nameSides();
    if (!sidesFit()) return std::nullopt;
    linkFacesToEdges();
    return std::move(topology_);
  }

 private:
  bool collectEdges();
  [[nodiscard]] Row rowOf(std::size_t vertex) const { return std::bit_cast<Row>(words_[vertex]); }
  bool numberEdges();
  void collectFaces();
  void nameFace(std::size_t c, std::size_t slot, std::size_t begin);
  bool numberFaces();
  void nameSides();
  [[nodiscard]] bool sidesFit() const;
  [[nodiscard]] Index halfEdge(Index from, Index to) const;
  void linkFacesToEdges();

  std::span<const Hex> cells_;
  Stage& stage_;
  OvmTopology topology_;
  Array<Words> words_;             ///< per vertex; at last, rows as they are in memory
  Array<Index> edgeBegins_;        ///< per vertex: its first edge
  Array<std::uint32_t> faces_;     ///< per vertex: a bit for each pair that is a face
  Array<Index> faceBegins_;        ///< per vertex: its first face
  Array<std::uint8_t> sides_;      ///< per side: its face among those of its smallest vertex
  Array<Index> opposites_;         ///< per face: the vertex opposite the smallest one
  Array<std::uint8_t> halfFaces_;  ///< per half-face: what is known of it
};

bool HexTopologyBuilder::collectEdges() {
  words_.resize(topology_.vertexCount);
  parallelFor(stage_, words_.size(), kGrain, [this](std::size_t v) { words_[v].fill(kFreeWord); });
  std::atomic<bool> fits{true};
  parallelFor(stage_, cells_.size(), kGrain, [&](std::size_t c) {
    const Hex& cell = cells_[c];
    bool good = !hasVertexTwice(cell);
    const auto add = [&](std::size_t i, std::size_t j) {
      good = insert(words_[std::min(cell[i], cell[j])], std::max(cell[i], cell[j])) && good;
    };
    for (std::size_t i = 0; i < 4; ++i) {
      add(i, (i + 1) % 4);
      add(i + 4, (i + 1) % 4 + 4);
      add(i, i + 4);
    }
    if (!good) fits.store(false, std::memory_order_relaxed);
  });
  return fits;
}

/// Sorts rows, and lists their edges.
bool HexTopologyBuilder::numberEdges() {
  const std::size_t vertices = topology_.vertexCount;
  Array<std::uint64_t> begins(blockCount(vertices, kGrain) + 1, 0);
  parallelBlocks(stage_, vertices, kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   std::size_t edges = 0;
                   for (std::size_t v = begin; v < end; ++v) {
                     const Row row = sorted(words_[v]);
                     for (const std::int32_t other : row) edges += other != kFree ? 1 : 0;
                     words_[v] = std::bit_cast<Words>(row);
                   }
                   begins[block] = edges;
                 });
  const std::uint64_t edges = exclusiveScan(std::span(begins));
  if (edges > kMaxOvmEntities) return false;
  edgeBegins_.resize(vertices);
  topology_.edges.resize(static_cast<std::size_t>(edges));
  parallelBlocks(stage_, vertices, kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   auto edge = static_cast<Index>(begins[block]);
                   for (auto v = static_cast<Index>(begin); v < end; ++v) {
                     edgeBegins_[v] = edge;
                     for (const std::int32_t other : rowOf(v)) {
                       if (other == kFree) break;
                       topology_.edges[edge++] = {v, static_cast<Index>(other)};
                     }
                   }
                 });
  return true;
}

/// Sets the bits of all faces, and names them for their sides.
void HexTopologyBuilder::collectFaces() {
  faces_.resize(topology_.vertexCount);
  parallelFor(stage_, faces_.size(), 8 * kGrain, [this](std::size_t v) { faces_[v] = 0; });
  sides_.resize(6 * cells_.size());
  parallelFor(stage_, cells_.size(), kGrain, [this](std::size_t c) {
    [&]<std::size_t... slot>(std::index_sequence<slot...> /*all*/) {
      (nameFace(c, slot, beginOf<slot>(cells_[c])), ...);
    }
    (std::make_index_sequence<6>());
  });
}

void HexTopologyBuilder::nameFace(std::size_t c, std::size_t slot, std::size_t begin) {
  const Hex& cell = cells_[c];
  const Index smallest = cornerOf(cell, slot, begin);
  const auto [next, previous] =
      placesIn(rowOf(smallest), cornerOf(cell, slot, begin + 1), cornerOf(cell, slot, begin + 3));
  const unsigned pair = kPairNumbers[next * kPlaces + previous];
  sides_[6 * c + slot] = static_cast<std::uint8_t>(pair | (next < previous ? 0U : kBackwards) |
                                                   (begin << kBeginShift));
  const std::atomic_ref faces(faces_[smallest]);
  const std::uint32_t bit = std::uint32_t{1} << pair;
  if ((faces.load(std::memory_order_relaxed) & bit) == 0) {
    faces.fetch_or(bit, std::memory_order_relaxed);
  }
}

bool HexTopologyBuilder::numberFaces() {
  const std::size_t vertices = topology_.vertexCount;
  Array<std::uint64_t> begins(blockCount(vertices, kGrain) + 1, 0);
  parallelBlocks(stage_, vertices, kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   std::uint64_t faces = 0;
                   for (std::size_t v = begin; v < end; ++v) faces += countBits(faces_[v]);
                   begins[block] = faces;
                 });
  const std::uint64_t faces = exclusiveScan(std::span(begins));
  if (faces > kMaxOvmEntities) return false;
  faceBegins_.resize(vertices);
  parallelBlocks(stage_, vertices, kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   auto face = static_cast<Index>(begins[block]);
                   for (std::size_t v = begin; v < end; ++v) {
                     faceBegins_[v] = face;
                     face += countBits(faces_[v]);
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
  topology_.cells.length = 6;
  Array<Index>& handles = topology_.cells.handles;
  handles.resize(6 * cells_.size());
  parallelFor(stage_, cells_.size(), kGrain, [&](std::size_t c) {
    for (std::size_t slot = 0; slot < 6; ++slot) {
      const std::uint8_t name = sides_[6 * c + slot];
      const std::size_t begin = name >> kBeginShift;
      const Index smallest = cornerOf(cells_[c], slot, begin);
      const std::uint32_t below = (std::uint32_t{1} << (name & kPairMask)) - 1;
      const Index face = faceBegins_[smallest] + countBits(faces_[smallest] & below);
      const bool reversed = (name & kBackwards) != 0;
      // The cell's first corner is the first one of the side as listed.
      const std::size_t first = (reversed ? begin : 4 - begin) & kBeginMask;
      const Index halfFace = 2 * face + (reversed ? 1 : 0);
      handles[6 * c + slot] = halfFace;
      std::atomic_ref(halfFaces_[halfFace])
          .store(static_cast<std::uint8_t>(slot == 0 ? kFirstSide | first : kTaken),
                 std::memory_order_relaxed);
      std::atomic_ref(opposites_[face])
          .store(cornerOf(cells_[c], slot, begin + 2), std::memory_order_relaxed);
    }
  });
}

/// Whether each half-face belongs to one side only, and all sides of a face have its four vertices.
bool HexTopologyBuilder::sidesFit() const {
  std::atomic<std::size_t> taken{0};
  parallelBlocks(stage_, halfFaces_.size(), 16 * kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   std::size_t sum = 0;
                   for (std::size_t i = begin; i < end; ++i) sum += halfFaces_[i] != 0 ? 1U : 0U;
                   taken.fetch_add(sum, std::memory_order_relaxed);
                 });
  if (taken != 6 * cells_.size()) return false;
  std::atomic<bool> fit{true};
  parallelBlocks(stage_, cells_.size(), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   Index different = 0;
                   for (std::size_t c = begin; c < end; ++c) {
                     for (std::size_t slot = 0; slot < 6; ++slot) {
                       const Index face = topology_.cells.handles[6 * c + slot] / 2;
                       const std::size_t least = sides_[6 * c + slot] >> kBeginShift;
                       different |= opposites_[face] ^ cornerOf(cells_[c], slot, least + 2);
                     }
                   }
                   if (different != 0) fit.store(false, std::memory_order_relaxed);
                 });
  return fit;
}

Index HexTopologyBuilder::halfEdge(Index from, Index to) const {
  const Index low = std::min(from, to);
  return 2 * (edgeBegins_[low] + placeIn(rowOf(low), std::max(from, to))) + (from < to ? 0U : 1U);
}

/// Lists the half-edges of faces, from where the cell begins that has the face first in its list.
void HexTopologyBuilder::linkFacesToEdges() {
  parallelFor(stage_, faces_.size(), kGrain, [this](std::size_t v) {
    const Row row = rowOf(v);
    Index face = faceBegins_[v];
    for (std::uint32_t bits = faces_[v]; bits != 0; bits &= bits - 1, ++face) {
      const PlacePair& places = kPairOf[static_cast<std::size_t>(std::countr_zero(bits))];
      const auto first = static_cast<Index>(row[places.first]);
      const auto second = static_cast<Index>(row[places.second]);
      const std::array<Index, 4> loop = {
          2 * (edgeBegins_[v] + places.first), halfEdge(first, opposites_[face]),
          halfEdge(opposites_[face], second), 2 * (edgeBegins_[v] + places.second) + 1};
      const std::size_t f = face;
      const bool atFirst = (halfFaces_[2 * f] & kFirstSide) != 0;
      const std::size_t begin = halfFaces_[2 * f + (atFirst ? 0 : 1)] & kBeginMask;
      for (std::size_t i = 0; i < 4; ++i) {
        topology_.faces.handles[4 * f + i] = loop[(begin + i) % 4];
      }
    }
  });
}

}  // namespace

std::optional<OvmTopology> buildOvmHexTopology(std::size_t vertexCount, std::span<const Hex> cells,
                                               Stage& stage) {
  return HexTopologyBuilder(vertexCount, cells, stage).build();
}

}  // namespace hexhex
