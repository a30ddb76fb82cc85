// Edges and faces of hexahedra that are joined as usual, found in few steps that hardly branch.
//
// A vertex has three edges to larger vertices on average, which its row lists. A face is a pair of
// edges of its smallest vertex: a bit of 28, if a row has eight places. So a vertex knows its faces
// by a word, and the number of a face is that of the first face of the vertex plus the number of
// bits below its own. Threads set bits in any order; the result is the same.
//
// Most neighbours number their corners alike and find each other at once (aligned_cells.hpp). Of
// what they share, only one of them tells: a cell leaves its faces away from corner 0, and the
// edges of them, to the neighbours behind these faces. So most cells look for three edges and three
// faces instead of twelve and six, and ask neighbours for the rest.
#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <type_traits>
#include <utility>

#include <base/parallel.hpp>
#include <base/prefetch.hpp>
#include <io/edge_rows.hpp>
#include <io/ovm_cells.hpp>
#include <io/ovm_hex_topology.hpp>
#include <io/ovm_topology.hpp>
#include <mesh/aligned_cells.hpp>

namespace hexhex {
namespace {

constexpr std::size_t kGrain = 2048;
/// What a cell will ask for is fetched so many cells before: vertices and neighbours may be far
/// from each other in memory.
constexpr std::size_t kAhead = 16;

// How a side names its face: the pair, whether it passes the second edge's vertex first, and which
// of its corners is the smallest one.
constexpr std::uint8_t kPairMask = 31;
constexpr std::uint8_t kBackwards = 32;
constexpr unsigned kBeginShift = 6;

/// By axis: the slots of the faces at corner 0 and of those across from them.
constexpr std::array<std::size_t, 3> kNearSlots = {5, 2, 0};
constexpr std::array<std::size_t, 3> kFarSlots = {4, 3, 1};
/// Bit k of a cell's marks: it has a neighbour behind its far face of axis k.
constexpr std::uint8_t kAllNeighbours = 7;
/// Another cell tells of one of its faces, too, and of the half-face that is listed.
constexpr std::uint8_t kComparesSides = 8;

/// By axis: the corner next to corner 0. Along axes a and b follows corner kDiagonal[a + b - 1].
constexpr std::array<std::size_t, 3> kNext = {1, 3, 4};
constexpr std::array<std::size_t, 3> kDiagonal = {2, 5, 7};

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

/// What a vertex knows of its edges to larger vertices and of the faces whose smallest vertex it
/// is. Together, as they are asked for together, and vertices may be far from each other in memory.
struct Star {
  RowWords words;       ///< at last, a row as it is in memory
  std::uint32_t faces;  ///< a bit for each pair that is a face
  std::uint32_t twice;  ///< those of them of which two cells tell
  Index firstEdge;
  Index firstFace;
};

/// Half-edges of a face, in loop order.
using EdgeLoop = std::array<Index, 4>;

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
    findNearEdges();
    collectFaces();
    if (!numberFaces()) return std::nullopt;
    nameSides();
    if (!copySides() || !allTaken()) return std::nullopt;
    turnFacesToldTwice();
    return std::move(topology_);
  }

 private:
  void findNeighbours();
  bool collectEdges();
  bool addEdges(std::size_t c);
  [[nodiscard]] static EdgeRow rowOf(const Star& star) {
    return std::bit_cast<EdgeRow>(star.words);
  }
  template <class Count, class Assign>
  [[nodiscard]] std::uint64_t number(const Count& count, const Assign& assign);
  bool numberEdges();
  [[nodiscard]] Index halfEdge(Index from, Index to) const;
  void findNearEdges();
  [[nodiscard]] Index nextEdge(std::size_t c, std::size_t along, std::size_t axis) const;
  template <std::size_t slot>
  [[nodiscard]] EdgeLoop loopOf(std::size_t c) const;
  void fetchStars(std::size_t c) const;
  void fetchNeighbours(std::size_t c) const;
  template <class F>
  void forEachOwnSide(const F& f);
  void collectFaces();
  template <std::size_t slot>
  void collectFace(std::size_t c);
  bool numberFaces();
  void nameSides();
  template <std::size_t slot>
  void nameSide(std::size_t c);
  bool copySides();
  void copySide(std::size_t c, std::size_t axis);
  [[nodiscard]] bool comparesSide(std::size_t c, std::size_t slot) const;
  template <std::size_t slot>
  [[nodiscard]] bool isAsListed(std::size_t c) const;
  [[nodiscard]] bool allTaken() const;
  void turnFacesToldTwice();

  void take(Index halfFace, std::uint8_t what) {
    std::atomic_ref(halfFaces_[halfFace]).store(what, std::memory_order_relaxed);
  }

  std::span<const Hex> cells_;
  Stage& stage_;
  OvmTopology topology_;
  const bool alone_ = currentThreads() == 1;
  Array<Star> stars_;                      ///< per vertex
  Array<std::array<Index, 3>> nearEdges_;  ///< per cell and axis: the half-edge from corner 0
  Array<std::uint8_t> sides_;      ///< per side: its face among those of its smallest vertex
  Array<std::uint8_t> marks_;      ///< per cell
  Array<std::uint8_t> halfFaces_;  ///< per half-face: what is known of it
};

/// Until sides have numbers, the places of those that are left to neighbours hold the neighbours.
void HexTopologyBuilder::findNeighbours() {
  const AlignedCells aligned(topology_.vertexCount, cells_, stage_);
  topology_.cells.length = 6;
  topology_.cells.handles.resize(6 * cells_.size());
  marks_.resize(cells_.size());
  const auto note = [marks = marks_.data(), handles = topology_.cells.handles.data()](
                        std::size_t c, const std::array<Index, 3>& behind) {
    unsigned bits = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      handles[6 * c + kFarSlots[axis]] = behind[axis];
      bits |= behind[axis] != kNone ? 1U << axis : 0U;
    }
    marks[c] = static_cast<std::uint8_t>(bits);
  };
  parallelBlocks(stage_, cells_.size(), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   aligned.forEach(begin, end, note);
                 });
}

bool HexTopologyBuilder::collectEdges() {
  stars_.resize(topology_.vertexCount);
  parallelFor(stage_, stars_.size(), kGrain, [stars = stars_.data()](std::size_t v) {
    stars[v].words.fill(kFreeRowWord);
    stars[v].faces = stars[v].twice = 0;
  });
  std::atomic<bool> fits{true};
  parallelBlocks(stage_, cells_.size(), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   bool good = true;
                   for (std::size_t c = begin; c < end; ++c) {
                     if (c + kAhead < end) fetchStars(c + kAhead);
                     good = addEdges(c) && good;
                   }
                   if (!good) fits.store(false, std::memory_order_relaxed);
                 });
  return fits;
}

/// What is asked for first: near edges and faces begin there.
void HexTopologyBuilder::fetchStars(std::size_t c) const {
  const Hex& cell = cells_[c];
  prefetch(&stars_[cell[0]]);
  for (const std::size_t corner : kNext) prefetch(&stars_[cell[corner]]);
}

/// @return false if there is no place for an edge, or the cell has a vertex twice
bool HexTopologyBuilder::addEdges(std::size_t c) {
  const Hex& cell = cells_[c];
  bool good = !hasVertexTwice(cell);
  const auto add = [&](std::size_t i, std::size_t j) {
    good = insertIntoRow(stars_[std::min(cell[i], cell[j])].words, std::max(cell[i], cell[j]),
                         alone_) &&
           good;
  };
  add(0, 1);
  add(0, 3);
  add(0, 4);
  if (marks_[c] == kAllNeighbours) return good;
  for (const SharedEdge& edge : kSharedEdges) {
    if ((marks_[c] & edge.axes) == 0) add(edge.from, edge.to);
  }
  return good;
}

/// Numbers what vertices have, one vertex after the other.
/// @param count   how many a star has; asked once
/// @param assign  (star, vertex, number of its first one)
/// @return how many all have
template <class Count, class Assign>
std::uint64_t HexTopologyBuilder::number(const Count& count, const Assign& assign) {
  const std::size_t vertices = stars_.size();
  const auto assignAll = [&](std::size_t begin, std::size_t end, std::uint64_t next,
                             const auto& countOf) {
    for (std::size_t v = begin; v < end; ++v) {
      const std::uint64_t here = countOf(stars_[v]);
      assign(stars_[v], static_cast<Index>(v), next);
      next += here;
    }
    return next;
  };
  if (alone_) {  // nobody waits for the sum of what stands before
    LoopProgress progress(stage_, vertices);
    std::uint64_t sum = 0;
    for (std::size_t begin = 0; begin < vertices; begin += kGrain) {
      const std::size_t end = std::min(begin + kGrain, vertices);
      sum = assignAll(begin, end, sum, count);
      progress.advance(end - begin);
    }
    return sum;
  }
  Array<std::uint64_t> begins(blockCount(vertices, kGrain) + 1, 0);
  Array<std::uint8_t> counts(vertices);
  parallelBlocks(stage_, vertices, kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   std::uint64_t sum = 0;
                   for (std::size_t v = begin; v < end; ++v) {
                     counts[v] = static_cast<std::uint8_t>(count(stars_[v]));
                     sum += counts[v];
                   }
                   begins[block] = sum;
                 });
  const std::uint64_t sum = exclusiveScan(std::span(begins));
  parallelBlocks(
      stage_, vertices, kGrain, [&](std::size_t begin, std::size_t end, std::size_t block) {
        std::size_t next = begin;
        assignAll(begin, end, begins[block], [&](const Star& /*star*/) { return counts[next++]; });
      });
  return sum;
}

/// Sorts rows, and lists their edges.
bool HexTopologyBuilder::numberEdges() {
  // More than there are; what is not used is not touched.
  topology_.edges.resize(std::min(kRowPlaces * stars_.size(), 12 * cells_.size()));
  const std::uint64_t edges = number(
      [](Star& star) {
        const EdgeRow row = sortedRow(star.words);
        star.words = std::bit_cast<RowWords>(row);
        return static_cast<std::uint64_t>(std::count_if(
            row.begin(), row.end(), [](std::int32_t end) { return end != kFreePlace; }));
      },
      [this](Star& star, Index vertex, std::uint64_t first) {
        star.firstEdge = static_cast<Index>(first);
        std::array<Index, 2>* edge = topology_.edges.data() + first;
        for (const std::int32_t end : rowOf(star)) {
          if (end == kFreePlace) break;
          *edge++ = {vertex, static_cast<Index>(end)};
        }
      });
  if (edges > kMaxOvmEntities) return false;
  topology_.edges.resize(static_cast<std::size_t>(edges));
  return true;
}

Index HexTopologyBuilder::halfEdge(Index from, Index to) const {
  const Star& low = stars_[std::min(from, to)];
  return 2 * (low.firstEdge + placeInRow(rowOf(low), std::max(from, to))) + (from < to ? 0U : 1U);
}

void HexTopologyBuilder::findNearEdges() {
  nearEdges_.resize(cells_.size());
  parallelBlocks(stage_, cells_.size(), kGrain,
                 [this](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   for (std::size_t c = begin; c < end; ++c) {
                     if (c + kAhead < end) fetchStars(c + kAhead);
                     const Hex& cell = cells_[c];
                     for (std::size_t axis = 0; axis < 3; ++axis) {
                       nearEdges_[c][axis] = halfEdge(cell[0], cell[kNext[axis]]);
                     }
                   }
                 });
}

/// The half-edge that follows another one from corner 0 on, in the direction of another axis.
Index HexTopologyBuilder::nextEdge(std::size_t c, std::size_t along, std::size_t axis) const {
  if ((marks_[c] >> along & 1U) != 0) {
    return nearEdges_[topology_.cells.handles[6 * c + kFarSlots[along]]][axis];
  }
  return halfEdge(cells_[c][kNext[along]], cells_[c][kDiagonal[along + axis - 1]]);
}

/// The loop of a side, from its first corner on; before copySides().
template <std::size_t slot>
EdgeLoop HexTopologyBuilder::loopOf(std::size_t c) const {
  if constexpr (slot == kNearSlots[0] || slot == kNearSlots[1] || slot == kNearSlots[2]) {
    constexpr std::size_t kAxis = slot == kNearSlots[0] ? 0 : (slot == kNearSlots[1] ? 1 : 2);
    constexpr std::size_t kFirst = (kAxis + 1) % 3;
    constexpr std::size_t kLast = (kAxis + 2) % 3;
    return {nearEdges_[c][kFirst], nextEdge(c, kFirst, kLast), nextEdge(c, kLast, kFirst) ^ 1U,
            nearEdges_[c][kLast] ^ 1U};
  } else {
    EdgeLoop loop;
    for (std::size_t i = 0; i < 4; ++i) {
      loop[i] = halfEdge(cornerOf(cells_[c], slot, i), cornerOf(cells_[c], slot, i + 1));
    }
    return loop;
  }
}

/// What loopOf() will ask for.
void HexTopologyBuilder::fetchNeighbours(std::size_t c) const {
  for (const std::size_t slot : kFarSlots) {
    const Index neighbour = topology_.cells.handles[6 * c + slot];
    if (neighbour != kNone) prefetch(&nearEdges_[neighbour]);
  }
}

/// Calls f(cell, slot as a constant) for all sides that are not left to neighbours.
template <class F>
void HexTopologyBuilder::forEachOwnSide(const F& f) {
  const auto visit = [&](std::size_t c) {
    const auto at = [&]<std::size_t slot>() { f(c, std::integral_constant<std::size_t, slot>()); };
    at.template operator()<kNearSlots[0]>();
    at.template operator()<kNearSlots[1]>();
    at.template operator()<kNearSlots[2]>();
    const unsigned marks = marks_[c];
    if ((marks & kAllNeighbours) == kAllNeighbours) return;
    if ((marks & 1U) == 0) at.template operator()<kFarSlots[0]>();
    if ((marks & 2U) == 0) at.template operator()<kFarSlots[1]>();
    if ((marks & 4U) == 0) at.template operator()<kFarSlots[2]>();
  };
  parallelBlocks(stage_, cells_.size(), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   for (std::size_t c = begin; c < end; ++c) {
                     if (c + kAhead < end) {
                       fetchStars(c + kAhead);
                       fetchNeighbours(c + kAhead);
                     }
                     visit(c);
                   }
                 });
}

/// Sets the bits of all faces, and names them for their sides.
void HexTopologyBuilder::collectFaces() {
  sides_.resize(6 * cells_.size());
  forEachOwnSide([this](std::size_t c, auto slot) { collectFace<slot>(c); });
}

template <std::size_t slot>
void HexTopologyBuilder::collectFace(std::size_t c) {
  const EdgeLoop loop = loopOf<slot>(c);
  const std::size_t begin = beginOf<slot>(cells_[c]);
  Star& star = stars_[cornerOf(cells_[c], slot, begin)];
  const Index next = loop[begin] / 2 - star.firstEdge;
  const Index previous = loop[(begin + 3) % 4] / 2 - star.firstEdge;
  const unsigned pair = kRowPairNumbers[next * kRowPlaces + previous];
  sides_[6 * c + slot] = static_cast<std::uint8_t>(pair | (next < previous ? 0U : kBackwards) |
                                                   (begin << kBeginShift));
  const std::uint32_t bit = std::uint32_t{1} << pair;
  const std::atomic_ref faces(star.faces);
  std::uint32_t known = faces.load(std::memory_order_relaxed);
  if ((known & bit) == 0) {
    if (alone_) return faces.store(known | bit, std::memory_order_relaxed);
    known = faces.fetch_or(bit, std::memory_order_relaxed);
  }
  if ((known & bit) == 0) return;
  const std::atomic_ref twice(star.twice);
  twice.fetch_or(bit, std::memory_order_relaxed);
}

bool HexTopologyBuilder::numberFaces() {
  const std::uint64_t faces =
      number([](const Star& star) { return std::uint64_t{countBits(star.faces)}; },
             [](Star& star, Index /*vertex*/, std::uint64_t first) {
               star.firstFace = static_cast<Index>(first);
             });
  if (faces > kMaxOvmEntities) return false;
  topology_.faces.length = 4;
  topology_.faces.handles.resize(static_cast<std::size_t>(4 * faces));
  return true;
}

/// Gives sides the numbers of their half-faces, which learn of them, and lists the half-edges of
/// faces: from where the cell begins that has the face first in its list, else from the smallest
/// vertex. Of faces that two cells tell of, half-face 2f is listed, from the smallest vertex.
void HexTopologyBuilder::nameSides() {
  const std::size_t faces = topology_.faces.size();
  halfFaces_.resize(2 * faces);
  parallelBlocks(stage_, halfFaces_.size(), 16 * kGrain,
                 [this](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   std::fill(halfFaces_.data() + begin, halfFaces_.data() + end, std::uint8_t{0});
                 });
  forEachOwnSide([this](std::size_t c, auto slot) { nameSide<slot>(c); });
}

template <std::size_t slot>
void HexTopologyBuilder::nameSide(std::size_t c) {
  const std::uint8_t name = sides_[6 * c + slot];
  const std::size_t begin = name >> kBeginShift;
  const Star& star = stars_[cornerOf(cells_[c], slot, begin)];
  const std::uint32_t bit = std::uint32_t{1} << (name & kPairMask);
  const Index face = star.firstFace + countBits(star.faces & (bit - 1));
  const bool reversed = (name & kBackwards) != 0;
  const Index halfFace = 2 * face + (reversed ? 1 : 0);
  topology_.cells.handles[6 * c + slot] = halfFace;
  // The cell's first corner is the first one of the side as listed.
  const std::size_t first = (reversed ? begin : 4 - begin) & kBeginMask;
  take(halfFace, static_cast<std::uint8_t>(slot == 0 ? kFirstSide | first : kTaken));
  const bool told = (star.twice & bit) != 0;
  if (told && reversed) {
    marks_[c] |= kComparesSides;
  } else {
    const EdgeLoop loop = loopOf<slot>(c);
    // The reversed loop has the other half-edges in the other order.
    const std::size_t start = (slot == 0 && !told ? 0 : begin) + (reversed ? 3 : 0);
    const std::size_t step = reversed ? 3 : 1;
    const Index flip = reversed ? 1 : 0;
    Index* const handles = topology_.faces.handles.data() + 4 * std::size_t{face};
    for (std::size_t i = 0; i < 4; ++i) {
      // Of a broken mesh, several cells may tell of the same half-face.
      std::atomic_ref(handles[i])
          .store(loop[(start + step * i) % 4] ^ flip, std::memory_order_relaxed);
    }
  }
}

/// Asks neighbours for the sides that are left to them.
/// @return whether all sides of a face have its four vertices
bool HexTopologyBuilder::copySides() {
  const Array<Index>& handles = topology_.cells.handles;
  std::atomic<bool> fit{true};
  // First, as it needs the neighbours.
  parallelFor(stage_, cells_.size(), kGrain, [&](std::size_t c) {
    if ((marks_[c] & kComparesSides) == 0) return;
    const bool listed = isAsListed<0>(c) && isAsListed<1>(c) && isAsListed<2>(c) &&
                        isAsListed<3>(c) && isAsListed<4>(c) && isAsListed<5>(c);
    if (!listed) fit.store(false, std::memory_order_relaxed);
  });
  parallelBlocks(stage_, cells_.size(), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   for (std::size_t c = begin; c < end; ++c) {
                     if (c + kAhead < end && (marks_[c + kAhead] & 7) == kAllNeighbours) {
                       for (const std::size_t slot : kFarSlots) {
                         prefetch(&handles[6 * std::size_t{handles[6 * (c + kAhead) + slot]}]);
                       }
                     }
                     for (std::size_t axis = 0; axis < 3; ++axis) {
                       if ((marks_[c] >> axis & 1U) != 0) copySide(c, axis);
                     }
                   }
                 });
  return fit;
}

/// The neighbour's side is the near one of the axis, and has the same vertices.
void HexTopologyBuilder::copySide(std::size_t c, std::size_t axis) {
  Array<Index>& handles = topology_.cells.handles;
  Index& halfFace = handles[6 * c + kFarSlots[axis]];
  halfFace = handles[6 * std::size_t{halfFace} + kNearSlots[axis]] ^ 1U;
  take(halfFace, kTaken);
}

/// Whether another cell tells of the face of a side, too, and has listed it.
bool HexTopologyBuilder::comparesSide(std::size_t c, std::size_t slot) const {
  const std::size_t axis = 2 - slot / 2;
  if (slot == kFarSlots[axis] && (marks_[c] >> axis & 1U) != 0) return false;
  const std::uint8_t name = sides_[6 * c + slot];
  const Star& star = stars_[cornerOf(cells_[c], slot, name >> kBeginShift)];
  return (name & kBackwards) != 0 && (star.twice >> (name & kPairMask) & 1U) != 0;
}

/// Whether the face has the vertices of the side then.
template <std::size_t slot>
bool HexTopologyBuilder::isAsListed(std::size_t c) const {
  if (!comparesSide(c, slot)) return true;
  const std::size_t begin = sides_[6 * c + slot] >> kBeginShift;
  const EdgeLoop loop = loopOf<slot>(c);
  const std::span<const Index> listed = topology_.faces[topology_.cells.handles[6 * c + slot] / 2];
  for (std::size_t i = 0; i < 4; ++i) {
    if (listed[i] != (loop[(begin + 3 - i) % 4] ^ 1U)) return false;
  }
  return true;
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

/// Lets the faces that two cells have told of begin where the cell begins that has them first in
/// its list.
void HexTopologyBuilder::turnFacesToldTwice() {
  parallelFor(stage_, cells_.size(), kGrain, [this](std::size_t c) {
    if ((marks_[c] & kComparesSides) == 0) return;
    for (std::size_t slot = 0; slot < 6; ++slot) {
      if (!comparesSide(c, slot)) continue;
      const std::size_t face = topology_.cells.handles[6 * c + slot] / 2;
      const bool atFirst = (halfFaces_[2 * face] & kFirstSide) != 0;
      const std::size_t begin = halfFaces_[2 * face + (atFirst ? 0 : 1)] & kBeginMask;
      Index* const handles = topology_.faces.handles.data() + 4 * face;
      std::rotate(handles, handles + begin, handles + 4);
    }
  });
}

}  // namespace

std::optional<OvmTopology> buildOvmHexTopology(std::size_t vertexCount, std::span<const Hex> cells,
                                               Stage& stage) {
  return HexTopologyBuilder(vertexCount, cells, stage).build();
}

}  // namespace hexhex
