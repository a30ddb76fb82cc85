#include "campaign/block_map.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

#include <base/disjoint_sets.hpp>
#include <base/vector3.hpp>
#include <lattice/charts_along_trees.hpp>
#include <samples/steps.hpp>
#include <samples/tet_grid.hpp>

#include "campaign/variations.hpp"

namespace hexhex::campaign {

namespace {

using samples::BlockComplex;
using samples::BlockPart;
using samples::CoarseCell;
using samples::Int3;
using samples::kUnitsPerCell;
using samples::Neighbour;
using samples::Occurrence;
using samples::TetGrid;

/// Most maps are small, so that many are tried: what is rare is so in their structure.
struct Limits {
  std::uint64_t tets = 0;
  std::uint64_t cells = 0;
};

Limits drawLimits(Random& random) {
  const std::uint64_t choice = random.below(50);
  if (choice == 0) return {4000, 6000};
  if (choice < 7) return {800, 800};
  return {60, 60};
}

/// Per block and axis: a factor for the number of cells along it. Equal where blocks meet.
using Lengths = std::vector<std::array<std::int64_t, 3>>;

/// Per block and axis: the sheet of blocks that it crosses, by any number.
std::vector<std::array<Index, 3>> sheetsOf(const BlockComplex& complex) {
  DisjointSets sets(3 * complex.blockCount());
  const auto number = [](std::size_t block, std::size_t axis) {
    return static_cast<Index>(3 * block + axis);
  };
  for (std::size_t block = 0; block < complex.blockCount(); ++block) {
    for (std::size_t face = 0; face < 6; ++face) {
      const auto other = complex.neighbour(block, face / 2, static_cast<int>(face % 2));
      if (!other) continue;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (axis == face / 2) continue;
        const lattice::Direction there =
            other->transition(lattice::direction(static_cast<int>(axis), 1));
        sets.unite(number(block, axis),
                   number(other->block, static_cast<std::size_t>(lattice::axisOf(there))));
      }
    }
  }
  std::vector<std::array<Index, 3>> sheets(complex.blockCount());
  for (std::size_t block = 0; block < sheets.size(); ++block) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      sheets[block][axis] = sets.find(number(block, axis));
  }
  return sheets;
}

std::uint64_t cellsOf(const Lengths& lengths, std::uint64_t cells) {
  std::uint64_t sum = 0;
  for (const auto& length : lengths) {
    std::uint64_t product = 1;
    for (const std::int64_t factor : length) product *= cells * static_cast<std::uint64_t>(factor);
    sum += product;
  }
  return sum;
}

/// Mostly 1; sometimes a sheet becomes some times as long, sometimes thousands of times.
Lengths drawLengths(const BlockComplex& complex, std::uint64_t cells, std::uint64_t most,
                    Random& random) {
  Lengths lengths(complex.blockCount(), {1, 1, 1});
  const std::vector<std::array<Index, 3>> sheets = sheetsOf(complex);
  const std::size_t changes = random.below(4);
  for (std::size_t i = 0; i < changes; ++i) {
    const Index sheet = sheets[random.below(sheets.size())][random.below(3)];
    const auto factor =
        static_cast<std::int64_t>(2 + random.below(random.below(6) == 0 ? 3000 : 4));
    Lengths longer = lengths;
    for (std::size_t block = 0; block < sheets.size(); ++block) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (sheets[block][axis] == sheet) longer[block][axis] *= factor;
      }
    }
    if (cellsOf(longer, cells) <= most) lengths = std::move(longer);
  }
  return lengths;
}

/// The transition between two blocks that are unit cubes, for boxes.
/// @param here, there  lengths of both
lattice::Transition stretched(const lattice::Transition& across, std::size_t axis, int side,
                              const std::array<std::int64_t, 3>& here,
                              const std::array<std::int64_t, 3>& there) {
  lattice::GridPoint corner{};
  corner[axis] = side;
  lattice::GridPoint image = across(corner);
  for (std::size_t a = 0; a < 3; ++a) {
    corner[a] *= static_cast<std::int32_t>(here[a]);
    image[a] *= static_cast<std::int32_t>(there[a]);
  }
  return lattice::Transition::taking(corner, image, across.rotation);
}

/// Per block: the chart in which most neighbours agree.
std::vector<lattice::Transition> alignedCharts(const BlockComplex& complex, const Lengths& boxes) {
  const auto forEachNeighbour = [&](Index block, const auto& visit) {
    for (std::size_t face = 0; face < 6; ++face) {
      const int side = static_cast<int>(face % 2);
      const std::optional<Neighbour> other = complex.neighbour(block, face / 2, side);
      if (!other) continue;
      visit(static_cast<Index>(other->block), [&](const lattice::Transition& chart) {
        return chart *
               stretched(other->transition, face / 2, side, boxes[block], boxes[other->block])
                   .inverse();
      });
    }
  };
  return lattice::chartsAlongTrees<lattice::Transition>(complex.blockCount(), forEachNeighbour)
      .motions;
}

/// The tets of a grid: of each sub-block 12 around its centre, or 6 from one corner.
class TetWriter {
 public:
  TetWriter(const TetGrid& grid, const Lengths& lengths, std::vector<lattice::Transition> charts,
            double shareOfSix, Random& random)
      : grid_(grid),
        lengths_(lengths),
        charts_(std::move(charts)),
        shareOfSix_(shareOfSix),
        random_(random) {}

  void write(TetMap& map, bool withRegions) {
    for (std::size_t sub = 0; sub < grid_.subBlockCount(); ++sub) {
      if (random_.share() >= shareOfSix_ || !writeFromCorner(sub, map)) writeAroundCentre(sub, map);
      if (withRegions) {
        map.regions.resize(map.tets.size(),
                           static_cast<std::int32_t>(sub / grid_.subBlocksPerBlock() + 1));
      }
    }
  }

 private:
  void writeAroundCentre(std::size_t sub, TetMap& map) {
    const std::array<Index, 8> vertices = grid_.cornerVertices(sub);
    for (const samples::SurfaceTriangle& t : samples::surfaceTriangles(vertices)) {
      add(sub, {grid_.centreVertex(sub), vertices[t[0]], vertices[t[1]], vertices[t[2]]},
          {grid_.centreParameters[sub], cornerOf(sub, t[0]), cornerOf(sub, t[1]),
           cornerOf(sub, t[2])},
          map);
    }
  }

  /// From the corner at which three faces are cut: the smallest one.
  /// @return whether the tets are positive; otherwise nothing is written
  bool writeFromCorner(std::size_t sub, TetMap& map) {
    const std::array<Index, 8> vertices = grid_.cornerVertices(sub);
    const auto apex = static_cast<std::size_t>(std::min_element(vertices.begin(), vertices.end()) -
                                               vertices.begin());
    const std::array<Vec3, 8> corners = grid_.cornersInMap(sub);
    const double side =
        static_cast<double>(grid_.cells() * kUnitsPerCell) / static_cast<double>(grid_.refine());
    std::vector<samples::SurfaceTriangle> triangles;
    for (const samples::SurfaceTriangle& t : samples::surfaceTriangles(vertices)) {
      if (std::find(t.begin(), t.end(), apex) != t.end()) continue;
      const double volume =
          tripleProduct(minus(corners[t[0]], corners[apex]), minus(corners[t[1]], corners[apex]),
                        minus(corners[t[2]], corners[apex]));
      constexpr double kLeastShare = 1e-6;  // as of jitter
      if (volume < kLeastShare * side * side * side) return false;
      triangles.push_back(t);
    }
    for (const samples::SurfaceTriangle& t : triangles) {
      add(sub, {vertices[apex], vertices[t[0]], vertices[t[1]], vertices[t[2]]},
          {cornerOf(sub, apex), cornerOf(sub, t[0]), cornerOf(sub, t[1]), cornerOf(sub, t[2])},
          map);
    }
    return true;
  }

  [[nodiscard]] Int3 cornerOf(std::size_t sub, std::size_t corner) const {
    return grid_.cornerParameters(sub)[corner];
  }

  void add(std::size_t sub, const Tet& tet, std::array<Int3, 4> corners, TetMap& map) const {
    const std::size_t block = sub / grid_.subBlocksPerBlock();
    TetParameters parameters{};
    for (std::size_t c = 0; c < 4; ++c) {
      for (std::size_t a = 0; a < 3; ++a) corners[c][a] *= lengths_[block][a];
      corners[c] = charts_[block](corners[c], kUnitsPerCell);
      for (std::size_t a = 0; a < 3; ++a) {
        parameters[c][a] = static_cast<double>(corners[c][a]) / double{kUnitsPerCell};
      }
    }
    map.tets.push_back(tet);
    map.parameters.push_back(parameters);
  }

  const TetGrid& grid_;
  const Lengths& lengths_;
  std::vector<lattice::Transition> charts_;
  double shareOfSix_;
  Random& random_;
};

/// What follows from the blocks and the numbers of cells along them.
SampleAnswer answerOf(const BlockComplex& complex, const Lengths& boxes, bool features) {
  const std::int64_t first = boxes[0][0];
  const bool uniform = std::all_of(boxes.begin(), boxes.end(), [first](const auto& box) {
    return box == std::array{first, first, first};
  });
  SampleAnswer answer =
      samples::expectedAnswer(complex, static_cast<std::uint64_t>(first), features && uniform);
  if (uniform) return answer;
  Expectation& expected = answer.expected;
  answer.vertices = expected.cells = expected.boundaryQuads = 0;
  expected.innerSingularEdges.clear();
  expected.boundarySingularEdges.clear();
  for (const CoarseCell& cell : complex.cells()) {
    const Occurrence& at = cell.occurrences.front();
    std::uint64_t inside = 1;
    std::uint64_t elements = 1;
    for (std::size_t a = 0; a < 3; ++a) {
      if (at.part.digits[a] != BlockPart::kAlong) continue;
      inside *= static_cast<std::uint64_t>(boxes[at.block][a] - 1);
      elements *= static_cast<std::uint64_t>(boxes[at.block][a]);
    }
    answer.vertices += inside;
    if (cell.dimension == 3) expected.cells += elements;
    if (cell.dimension == 2 && cell.boundary) expected.boundaryQuads += elements;
    if (cell.dimension == 1 && cell.singular()) {
      auto& singular = cell.boundary ? expected.boundarySingularEdges : expected.innerSingularEdges;
      singular[cell.valence()] += elements;
    }
  }
  return answer;
}

/// Whether two vertices span the same edge or diagonal wherever they are in one block. If not, tets
/// of undivided blocks would meet where blocks do not.
bool arePairsUnique(const BlockComplex& complex, const std::vector<samples::BlockCorners>& blocks) {
  std::map<std::pair<Index, Index>, std::size_t> cellOfPair;
  for (std::size_t block = 0; block < blocks.size(); ++block) {
    for (std::size_t a = 0; a < 8; ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        BlockPart part;
        for (std::size_t k = 0; k < 3; ++k) {
          const auto digit = static_cast<int>(a >> k & 1);
          part.digits[k] = ((a ^ b) >> k & 1) == 1 ? BlockPart::kAlong : digit;
        }
        const std::size_t cell = complex.find(block, part).cell;
        const auto pair = std::minmax(blocks[block][a], blocks[block][b]);
        if (cellOfPair.try_emplace(pair, cell).first->second != cell) return false;
      }
    }
  }
  return true;
}

/// A number up to the largest one, at most `most`, for which the map stays small.
int drawWithin(std::size_t blocks, std::uint64_t perBlock, std::uint64_t limit, std::uint64_t most,
               Random& random) {
  std::uint64_t largest = 1;
  while (largest < most &&
         blocks * perBlock * samples::power(static_cast<std::int64_t>(largest + 1), 3) <= limit) {
    ++largest;
  }
  return static_cast<int>(1 + random.below(largest));
}

}  // namespace

DrawnMap drawBlockMap(Random& random) {
  const BlockStructure structure = drawBlockStructure(random);
  const BlockComplex complex(structure.model.blocks);
  const bool manifold = isManifold(complex);
  DrawnMap drawn{structure.kind + (manifold ? "" : ", not manifold"), {}, {}};

  const std::size_t blocks = complex.blockCount();
  const Limits limits = drawLimits(random);
  const int cells = drawWithin(blocks, 1, limits.cells, 8, random);
  const int least = arePairsUnique(complex, structure.model.blocks) ? 1 : 2;
  const int refine = std::max(least, drawWithin(blocks, 12, limits.tets, 5, random));
  TetGrid grid(structure.model, complex, cells, refine);
  constexpr std::array kJitter = {0.0, 0.1, 0.5, 1.0};
  constexpr std::array kOnLattice = {0.0, 0.0, 0.3, 1.0};
  const double jitter = kJitter[random.below(kJitter.size())];
  const double onLattice = kOnLattice[random.below(kOnLattice.size())];
  if (jitter > 0 && manifold) samples::jitter(grid, complex, jitter, 0, random.next());
  if (onLattice > 0 && manifold) {
    samples::roundToLattice(grid, complex, onLattice, 0, random.next());
  }

  // Moved vertices may be beyond the face of a block, where its own length does not count.
  Lengths lengths(blocks, {1, 1, 1});
  if (manifold && jitter == 0 && onLattice == 0)
    lengths = drawLengths(complex, static_cast<std::uint64_t>(cells), limits.cells, random);
  Lengths boxes = lengths;
  for (auto& box : boxes) {
    for (std::int64_t& length : box) length *= cells;
  }
  std::vector<lattice::Transition> charts(blocks);
  if (random.below(2) == 0) {
    charts = alignedCharts(complex, boxes);
  } else {
    for (lattice::Transition& chart : charts) chart = drawChart(20, random);
  }
  const bool tagged = manifold && random.below(3) == 0;
  if (tagged) samples::addFeatures(grid, complex, drawn.map);
  drawn.map.regions.clear();
  constexpr std::array kShareOfSix = {0.0, 0.5, 1.0};
  TetWriter writer(grid, lengths, std::move(charts), kShareOfSix[random.below(3)], random);
  writer.write(drawn.map, tagged);
  drawn.map.points = std::move(grid.points);
  if (manifold) drawn.answer = answerOf(complex, boxes, tagged);
  return drawn;
}

}  // namespace hexhex::campaign
