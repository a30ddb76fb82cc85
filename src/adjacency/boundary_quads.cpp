// Most neighbours number their corners alike, and find each other at once (aligned_cells.hpp). The
// other faces are paired by a hash table: first within a block of cells, small enough for the
// cache, as cells come in an order in which neighbours are close. What is left of the blocks is
// divided into parts by the hash and paired part by part. What is left then are the faces of which
// an odd number of cells have no such neighbour. Those that other cells have as well, which only
// broken meshes know, are sorted out in a last look.
#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include <adjacency/aligned_cells.hpp>
#include <adjacency/boundary_quads.hpp>
#include <adjacency/hex_topology.hpp>

#include <base/parallel.hpp>

namespace hexhex {
namespace {

// Large enough that few faces are left, small enough that the cells (256 KB) stay in the cache.
constexpr std::size_t kCellsPerBlock = std::size_t{1} << 13;
// Blocks that one thread handles with the same table, since fresh memory is slow.
constexpr std::size_t kBlocksPerTask = 16;
// Parts into which what is left is divided: a table for one of them is small again.
constexpr std::size_t kParts = 256;
// Cells per block of simple loops.
constexpr std::size_t kGrain = 4096;

// A face's key stands in the upper bits of a slot, its place within the block in the lower ones.
constexpr unsigned kLocalBits = 16;
static_assert(8 * kCellsPerBlock == std::size_t{1} << kLocalBits);
constexpr std::uint64_t kEven = std::uint64_t{1} << kLocalBits;
constexpr std::uint64_t kLocalMask = kEven - 1;
constexpr std::uint64_t kKeyMask = ~(kEven | kLocalMask);

/// A face of a cell. Different faces hardly ever have the same key, the same face always has.
struct Side {
  std::uint64_t key;    ///< within kKeyMask
  std::uint64_t place;  ///< 8 * cell + face
};

/// The keys of all faces of a cell: sums, so that the order of vertices does not matter, of
/// numbers without any pattern, so that sums of neighbouring vertices differ.
std::array<std::uint64_t, 6> keysOf(const Hex& cell) {
  std::array<std::uint64_t, 8> mixed;  // NOLINT(*-member-init): all of it is set
  for (std::size_t i = 0; i < 8; ++i) {
    std::uint64_t x = (cell[i] + std::uint64_t{1}) * 0x9e3779b97f4a7c15U;
    x ^= x >> 32U;
    mixed[i] = x * 0xc2b2ae3d27d4eb4fU;
  }
  std::array<std::uint64_t, 6> keys;  // NOLINT(*-member-init): all of it is set
  for (std::size_t f = 0; f < 6; ++f) {
    const auto& corners = kHexFaces[f];
    keys[f] =
        (mixed[corners[0]] + mixed[corners[1]] + mixed[corners[2]] + mixed[corners[3]]) & kKeyMask;
  }
  return keys;
}

std::size_t partOf(std::uint64_t key) { return (key >> (kLocalBits + 1)) % kParts; }

/// Whether two places name faces with the same four vertices.
bool isSameFace(std::span<const Hex> cells, std::uint64_t a, std::uint64_t b) {
  Quad here = faceVertices(cells[a / 8], a % 8);
  Quad there = faceVertices(cells[b / 8], b % 8);
  // Almost always: the same loop in the other direction.
  const std::size_t start = (there[1] == here[0] ? 1U : 0U) + (there[2] == here[0] ? 2U : 0U) +
                            (there[3] == here[0] ? 3U : 0U);
  if (there[start % 4] == here[0] && there[(start + 3) % 4] == here[1] &&
      there[(start + 2) % 4] == here[2] && there[(start + 1) % 4] == here[3]) {
    return true;
  }
  std::sort(here.begin(), here.end());
  std::sort(there.begin(), there.end());
  return here == there;
}

/// Whether the faces of a cell are known to be another cell's, too; one byte each, so that threads
/// need not wait for each other. The last two are never set.
using Marks = std::array<std::uint8_t, 8>;
constexpr auto kAllShared = std::bit_cast<std::uint64_t>(Marks{1, 1, 1, 1, 1, 1, 0, 0});

/// Marks the faces of neighbours that number their corners alike.
Array<Marks> markAligned(const HexMesh& mesh, const AlignedCells& aligned, Stage& stage) {
  Array<Marks> array(mesh.cells.size());
  const std::span<Marks> marks(array);
  parallelBlocks(stage, marks.size(), kGrain,
                 [marks](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   std::fill(marks.begin() + static_cast<std::ptrdiff_t>(begin),
                             marks.begin() + static_cast<std::ptrdiff_t>(end), Marks{});
                 });
  const auto mark = [marks](std::size_t cell, std::size_t face) {
    std::atomic_ref(marks[cell][face]).store(1, std::memory_order_relaxed);
  };
  const auto markPairs = [&mark](std::size_t c, const std::array<Index, 3>& behind) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (behind[axis] == kNone) continue;
      mark(c, 2 * axis + 1);
      mark(behind[axis], 2 * axis);
    }
  };
  parallelBlocks(stage, marks.size(), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   aligned.forEach(begin, end, markPairs);
                 });
  return array;
}

/// The faces of one block of cells, with open addressing; knows for each face whether it was added
/// an odd number of times.
class BlockTable {
 public:
  BlockTable() : slots_(kSlots, kFree) { used_.reserve(kSlots); }

  /// Adds what is not marked.
  /// @param block  its cells, with their marks
  void add(std::span<const Hex> block, std::span<const Marks> marks) {
    for (std::size_t c = 0; c < block.size(); ++c) {
      if (std::bit_cast<std::uint64_t>(marks[c]) == kAllShared) continue;
      const std::array<std::uint64_t, 6> keys = keysOf(block[c]);
      for (std::size_t f = 0; f < 6; ++f) {
        if (marks[c][f] == 0) add(block, keys[f], 8 * c + f);
      }
    }
  }

  /// Calls f(side) for the first side of every face that was added an odd number of times, with its
  /// place in the block, in no useful order, and empties the table.
  template <class F>
  void takeOdd(const F& f) {
    for (const std::uint16_t i : used_) {
      const std::uint64_t slot = slots_[i];
      if ((slot & kEven) == 0) f(Side{slot & kKeyMask, slot & kLocalMask});
      slots_[i] = kFree;
    }
    used_.clear();
  }

 private:
  // All faces of a block are three quarters of it.
  static constexpr std::size_t kSlots = std::size_t{1} << kLocalBits;
  static constexpr std::uint64_t kFree = ~std::uint64_t{0};  // no cell has a face 7

  void add(std::span<const Hex> block, std::uint64_t key, std::uint64_t local) {
    std::size_t i = key >> (64 - kLocalBits);
    while (slots_[i] != kFree) {
      const std::uint64_t slot = slots_[i];
      if (((slot ^ key) & kKeyMask) == 0 && isSameFace(block, slot & kLocalMask, local)) {
        slots_[i] = slot ^ kEven;
        return;
      }
      i = (i + 1) % kSlots;
    }
    slots_[i] = key | local;
    used_.push_back(static_cast<std::uint16_t>(i));
  }

  std::vector<std::uint64_t> slots_;
  std::vector<std::uint16_t> used_;  ///< in the order of first use
};

/// The same for sides from anywhere.
class SideTable {
 public:
  /// @param capacity  the most sides that are added
  SideTable(std::span<const Hex> cells, std::size_t capacity)
      : cells_(cells),
        slots_(std::bit_ceil(capacity + capacity / 4 + 2), Side{0, kFree}),
        shift_(64 - static_cast<unsigned>(std::countr_zero(slots_.size()))) {}

  void add(const Side& side) {
    std::size_t i = side.key >> shift_;
    while (slots_[i].place != kFree) {
      if (slots_[i].key == side.key && isSameFace(cells_, slots_[i].place & ~kSeen, side.place)) {
        slots_[i].place ^= kSeen;
        return;
      }
      i = (i + 1) & (slots_.size() - 1);
    }
    slots_[i] = side;
  }

  template <class F>
  void forEachOdd(const F& f) const {
    for (const Side& side : slots_) {
      if ((side.place & kSeen) == 0) f(side);
    }
  }

 private:
  static constexpr std::uint64_t kSeen = std::uint64_t{1} << 63U;
  static constexpr std::uint64_t kFree = ~std::uint64_t{0};  // has the bit of kSeen, too

  std::span<const Hex> cells_;
  std::vector<Side> slots_;
  unsigned shift_;
};

/// What is left of the cells of one task.
struct Remains {
  std::vector<Side> sides;
  std::array<std::uint64_t, kParts> begins{};  ///< counts by part; later where each part goes
};

Remains pairWithinBlocks(std::span<const Hex> cells, std::span<const Marks> marks,
                         std::size_t begin, std::size_t end) {
  Remains remains;
  BlockTable table;
  for (std::size_t first = begin; first < end; first += kCellsPerBlock) {
    const std::size_t count = std::min(kCellsPerBlock, end - first);
    table.add(cells.subspan(first, count), marks.subspan(first, count));
    table.takeOdd([&remains, first](const Side& side) {
      remains.sides.push_back({side.key, 8 * first + side.place});
      ++remains.begins[partOf(side.key)];
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
    for (const Side& side : tasks[i].sides) {
      parts.sides[tasks[i].begins[partOf(side.key)]++] = side;
    }
    tasks[i].sides = {};
  });
  return parts;
}

/// One side of each face that is unmarked an odd number of times, sorted by key within each part.
using OddSides = std::array<std::vector<Side>, kParts>;

OddSides findOddSides(const HexMesh& mesh, std::span<const Marks> marks, Stage& stage) {
  constexpr std::size_t kCellsPerTask = kCellsPerBlock * kBlocksPerTask;
  std::vector<Remains> tasks(blockCount(mesh.cells.size(), kCellsPerTask));
  parallelBlocks(stage, mesh.cells.size(), kCellsPerTask,
                 [&](std::size_t begin, std::size_t end, std::size_t task) {
                   tasks[task] = pairWithinBlocks(mesh.cells, marks, begin, end);
                 });
  Parts parts = gather(tasks, stage);
  OddSides odd;
  parallelFor(stage, kParts, 1, [&](std::size_t i) {
    const std::span<const Side> part = parts.part(i);
    SideTable table(mesh.cells, part.size());
    for (const Side& side : part) table.add(side);
    table.forEachOdd([&odd, i](const Side& side) { odd[i].push_back(side); });
    std::sort(odd[i].begin(), odd[i].end(),
              [](const Side& a, const Side& b) { return a.key < b.key; });
  });
  return odd;
}

/// Counts the unmarked sides of faces that are known to have an odd number of them.
class SideCounter {
 public:
  SideCounter(const HexMesh& mesh, std::span<const Marks> marks, const OddSides& sides,
              Stage& stage)
      : cells_(mesh.cells), marks_(marks), sides_(sides) {
    isCorner_.assign(mesh.points.size(), 0);
    for (std::size_t part = 0; part < kParts; ++part) {
      counts_[part].assign(sides_[part].size(), 0);
      for (const Side& side : sides_[part]) {
        for (const Index v : faceVertices(cells_[side.place / 8], side.place % 8)) isCorner_[v] = 1;
      }
    }
    parallelFor(stage, cells_.size(), kGrain, [&](std::size_t c) { addCell(c); });
  }

  /// Number of unmarked sides that are the same face as the i-th side of a part.
  [[nodiscard]] std::uint32_t count(std::size_t part, std::size_t i) const {
    return counts_[part][i];
  }

 private:
  void addCell(std::size_t c) {
    if (std::bit_cast<std::uint64_t>(marks_[c]) == kAllShared) return;
    for (std::size_t f = 0; f < 6; ++f) {
      if (marks_[c][f] != 0) continue;
      const Quad quad = faceVertices(cells_[c], f);
      // Most sides that are paired are not near those that are left, which take a search.
      if (isCorner_[quad[0]] + isCorner_[quad[1]] + isCorner_[quad[2]] + isCorner_[quad[3]] == 4) {
        addFace({keysOf(cells_[c])[f], 8 * c + f});
      }
    }
  }
  void addFace(const Side& side) {
    const std::size_t part = partOf(side.key);
    const std::vector<Side>& sides = sides_[part];
    const auto first =
        std::lower_bound(sides.begin(), sides.end(), side.key,
                         [](const Side& known, std::uint64_t key) { return known.key < key; });
    for (auto found = first; found != sides.end() && found->key == side.key; ++found) {
      if (!isSameFace(cells_, found->place, side.place)) continue;
      const auto i = static_cast<std::size_t>(found - sides.begin());
      std::atomic_ref(counts_[part][i]).fetch_add(1, std::memory_order_relaxed);
    }
  }

  std::span<const Hex> cells_;
  std::span<const Marks> marks_;
  const OddSides& sides_;
  Array<std::uint8_t> isCorner_;  ///< per vertex: whether it belongs to a side
  std::array<std::vector<std::uint32_t>, kParts> counts_;
};

/// Whether a side is a marked face of others: of these, one knows its corner 0 to be there.
bool isAlignedFace(std::span<const Hex> cells, std::span<const Marks> marks,
                   const AlignedCells& aligned, std::uint64_t place) {
  const Quad quad = faceVertices(cells[place / 8], place % 8);
  return std::any_of(quad.begin(), quad.end(), [&](Index vertex) {
    const Index cell = aligned.at(vertex);
    if (cell == kNone) return false;
    bool found = false;
    for (std::size_t face = 0; face < 6; face += 2) {
      found = found ||
              (marks[cell][face] != 0 && isSameFace(cells, 8 * std::uint64_t{cell} + face, place));
    }
    return found;
  });
}

}  // namespace

Array<std::uint64_t> boundaryPlaces(const HexMesh& mesh, Stage& stage) {
  const AlignedCells aligned(mesh.points.size(), mesh.cells, stage);
  const Array<Marks> marks = markAligned(mesh, aligned, stage);
  const OddSides sides = findOddSides(mesh, marks, stage);
  const SideCounter counter(mesh, marks, sides, stage);
  Array<std::uint64_t> places;
  for (std::size_t part = 0; part < kParts; ++part) {
    for (std::size_t i = 0; i < sides[part].size(); ++i) {
      const std::uint64_t place = sides[part][i].place;
      if (counter.count(part, i) == 1 && !isAlignedFace(mesh.cells, marks, aligned, place)) {
        places.push_back(place);
      }
    }
  }
  std::sort(places.begin(), places.end());
  return places;
}

Array<Quad> quadsAt(const HexMesh& mesh, std::span<const std::uint64_t> places) {
  Array<Quad> quads(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    quads[i] = faceVertices(mesh.cells[places[i] / 8], places[i] % 8);
  }
  return quads;
}

Array<Quad> boundaryQuads(const HexMesh& mesh, Stage& stage) {
  return quadsAt(mesh, boundaryPlaces(mesh, stage));
}

}  // namespace hexhex
