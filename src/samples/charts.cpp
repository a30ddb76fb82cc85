// Draws the charts and writes the tets of every sub-block.
#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <samples/charts.hpp>
#include <samples/random.hpp>

namespace hexhex::samples {

namespace {

/// Translations are drawn from [-20, 20] unless an offset is given: small enough to read, large
/// enough that hardly any is zero.
constexpr std::int64_t kSmallOffset = 20;
/// Independent streams of random numbers.
constexpr std::uint64_t kChartStream = 3;
constexpr std::uint64_t kNoiseStream = 4;

/// Translations of random charts are drawn from [-limit, limit].
std::int64_t translationLimit(const SampleOptions& options) {
  return options.offset >= 1 ? static_cast<std::int64_t>(options.offset) : kSmallOffset;
}

Int3 randomTranslation(std::int64_t limit, Random& random) {
  Int3 translation{};
  for (std::int64_t& coordinate : translation) coordinate = random.integerUpTo(limit);
  return translation;
}

/// A random rotation and integer translation, in units.
Motion randomChart(std::int64_t limit, Random& random) {
  const Rotation rotation = cubeRotation(random.below(24));
  return {rotation, kUnitsPerCell * randomTranslation(limit, random)};
}

/// Charts of all blocks such that transitions across a spanning tree of the blocks are identities;
/// all are moved by the same translation.
std::vector<Motion> alignedCharts(const BlockComplex& complex, std::int64_t cells,
                                  const Int3& translation) {
  std::vector<std::optional<Motion>> charts(complex.blockCount());
  for (std::size_t root = 0; root < charts.size(); ++root) {
    if (charts[root]) continue;
    charts[root] = Motion{{}, kUnitsPerCell * translation};
    std::vector<std::size_t> reached = {root};
    for (std::size_t next = 0; next < reached.size(); ++next) {
      for (std::size_t face = 0; face < 6; ++face) {
        const auto other = complex.neighbour(reached[next], face / 2, static_cast<int>(face % 2));
        if (!other || charts[other->block]) continue;
        Motion across = other->motion;
        across.translation = cells * kUnitsPerCell * across.translation;
        charts[other->block] = compose(*charts[reached[next]], inverse(across));
        reached.push_back(other->block);
      }
    }
  }
  std::vector<Motion> result;
  result.reserve(charts.size());
  for (const std::optional<Motion>& chart : charts) result.push_back(*chart);
  return result;
}

std::vector<Motion> blockCharts(const BlockComplex& complex, const SampleOptions& options,
                                Random& random) {
  if (options.charts == ChartStyle::Aligned || options.charts == ChartStyle::Scattered) {
    const auto offset = static_cast<std::int64_t>(options.offset);
    return alignedCharts(complex, options.cells, randomTranslation(offset, random));
  }
  std::vector<Motion> charts(complex.blockCount());
  if (options.charts == ChartStyle::Random) return charts;  // every tet gets its own
  for (Motion& chart : charts) chart = randomChart(translationLimit(options), random);
  return charts;
}

/// Applies a random even permutation of the corners: positive tets stay positive.
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
  MapWriter(const TetGrid& grid, std::vector<Motion> charts, const SampleOptions& options,
            Random chartRandom)
      : grid_(grid),
        charts_(std::move(charts)),
        style_(options.charts),
        limit_(translationLimit(options)),
        noise_(options.noise),
        chartRandom_(chartRandom),
        noiseRandom_(options.seed, kNoiseStream) {}

  void write(std::size_t subBlock, TetMap& map) {
    const std::array<Index, 8> vertices = grid_.cornerVertices(subBlock);
    const std::array<Int3, 8> parameters = grid_.cornerParameters(subBlock);
    const Int3 centre = grid_.centreParameters[subBlock];
    const Motion& chart = charts_[subBlock / grid_.subBlocksPerBlock()];
    for (const SurfaceTriangle& t : surfaceTriangles(vertices)) {
      Tet tet = {grid_.centreVertex(subBlock), vertices[t[0]], vertices[t[1]], vertices[t[2]]};
      std::array<Int3, 4> corners = {centre, parameters[t[0]], parameters[t[1]], parameters[t[2]]};
      const bool isOwn = hasOwnChart();
      const Motion motion = isOwn ? randomChart(limit_, chartRandom_) : chart;
      for (Int3& corner : corners) corner = motion(corner);
      if (isOwn) permuteCorners(tet, corners, chartRandom_);
      map.tets.push_back(tet);
      map.parameters.push_back(rounded(corners));
    }
  }

 private:
  /// Whether the next tet has a chart of its own.
  [[nodiscard]] bool hasOwnChart() {
    return style_ == ChartStyle::Random ||
           (style_ == ChartStyle::Scattered && chartRandom_.below(8) == 0);
  }
  /// To double, which is exact, and noise on top.
  TetParameters rounded(const std::array<Int3, 4>& corners) {
    TetParameters result{};
    for (std::size_t c = 0; c < 4; ++c) {
      for (std::size_t a = 0; a < 3; ++a) {
        result[c][a] = static_cast<double>(corners[c][a]) / static_cast<double>(kUnitsPerCell);
        if (noise_ > 0) result[c][a] += noiseRandom_.realUpTo(noise_);
      }
    }
    return result;
  }

  const TetGrid& grid_;
  std::vector<Motion> charts_;
  ChartStyle style_;
  std::int64_t limit_;
  double noise_;
  Random chartRandom_;
  Random noiseRandom_;
};

}  // namespace

TetMap mapWithCharts(TetGrid&& grid, const BlockComplex& complex, const SampleOptions& options) {
  Random random(options.seed, kChartStream);
  std::vector<Motion> charts = blockCharts(complex, options, random);
  MapWriter writer(grid, std::move(charts), options, random);
  TetMap map;
  map.tets.reserve(12 * grid.subBlockCount());
  map.parameters.reserve(12 * grid.subBlockCount());
  for (std::size_t sub = 0; sub < grid.subBlockCount(); ++sub) writer.write(sub, map);
  map.points = std::move(grid.points);
  return map;
}

}  // namespace hexhex::samples
