// Numbers hex vertices by owner and generator (Section 5.2).
#include <cassert>
#include <numeric>

#include <base/workspaces.hpp>
#include <sweep/vertex_numbers.hpp>

namespace hexhex::sweep {

namespace {

/// The proper simplices of a tet's boundary, by dimension, then corners.
constexpr std::array<lattice::CornerMask, 14> kBoundarySimplices = {1, 2,  4,  8, 3,  5,  6,
                                                                    9, 10, 12, 7, 11, 13, 14};

}  // namespace

std::uint64_t VertexNumbers::firstOf(Index owner, lattice::CornerMask simplex) const {
  assert(owner + std::size_t{1} < begin.size());
  std::uint64_t first = begin[owner];
  for (Index g = generatorBegin[owner]; g < generatorBegin[owner + 1]; ++g) {
    if (generators[g].simplex == simplex) return first;
    first += generators[g].count;
  }
  if (simplex == lattice::kWholeTet) return first;
  throw Error(ErrorCode::Internal,
              "A hex vertex is missing in the tet that owns it. The map passed all checks, so this "
              "is a bug; please report it with the map.",
              {PlaceKind::Tet, owner});
}

VertexCounter::VertexCounter(const igm::PreparedMap& map, VertexNumbers& numbers)
    : map_(map), numbers_(numbers), blocks_(blockCount(map.topology.tetCount(), kSweepBlock)) {
  numbers.begin.resize(map.topology.tetCount() + 1);
  numbers.generatorBegin.resize(map.topology.tetCount() + 1);
  numbers.begin.back() = 0;
  numbers.generatorBegin.back() = 0;
}

void VertexCounter::countSome(std::size_t block, Index tet,
                              std::span<const lattice::SweptLine> lines) {
  Block& counts = blocks_[block];
  const std::size_t generatorsBefore = counts.generators.size();
  std::uint64_t inside = 0;
  bool boundary = false;
  for (const lattice::SweptLine& line : lines) {
    if (line.allInside()) {
      inside += line.count;
    } else {
      boundary = true;
      if (line.left == lattice::kWholeTet) ++inside;
      if (line.count > 1 && line.right == lattice::kWholeTet) ++inside;
      if (line.count > 2 && line.inner() == lattice::kWholeTet) inside += line.count - 2;
    }
  }
  if (inside > 0) {
    ++counts.generatorCounts[3];
    counts.vertexCounts[3] += inside;
  }
  std::uint64_t owned = inside;
  if (boundary) {
    countBoundary(counts, tet, lines);
    for (std::size_t g = generatorsBefore; g < counts.generators.size(); ++g) {
      owned += counts.generators[g].count;
    }
  }
  numbers_.begin[tet] = owned;
  numbers_.generatorBegin[tet] = static_cast<Index>(counts.generators.size() - generatorsBefore);
}

void VertexCounter::countBoundary(Block& block, Index tet,
                                  std::span<const lattice::SweptLine> lines) {
  if (block.generators.empty()) block.generators.reserve(kSweepBlock / 4);
  std::array<Index, 16> counts{};
  for (const lattice::SweptLine& line : lines) {
    ++counts[line.left];
    if (line.count > 1) ++counts[line.right];
    if (line.count > 2) counts[line.inner()] += line.count - 2;
  }
  for (const lattice::CornerMask simplex : kBoundarySimplices) {
    if (counts[simplex] == 0 || !adjacency::ownsSimplex(map_.topology, tet, simplex)) continue;
    block.generators.push_back({counts[simplex], simplex});
    const auto kind = static_cast<std::size_t>(lattice::dimension(simplex));
    ++block.generatorCounts[kind];
    block.vertexCounts[kind] += counts[simplex];
  }
}

void VertexCounter::finish() {
  exclusiveScan(std::span(numbers_.begin));
  exclusiveScan(std::span(numbers_.generatorBegin));
  numbers_.generators.resize(numbers_.generatorBegin.back());
  auto place = numbers_.generators.begin();
  for (Block& block : blocks_) {
    place = std::copy(block.generators.begin(), block.generators.end(), place);
    for (std::size_t kind = 0; kind < 4; ++kind) {
      numbers_.generatorCounts[kind] += block.generatorCounts[kind];
      numbers_.vertexCounts[kind] += block.vertexCounts[kind];
    }
  }
  blocks_ = {};
  assert(place == numbers_.generators.end());
  assert(std::accumulate(numbers_.vertexCounts.begin(), numbers_.vertexCounts.end(),
                         std::uint64_t{0}) == numbers_.count());
}

SweptVertices sweepVertices(const igm::PreparedMap& map, Stage& stage, SweepObserver* observer,
                            double epsilon) {
  const std::size_t tets = map.topology.tetCount();
  SweptVertices swept{TetLines(tets), {}};
  VertexCounter counter(map, swept.numbers);
  parallelBlocksWith(
      stage, tets, kSweepBlock, [] { return BlockLines(true); },
      [&](std::size_t begin, std::size_t end, std::size_t block, BlockLines& lines) {
        lines.clear();
        for (std::size_t t = begin; t < end; ++t) {
          const auto tet = static_cast<Index>(t);
          lattice::TetRasterizer rasterizer(map.exact.corners[t], map.exact.unit, epsilon);
          rasterizer.append(lattice::kVertexGrid, lines.next());
          counter.count(block, tet, lines.last());
          if (observer != nullptr) observer->add(block, tet, rasterizer);
        }
        swept.lines.store(block, lines);
        lines.shrink();
      });
  counter.finish();
  return swept;
}

void TetNumbering::start(Counter& counter, lattice::CornerMask simplex) {
  const Index owner = adjacency::ownerTet(map_.topology, tet_, simplex);
  counter.known = true;
  counter.owned = owner == tet_;
  if (lattice::dimension(simplex) == 2 && !counter.owned) {
    counter.foreignFace = true;
    foreignFaces_ |= 1U << lattice::oppositeCorner(simplex);
    return;
  }
  const lattice::CornerMask there =
      counter.owned ? simplex : map_.topology.translated(simplex, tet_, owner);
  counter.next = numbers_.firstOf(owner, there);
  if (lattice::dimension(simplex) != 1 || !sweepsBackward(simplex)) return;
  counter.backward = true;
  for (Index g = numbers_.generatorBegin[owner]; g < numbers_.generatorBegin[owner + 1]; ++g) {
    if (numbers_.generators[g].simplex == there) counter.next += numbers_.generators[g].count - 1;
  }
}

/// Whether the sweep visits the points of an edge from the larger vertex to the smaller.
bool TetNumbering::sweepsBackward(lattice::CornerMask edge) const noexcept {
  const std::size_t a = lattice::firstCorner(edge);
  const std::size_t b = lattice::lastCorner(edge);
  const lattice::LatticeTet& corners = map_.exact.corners[tet_];
  const Tet& tet = map_.topology.tets[tet_];
  const lattice::LatticePoint along =
      tet[a] < tet[b] ? corners[b] - corners[a] : corners[a] - corners[b];
  for (const std::uint8_t axis : axes_()) {
    if (along[axis] != 0) return along[axis] < 0;
  }
  return false;
}

}  // namespace hexhex::sweep
