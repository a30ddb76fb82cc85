// Draws the charts and writes the tets of every sub-block.
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include <base/disjoint_sets.hpp>
#include <base/random.hpp>
#include <lattice/charts_along_trees.hpp>
#include <samples/steps.hpp>

namespace hexhex::samples {

namespace {

/// Translations are drawn from [-20, 20] unless an offset is given: small enough to read, large
/// enough that hardly any is zero.
constexpr std::int64_t kSmallOffset = 20;
/// Independent streams of random numbers.
constexpr std::uint64_t kChartStream = 3;
constexpr std::uint64_t kNoiseStream = 4;
constexpr std::uint64_t kStretchStream = 6;

/// Translations of random charts are drawn from [-limit, limit].
std::int64_t translationLimit(const SampleOptions& options) {
  return options.offset >= 1 ? static_cast<std::int64_t>(options.offset) : kSmallOffset;
}

lattice::GridPoint randomTranslation(std::int64_t limit, Random& random) {
  lattice::GridPoint translation{};
  for (auto& coordinate : translation) {
    coordinate = static_cast<std::int32_t>(random.integerUpTo(limit));
  }
  return translation;
}

lattice::Transition randomChart(std::int64_t limit, Random& random) {
  // Numbered by the image of the +x axis, the image of the +y axis, and the two signs.
  const auto number = static_cast<int>(random.below(lattice::Rotation::kCount));
  const int first = number / 8;
  const int second = (first + 1 + number / 4 % 2) % 3;
  const auto signedAxis = [](int axis, int bit) {
    return lattice::direction(axis, bit == 0 ? 1 : -1);
  };
  const lattice::Rotation rotation = lattice::Rotation::fromAxes(
      signedAxis(first, number % 2), signedAxis(second, number / 2 % 2));
  return {rotation, randomTranslation(limit, random)};
}

/// Charts of all blocks in which transitions across a spanning tree of the blocks are identities;
/// all are moved by the same translation.
std::vector<lattice::Transition> alignedCharts(const BlockComplex& complex, int cells,
                                               const lattice::GridPoint& translation) {
  const auto forEachNeighbour = [&](Index block, const auto& visit) {
    for (std::size_t face = 0; face < 6; ++face) {
      const auto other = complex.neighbour(block, face / 2, static_cast<int>(face % 2));
      if (!other) continue;
      visit(static_cast<Index>(other->block), [&](const lattice::Transition& chart) {
        lattice::Transition across = other->transition;
        for (std::int32_t& coordinate : across.translation) coordinate *= cells;
        return chart * across.inverse();
      });
    }
  };
  return lattice::chartsAlongTrees<lattice::Transition>(
             complex.blockCount(),
             [&](Index /*root*/) {
               return lattice::Transition{{}, translation};
             },
             forEachNeighbour)
      .motions;
}

/// The transitions from the frames of blocks to their charts.
std::vector<lattice::Transition> blockCharts(const BlockComplex& complex,
                                             const SampleOptions& options, Random& random) {
  if (options.charts == ChartStyle::Aligned || options.charts == ChartStyle::Scattered) {
    const auto offset = static_cast<std::int64_t>(options.offset);
    return alignedCharts(complex, options.cells, randomTranslation(offset, random));
  }
  std::vector<lattice::Transition> charts(complex.blockCount());
  if (options.charts == ChartStyle::Random) return charts;  // every tet gets its own
  for (lattice::Transition& chart : charts) chart = randomChart(translationLimit(options), random);
  return charts;
}

/// Length of a hexahedron along each axis of each block: 1, or as random as `stretch` says, equal
/// for all edges that are opposite each other in blocks.
std::vector<Vec3> stretchedLengths(const BlockComplex& complex, const SampleOptions& options) {
  std::vector<Vec3> lengths(complex.blockCount(), Vec3{1, 1, 1});
  if (options.stretch == 0) return lengths;
  DisjointSets chains(3 * complex.blockCount());
  for (const CoarseCell& cell : complex.cells()) {
    if (cell.dimension != 1) continue;
    const auto axisOfEdge = [](const Occurrence& at) {
      return static_cast<Index>(3 * at.block +
                                static_cast<std::size_t>(lattice::axisOf(at.axes[0])));
    };
    for (const Occurrence& at : cell.occurrences) {
      chains.unite(axisOfEdge(cell.occurrences.front()), axisOfEdge(at));
    }
  }
  Random random(options.seed, kStretchStream);
  std::vector<double> ofChain(3 * complex.blockCount());
  for (double& length : ofChain) length = 1 + random.realUpTo(options.stretch);
  for (Index block = 0; block < lengths.size(); ++block) {
    for (Index axis = 0; axis < 3; ++axis) {
      lengths[block][axis] = ofChain[chains.find(3 * block + axis)];
    }
  }
  return lengths;
}

/// Applies a random even permutation to the corners: positive tets stay positive.
void permuteCorners(Tet& tet, std::array<Int3, 4>& corners, Random& random) {
  const auto swap = [&](std::size_t a, std::size_t b) {
    std::swap(tet[a], tet[b]);
    std::swap(corners[a], corners[b]);
  };
  const std::uint64_t number = random.below(12);
  for (std::uint64_t turn = 0; turn < number % 3; ++turn) {  // around corner 0
    swap(1, 2);
    swap(2, 3);
  }
  const std::size_t partner = number / 3;  // of corner 0 in a double swap
  if (partner == 0) return;
  swap(0, partner);
  swap(partner == 1 ? 2 : 1, partner == 3 ? 2 : 3);
}

/// Writes the 12 tets of each sub-block.
class MapWriter {
 public:
  /// @param lengths  of a hexahedron in each block, along each axis
  MapWriter(const TetGrid& grid, std::vector<lattice::Transition> charts, std::vector<Vec3> lengths,
            const SampleOptions& options, Random chartRandom)
      : grid_(grid),
        charts_(std::move(charts)),
        lengths_(std::move(lengths)),
        style_(options.charts),
        limit_(translationLimit(options)),
        noise_(options.noise),
        chartRandom_(chartRandom),
        noiseRandom_(options.seed, kNoiseStream) {}

  void write(std::size_t subBlock, TetMap& map) {
    const std::array<Index, 8> vertices = grid_.cornerVertices(subBlock);
    const std::array<Int3, 8> parameters = grid_.cornerParameters(subBlock);
    const Int3 centre = grid_.centreParameters[subBlock];
    const std::size_t block = subBlock / grid_.subBlocksPerBlock();
    for (const SurfaceTriangle& t : surfaceTriangles(vertices)) {
      Tet tet = {grid_.centreVertex(subBlock), vertices[t[0]], vertices[t[1]], vertices[t[2]]};
      std::array<Int3, 4> corners = {centre, parameters[t[0]], parameters[t[1]], parameters[t[2]]};
      const bool isOwn = hasOwnChart();
      const lattice::Transition own = isOwn ? randomChart(limit_, chartRandom_) : charts_[block];
      if (isOwn) permuteCorners(tet, corners, chartRandom_);
      map.tets.push_back(tet);
      map.parameters.push_back(inChart(corners, lengths_[block], own));
    }
  }

 private:
  /// Whether the next tet has its own chart.
  [[nodiscard]] bool hasOwnChart() {
    return style_ == ChartStyle::Random ||
           (style_ == ChartStyle::Scattered && chartRandom_.below(8) == 0);
  }
  /// Converts to double, exactly unless blocks are stretched, and adds noise.
  TetParameters inChart(const std::array<Int3, 4>& corners, const Vec3& length,
                        const lattice::Transition& chart) {
    TetParameters result{};
    for (std::size_t c = 0; c < 4; ++c) {
      Vec3 u{};
      for (std::size_t a = 0; a < 3; ++a) {
        u[a] = static_cast<double>(corners[c][a]) / static_cast<double>(kUnitsPerCell) * length[a];
      }
      result[c] = chart(u, 1.0);
      for (double& x : result[c]) x += noise_ > 0 ? noiseRandom_.realUpTo(noise_) : 0;
    }
    return result;
  }

  const TetGrid& grid_;
  std::vector<lattice::Transition> charts_;
  std::vector<Vec3> lengths_;
  ChartStyle style_;
  std::int64_t limit_;
  double noise_;
  Random chartRandom_;
  Random noiseRandom_;
};

}  // namespace

void addCharts(TetGrid&& grid, const BlockComplex& complex, const SampleOptions& options,
               TetMap& map) {
  Random random(options.seed, kChartStream);
  std::vector<lattice::Transition> charts = blockCharts(complex, options, random);
  MapWriter writer(grid, std::move(charts), stretchedLengths(complex, options), options, random);
  map.tets.reserve(12 * grid.subBlockCount());
  map.parameters.reserve(12 * grid.subBlockCount());
  for (std::size_t sub = 0; sub < grid.subBlockCount(); ++sub) writer.write(sub, map);
  map.points = std::move(grid.points);
}

}  // namespace hexhex::samples
