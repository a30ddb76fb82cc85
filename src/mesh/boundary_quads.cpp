// Cells come in an order in which neighbours are close. So a block of cells, small enough for a
// table in the cache, pairs most of its faces. What is left of the blocks is divided into parts by
// a hash and paired part by part. What is left then are the faces with an odd number of cells, and
// those with three or more of them, which only broken meshes have, are sorted out in a last look.
#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include <base/parallel.hpp>
#include <mesh/boundary_quads.hpp>
#include <mesh/hex_topology.hpp>

namespace hexhex {
namespace {

// Large enough that few faces are left, small enough that the table (1.5 MB) stays in the cache.
constexpr std::size_t kCellsPerBlock = std::size_t{1} << 13;
// Blocks that one thread handles with the same table, since fresh memory is slow.
constexpr std::size_t kBlocksPerTask = 16;
// Parts into which what is left is divided: a table for one of them is small again.
constexpr std::size_t kParts = 256;
// Cells per block of simple loops.
constexpr std::size_t kGrain = 4096;

/// A face of a cell. Vertices tell faces apart, the place tells where it was seen.
struct Side {
  std::uint64_t low;    ///< the two smallest vertices, the smaller one in the upper half
  std::uint64_t high;   ///< the two others in the same way
  std::uint64_t place;  ///< 8 * cell + face
};

bool sameFace(const Side& a, const Side& b) { return a.low == b.low && a.high == b.high; }

bool before(const Side& a, const Side& b) {
  return a.low != b.low ? a.low < b.low : a.high < b.high;
}

/// Sorts the four vertices without branches.
Side sideOf(const Quad& quad, std::uint64_t place) {
  const Index a = std::min(quad[0], quad[1]);
  const Index b = std::max(quad[0], quad[1]);
  const Index c = std::min(quad[2], quad[3]);
  const Index d = std::max(quad[2], quad[3]);
  const Index e = std::max(a, c);
  const Index f = std::min(b, d);
  const auto joined = [](Index upper, Index lower) { return std::uint64_t{upper} << 32U | lower; };
  return {joined(std::min(a, c), std::min(e, f)), joined(std::max(e, f), std::max(b, d)), place};
}

std::uint64_t hashOf(const Side& side) {
  // Odd constants without pattern; the products' upper halves depend on all bits.
  const std::uint64_t low = side.low * 0x9e3779b97f4a7c15U;
  const std::uint64_t high = side.high * 0xc2b2ae3d27d4eb4fU;
  const std::uint64_t sum = low ^ (high >> 29U) ^ high;
  return (sum ^ (sum >> 32U)) * 0x94d049bb133111ebU;
}

/// The hash's lowest bits: the place in a table depends on the highest.
std::size_t partOf(const Side& side) { return hashOf(side) % kParts; }

/// A set of faces with open addressing, which knows for each whether it was added an odd number of
/// times.
class FaceTable {
 public:
  /// @param capacity  the most sides that are added
  explicit FaceTable(std::size_t capacity)
      : slots_(std::bit_ceil(capacity + capacity / 4 + 2), Side{0, 0, kFree}),
        shift_(64 - static_cast<unsigned>(std::countr_zero(slots_.size()))) {}

  void add(const Side& side) {
    std::size_t slot = hashOf(side) >> shift_;
    while (slots_[slot].place != kFree) {
      if (sameFace(slots_[slot], side)) {
        slots_[slot].place ^= kEven;
        return;
      }
      slot = (slot + 1) & (slots_.size() - 1);
    }
    slots_[slot] = side;
  }

  /// Calls f(side) for the first side of every face that was added an odd number of times, in no
  /// useful order, and empties the table.
  template <class F>
  void takeOdd(const F& f) {
    for (Side& side : slots_) {
      if ((side.place & kEven) == 0) f(side);
      side.place = kFree;
    }
  }

 private:
  static constexpr std::uint64_t kEven = std::uint64_t{1} << 63U;
  static constexpr std::uint64_t kFree = ~std::uint64_t{0};  // has the bit of kEven, too

  std::vector<Side> slots_;
  unsigned shift_;
};

/// What is left of the cells of one task.
struct Remains {
  std::vector<Side> sides;
  std::array<std::uint64_t, kParts> begins{};  ///< counts by part; later where each part goes
};

Remains pairWithinBlocks(const HexMesh& mesh, std::size_t begin, std::size_t end) {
  Remains remains;
  FaceTable table(6 * std::min(kCellsPerBlock, end - begin));
  for (std::size_t block = begin; block < end; block += kCellsPerBlock) {
    for (std::size_t c = block; c < std::min(block + kCellsPerBlock, end); ++c) {
      for (std::size_t f = 0; f < 6; ++f) {
        table.add(sideOf(faceVertices(mesh.cells[c], f), 8 * c + f));
      }
    }
    table.takeOdd([&remains](const Side& side) {
      remains.sides.push_back(side);
      ++remains.begins[partOf(side)];
    });
  }
  return remains;
}

/// Sides by part: those of part i begin at begins[i] and end at begins[i + 1].
struct Parts {
  Array<Side> sides;
  std::array<std::uint64_t, kParts + 1> begins{};

  [[nodiscard]] std::span<Side> part(std::size_t i) {
    return std::span(sides).subspan(begins[i], begins[i + 1] - begins[i]);
  }
};

/// Gathers what is left of all tasks, part by part.
Parts gather(std::vector<Remains>& tasks, Stage& stage) {
  Parts parts;
  std::uint64_t sum = 0;
  for (std::size_t part = 0; part < kParts; ++part) {
    parts.begins[part] = sum;
    for (Remains& task : tasks) {
      const std::uint64_t count = task.begins[part];
      task.begins[part] = sum;
      sum += count;
    }
  }
  parts.begins[kParts] = sum;
  parts.sides.resize(sum);
  parallelFor(stage, tasks.size(), 1, [&](std::size_t i) {
    for (const Side& side : tasks[i].sides) parts.sides[tasks[i].begins[partOf(side)]++] = side;
    tasks[i].sides = {};
  });
  return parts;
}

/// One side of each face with an odd number of cells, sorted within each part.
using OddSides = std::array<std::vector<Side>, kParts>;

OddSides findOddSides(const HexMesh& mesh, Stage& stage) {
  constexpr std::size_t kCellsPerTask = kCellsPerBlock * kBlocksPerTask;
  std::vector<Remains> tasks(blockCount(mesh.cells.size(), kCellsPerTask));
  parallelBlocks(stage, mesh.cells.size(), kCellsPerTask,
                 [&](std::size_t begin, std::size_t end, std::size_t task) {
                   tasks[task] = pairWithinBlocks(mesh, begin, end);
                 });
  Parts parts = gather(tasks, stage);
  OddSides odd;
  parallelFor(stage, kParts, 1, [&](std::size_t i) {
    const std::span<const Side> part = parts.part(i);
    FaceTable table(part.size());
    for (const Side& side : part) table.add(side);
    table.takeOdd([&odd, i](const Side& side) { odd[i].push_back(side); });
    std::sort(odd[i].begin(), odd[i].end(), before);
  });
  return odd;
}

/// Counts the cells of faces that are known to have an odd number of them.
class CellCounter {
 public:
  CellCounter(const HexMesh& mesh, const OddSides& sides, Stage& stage) : sides_(sides) {
    isCorner_.resize(mesh.points.size());
    std::fill(isCorner_.begin(), isCorner_.end(), std::uint8_t{0});
    for (std::size_t part = 0; part < kParts; ++part) {
      counts_[part].assign(sides_[part].size(), 0);
      for (const Side& side : sides_[part]) {
        for (const std::uint64_t pair : {side.low, side.high}) {
          isCorner_[pair >> 32U] = isCorner_[static_cast<Index>(pair)] = 1;
        }
      }
    }
    parallelFor(stage, mesh.cells.size(), kGrain, [&](std::size_t c) { addCell(mesh.cells[c]); });
  }

  /// Number of cells that have the i-th side of a part.
  [[nodiscard]] std::uint32_t count(std::size_t part, std::size_t i) const {
    return counts_[part][i];
  }

 private:
  void addCell(const Hex& cell) {
    unsigned corners = 0;
    for (const Index v : cell) corners += isCorner_[v];
    if (corners < 4) return;
    for (std::size_t f = 0; f < 6; ++f) {
      const Quad quad = faceVertices(cell, f);
      if (isCorner_[quad[0]] + isCorner_[quad[1]] + isCorner_[quad[2]] + isCorner_[quad[3]] == 4) {
        addFace(sideOf(quad, 0));
      }
    }
  }
  void addFace(const Side& side) {
    const std::size_t part = partOf(side);
    const std::vector<Side>& sides = sides_[part];
    const auto found = std::lower_bound(sides.begin(), sides.end(), side, before);
    if (found == sides.end() || !sameFace(*found, side)) return;
    const auto i = static_cast<std::size_t>(found - sides.begin());
    std::atomic_ref(counts_[part][i]).fetch_add(1, std::memory_order_relaxed);
  }

  const OddSides& sides_;
  Array<std::uint8_t> isCorner_;  ///< per vertex: whether it belongs to a side
  std::array<std::vector<std::uint32_t>, kParts> counts_;
};

}  // namespace

Array<Quad> boundaryQuads(const HexMesh& mesh, Stage& stage) {
  const OddSides sides = findOddSides(mesh, stage);
  const CellCounter counter(mesh, sides, stage);
  std::vector<std::uint64_t> places;
  for (std::size_t part = 0; part < kParts; ++part) {
    for (std::size_t i = 0; i < sides[part].size(); ++i) {
      if (counter.count(part, i) == 1) places.push_back(sides[part][i].place);
    }
  }
  std::sort(places.begin(), places.end());
  Array<Quad> quads(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    quads[i] = faceVertices(mesh.cells[places[i] / 8], places[i] % 8);
  }
  return quads;
}

}  // namespace hexhex
