// Most neighbours number their corners alike and find each other at once. A face that is found in
// another way, or could be another cell's as well, has all its vertices on seams; such faces are
// few in most meshes, and are sorted at their smallest vertices.
#include <algorithm>
#include <array>
#include <atomic>
#include <tuple>
#include <vector>

#include <adjacency/aligned_cells.hpp>
#include <adjacency/hex_topology.hpp>
#include <adjacency/vertex_lists.hpp>

#include <base/parallel.hpp>
#include <base/prefetch.hpp>
#include <io/ovm/ovm_cells.hpp>
#include <io/ovm/ovm_hex_mates.hpp>

namespace hexhex {
namespace {

constexpr std::size_t kGrain = 2048;

/// By face: its corners as bits.
constexpr std::array<unsigned, 6> makeFaceCorners() {
  std::array<unsigned, 6> result{};
  for (std::size_t f = 0; f < 6; ++f) {
    for (const std::uint8_t corner : kHexFaces[f]) result[f] |= 1U << corner;
  }
  return result;
}
constexpr std::array<unsigned, 6> kFaceCorners = makeFaceCorners();

/// A side whose vertices are all on seams. The smallest of them is known from the context.
struct SeamSide {
  std::array<Index, 3> others;  ///< ascending
  Index side;
  [[nodiscard]] bool operator<(const SeamSide& other) const {
    return std::tie(others, side) < std::tie(other.others, other.side);
  }
};

/// Where the mate of a side stands.
std::size_t placeOf(Index side) { return 6 * cellOf(side) + faceOf(side); }

Quad verticesOf(std::span<const Hex> cells, Index side) {
  return faceVertices(cells[cellOf(side)], faceOf(side));
}

/// Whether two quads with the same vertices pass them in opposite directions.
bool areOpposite(const Quad& here, const Quad& there) {
  std::size_t start = 0;
  for (std::size_t i = 1; i < 4; ++i) start += there[i] == here[0] ? i : 0;
  bool opposite = true;
  for (std::size_t i = 0; i < 4; ++i) opposite &= here[i] == there[(start + 4 - i) % 4];
  return opposite;
}

class MateFinder {
 public:
  MateFinder(std::size_t vertexCount, std::span<const Hex> cells, Stage& stage)
      : vertexCount_(vertexCount), cells_(cells), stage_(stage) {}

  std::optional<HexMates> find() {
    linkAligned();
    findSeams();
    if (sound_) matchSeamSides();
    if (!sound_) return std::nullopt;
    return std::move(result_);
  }

 private:
  template <class F>
  void forEachBlock(std::size_t n, const F& f);
  void linkAligned();
  [[nodiscard]] bool link(std::size_t cell, const std::array<Index, 3>& behind);
  void findSeams();
  [[nodiscard]] int markSeams(std::size_t cell, std::span<std::uint8_t> onSeam) const;
  template <class F>
  void forEachSeamSide(const F& f) const;
  void matchSeamSides();
  [[nodiscard]] bool match(std::span<const SeamSide> face);

  std::size_t vertexCount_;
  std::span<const Hex> cells_;
  Stage& stage_;
  HexMates result_;
  std::atomic<bool> sound_{true};
};

/// Calls f(element), which tells whether all is well, in parallel.
template <class F>
void MateFinder::forEachBlock(std::size_t n, const F& f) {
  parallelBlocks(stage_, n, kGrain, [&](std::size_t begin, std::size_t end, std::size_t block) {
    if (!f(begin, end, block)) sound_.store(false, std::memory_order_relaxed);
  });
}

void MateFinder::linkAligned() {
  Array<Index>& mates = result_.mates;
  mates.resize(6 * cells_.size());
  parallelBlocks(stage_, mates.size(), 6 * kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   std::fill(mates.data() + begin, mates.data() + end, kNone);
                 });
  const AlignedCells aligned(vertexCount_, cells_, stage_);
  forEachBlock(cells_.size(), [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
    bool good = true;
    aligned.forEach(begin, end, [&](std::size_t cell, const std::array<Index, 3>& behind) {
      good = link(cell, behind) && good;
    });
    return good;
  });
}

/// @return whether the cell's vertices, and those of the edges that follow on its own, are
/// different
bool MateFinder::link(std::size_t cell, const std::array<Index, 3>& behind) {
  Index* const mates = result_.mates.data();
  const Hex& here = cells_[cell];
  bool good = !hasVertexTwice(here);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (behind[axis] == kNone) continue;
    good &= cells_[behind[axis]][kNextCorner[axis]] != here[0];
    const std::size_t far = 2 * axis + 1;
    const std::size_t near = 2 * axis;
    mates[6 * cell + far] = sideOf(behind[axis], near);
    // In a broken mesh, two cells may claim the same side: then fewer sides are claimed than claim.
    std::atomic_ref(mates[6 * std::size_t{behind[axis]} + near])
        .store(sideOf(cell, far), std::memory_order_relaxed);
  }
  return good;
}

void MateFinder::findSeams() {
  Array<std::uint8_t> onSeam(vertexCount_);
  parallelFor(stage_, onSeam.size(), 8 * kGrain, [&](std::size_t v) { onSeam[v] = 0; });
  std::atomic<std::int64_t> unanswered{0};
  parallelBlocks(stage_, cells_.size(), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   std::int64_t sum = 0;
                   for (std::size_t c = begin; c < end; ++c) sum += markSeams(c, onSeam);
                   unanswered.fetch_add(sum, std::memory_order_relaxed);
                 });
  if (unanswered != 0) sound_ = false;
  result_.seamCorners.resize(cells_.size());
  parallelFor(stage_, cells_.size(), kGrain, [&](std::size_t c) {
    unsigned corners = 0;
    for (std::size_t k = 0; k < 8; ++k) corners |= unsigned{onSeam[cells_[c][k]]} << k;
    result_.seamCorners[c] = static_cast<std::uint8_t>(corners);
  });
}

/// @return how many more of the cell's far sides have claimed a mate than near sides are claimed
int MateFinder::markSeams(std::size_t cell, std::span<std::uint8_t> onSeam) const {
  const Index* const mates = result_.mates.data() + 6 * cell;
  int balance = 0;
  for (std::size_t face = 0; face < 6; ++face) {
    if (mates[face] != kNone) {
      balance += face % 2 == 1 ? 1 : -1;
      continue;
    }
    for (const Index v : faceVertices(cells_[cell], face)) {
      std::atomic_ref(onSeam[v]).store(1, std::memory_order_relaxed);
    }
  }
  return balance;
}

/// Calls f(smallest vertex, side) for the sides with all vertices on seams, in parallel.
template <class F>
void MateFinder::forEachSeamSide(const F& f) const {
  parallelFor(stage_, cells_.size(), kGrain, [&](std::size_t c) {
    const unsigned corners = result_.seamCorners[c];
    if (corners == 0) return;
    for (std::size_t face = 0; face < 6; ++face) {
      if ((corners & kFaceCorners[face]) != kFaceCorners[face]) continue;
      const Quad quad = faceVertices(cells_[c], face);
      f(*std::min_element(quad.begin(), quad.end()), sideOf(c, face));
    }
  });
}

void MateFinder::matchSeamSides() {
  VertexLists<Index> lists(vertexCount_, stage_);
  forEachSeamSide([&](Index vertex, Index /*side*/) { lists.count(vertex); });
  lists.makeRoom();
  forEachSeamSide([&](Index vertex, Index side) { lists.enter(vertex, side); });
  forEachBlock(vertexCount_, [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
    bool good = true;
    std::vector<SeamSide> sides;
    for (std::size_t v = begin; v < end; ++v) {
      sides.clear();
      for (const Index side : lists.at(v)) {
        Quad quad = verticesOf(cells_, side);
        std::sort(quad.begin(), quad.end());
        sides.push_back({{quad[1], quad[2], quad[3]}, side});
      }
      std::sort(sides.begin(), sides.end());
      const std::span<const SeamSide> all(sides);
      for (std::size_t i = 0; i < all.size();) {
        std::size_t next = i + 1;
        while (next < all.size() && all[next].others == all[i].others) ++next;
        good = match(all.subspan(i, next - i)) && good;
        i = next;
      }
    }
    return good;
  });
}

/// @param face  its sides
/// @return whether it has one or two that fit
bool MateFinder::match(std::span<const SeamSide> face) {
  const Index first = face.front().side;
  const Index last = face.back().side;
  result_.mates[placeOf(first)] = last;
  result_.mates[placeOf(last)] = first;
  return face.size() == 1 ||
         (face.size() == 2 && areOpposite(verticesOf(cells_, first), verticesOf(cells_, last)));
}

}  // namespace

std::optional<HexMates> findHexMates(std::size_t vertexCount, std::span<const Hex> cells,
                                     Stage& stage) {
  return MateFinder(vertexCount, cells, stage).find();
}

}  // namespace hexhex
