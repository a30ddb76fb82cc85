// Quantization: a seamless map, the boxes of its motorcycle complex, integers for their edges, and
// the map bent onto these.
#include <string>

#include <hexhex/quantize.hpp>

#if defined(HEXHEX_HAS_QUANTIZE)
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <quantize/bend_problem.hpp>
#include <quantize/quantized_map.hpp>

#include <base/vector3.hpp>
#endif

namespace hexhex {

#if defined(HEXHEX_HAS_QUANTIZE)
namespace {

/// As a share of its largest coordinate, an almost seamless map may be so far from a seamless one.
constexpr double kAlmost = 0.01;
/// Arcs are longer than this share of the map's size, and than so many times what has made it
/// seamless.
constexpr double kNoise = 1e-9;
constexpr double kNoiseShare = 16;
/// More hexahedra have more vertices than indices.
constexpr double kMostCells = 4e9;
/// The search for a scale ends when it is as near to the number of cells wanted as this.
constexpr double kNearEnough = 1.03;
constexpr int kScaleSteps = 6;
/// If a map cannot be bent onto its integers, others near to them may do.
constexpr std::array<double, 4> kOtherDensities = {1, 1.08, 0.93, 1.16};
/// Steps of a search for a density that works, and how many there are at most.
constexpr double kDenser = 1.3;
constexpr int kMostDensities = 24;

double spaceVolume(const TetMapView& map) {
  double volume = 0;
  for (const Tet& tet : map.tets) {
    const Vec3& origin = map.points[tet[0]];
    volume += tripleProduct(minus(map.points[tet[1]], origin), minus(map.points[tet[2]], origin),
                            minus(map.points[tet[3]], origin)) /
              6;
  }
  return std::abs(volume);
}

double largestCoordinate(const TetMapView& map) {
  double largest = 0;
  for (const TetParameters& tet : map.parameters) {
    for (const Vec3& u : tet) {
      for (const double x : u) largest = std::max(largest, std::abs(x));
    }
  }
  return largest;
}

void checkOptions(const QuantizeOptions& options) {
  int given = 0;
  for (const double each : {options.cells, options.scale, options.edgeLength}) {
    if (!(each >= 0) || !std::isfinite(each)) {
      throw Error(ErrorCode::InvalidArgument,
                  "The number of cells, the scale and the edge length of a quantized map are "
                  "positive numbers.");
    }
    given += each > 0 ? 1 : 0;
  }
  if (given != 1) {
    throw Error(ErrorCode::InvalidArgument,
                "Say how fine the mesh is to be: by a number of cells, a scale, or an edge length, "
                "one of them and greater than 0.");
  }
  if (!(options.tolerance >= 0 && options.tolerance <= 0.01)) {
    throw Error(ErrorCode::InvalidArgument,
                "The tolerance of quantization is a share of the map's size, from 0 to 0.01.");
  }
}

double cellsWanted(const TetMapView& map, const SeamlessMap& seamless,
                   const QuantizeOptions& options) {
  double cells = options.cells;
  if (options.scale > 0) cells = std::pow(options.scale, 3) * volumeOf(seamless);
  if (options.edgeLength > 0) cells = spaceVolume(map) / std::pow(options.edgeLength, 3);
  if (cells > kMostCells) {
    throw Error(ErrorCode::TooLarge,
                "A mesh of more than 4,000,000,000 cells cannot be numbered. "
                "Ask for fewer cells, or quantize for a part of them and "
                "extract with a scale.");
  }
  return std::max(cells, 1.0);
}

SeamlessMap seamlessMap(const TetMapView& map, const QuantizeOptions& options, Context& context) {
  const double tolerance = options.tolerance * largestCoordinate(map);
  SeamlessMap seamless = makeSeamless(map, {tolerance, tolerance, options.wallTag}, context);
  requirePositiveTets(seamless);
  return seamless;
}

/// Integers for all arcs at one scale.
struct Choice {
  double scale = 0;
  std::vector<std::int64_t> integers;
  double cells = 0;
};

class Quantizer {
 public:
  Quantizer(const TetMapView& map, const QuantizeOptions& options, Context& context)
      : options_(options),
        context_(context),
        seamless_(seamlessMap(map, options, context)),
        cellsWanted_(cellsWanted(map, seamless_, options)),
        complex_(traceComplex(seamless_, context)),
        map_(map) {
    program_.equations = arcEquations(complex_);
    // Walls that would be one but for noise may become one.
    const double noise =
        std::max(kNoise * largestCoordinate(map), kNoiseShare * seamless_.maxDisplacement);
    for (const Arc& arc : complex_.arcs) {
      program_.least.push_back(static_cast<double>(arc.length) < noise * seamless_.unit ? 0 : 1);
    }
    report_.cellsWanted = cellsWanted_;
    report_.displacement = seamless_.maxDisplacement;
    report_.blocks = complex_.blockCount;
    report_.arcs = complex_.arcs.size();
    report_.integersBy = canLoadCbc() ? "CBC" : "rounding";
  }

  QuantizedMap run() {
    double density = 1;
    for (int step = 0; step < (options_.densify ? kMostDensities : 1); ++step) {
      for (const double other : kOtherDensities) {
        if (std::optional<QuantizedMap> result = tryCells(report_.cellsWanted * density * other)) {
          return std::move(*result);
        }
      }
      density *= kDenser;
      if (report_.cellsWanted * density > kMostCells) break;
    }
    fail();
  }

 private:
  std::optional<QuantizedMap> tryCells(double cells) {
    const std::optional<Choice> choice = choose(cells);
    if (!choice || choice->integers == last_) return std::nullopt;
    last_ = choice->integers;
    ++report_.attempts;
    BendProblem problem =
        bendProblem(seamless_, complex_, BlockIntegers(complex_, choice->integers), choice->scale);
    Stage stage(context_, "bending");
    BentMap bent = bend(std::move(problem), {}, stage);
    if (!bent.isValid()) {
      if (!bent.flippedTets.empty()) firstFlipped_ = bent.parentTet[bent.flippedTets.front()];
      return std::nullopt;
    }
    report_.scale = choice->scale;
    report_.cells = static_cast<std::uint64_t>(std::llround(choice->cells));
    const auto [least, most] =
        std::minmax_element(choice->integers.begin(), choice->integers.end());
    report_.shortestArc = static_cast<std::uint64_t>(*least);
    report_.longestArc = static_cast<std::uint64_t>(*most);
    report_.splitEdges = bent.splitEdges.size();
    report_.addedTets = bent.tets.size() - seamless_.corners.size();
    return finishQuantization(seamless_, map_, std::move(bent), report_, context_);
  }

  /// Integers whose number of cells is near to what is wanted.
  std::optional<Choice> choose(double cells) {
    Stage stage(context_, "integers");
    std::optional<Choice> best;
    const auto distance = [cells](const Choice& choice) {
      return std::abs(std::log(choice.cells / cells));
    };
    double scale = std::cbrt(cells / volumeOf(seamless_));
    for (int step = 0; step < kScaleSteps; ++step) {
      context_.throwIfCancelled();
      program_.lengths.clear();
      for (const Arc& arc : complex_.arcs) {
        program_.lengths.push_back(static_cast<double>(arc.length) / seamless_.unit * scale);
      }
      Choice choice{scale, canLoadCbc() ? solveByCbc(program_) : solveGreedily(program_, stage), 0};
      if (choice.integers.empty()) {
        // Rounding finds some where arcs are longer.
        scale *= 1.2;
        continue;
      }
      choice.cells = BlockIntegers(complex_, choice.integers).cellCount();
      scale *= std::cbrt(cells / choice.cells);
      if (!best || distance(choice) < distance(*best)) best = std::move(choice);
      if (distance(*best) < std::log(kNearEnough)) break;
    }
    return best;
  }

  [[noreturn]] void fail() const {
    std::string message = "The map cannot be bent onto integers for about " +
                          std::to_string(std::llround(report_.cellsWanted)) + " cells";
    if (last_.empty()) {
      throw Error(ErrorCode::FlippedTet,
                  message + ": none were found for the " + std::to_string(report_.arcs) +
                      " arcs of its motorcycle complex. Ask for more cells" +
                      (canLoadCbc() ? "." : ", or install CBC (coinor-libcbc3)."));
    }
    if (firstFlipped_ == kNone) {
      throw Error(ErrorCode::HalfIntegerFixedPoint,
                  message + ": they leave no position for a vertex. Ask for more cells.");
    }
    throw Error(ErrorCode::FlippedTet,
                message + ": tets stay flipped in block " +
                    std::to_string(complex_.blockOf[firstFlipped_]) + " of " +
                    std::to_string(report_.blocks) +
                    ". Ask for more cells, or let it choose a density that works (densify).",
                {PlaceKind::Tet, firstFlipped_});
  }

  const QuantizeOptions& options_;
  Context& context_;
  SeamlessMap seamless_;
  double cellsWanted_;
  MotorcycleComplex complex_;
  const TetMapView& map_;
  IntegerProgram program_;
  QuantizeReport report_;
  std::vector<std::int64_t> last_;
  Index firstFlipped_ = kNone;
};

}  // namespace

bool canQuantize() noexcept { return true; }

SeamlessReport examineSeamless(const TetMapView& map, Context& context) {
  SeamlessReport report;
  const double size = largestCoordinate(map);
  try {
    const SeamlessMap seamless = makeSeamless(map, {kAlmost * size, 0, 0}, context);
    report.displacement = seamless.maxDisplacement;
    report.cells = volumeOf(seamless);
    report.kind = report.displacement <= QuantizeOptions{}.tolerance * size
                      ? SeamlessKind::Seamless
                      : SeamlessKind::AlmostSeamless;
  } catch (const Error& error) {
    if (error.code() == ErrorCode::Cancelled) throw;
    report.problem = error.what();
  }
  return report;
}

QuantizedMap quantize(const TetMapView& map, const QuantizeOptions& options, Context& context) {
  checkOptions(options);
  QuantizedMap result;
  withThreads(context.threads(), [&] { result = Quantizer(map, options, context).run(); });
  return result;
}
#else
bool canQuantize() noexcept { return false; }

SeamlessReport examineSeamless(const TetMapView& /*map*/, Context& /*context*/) { return {}; }

QuantizedMap quantize(const TetMapView& /*map*/, const QuantizeOptions& /*options*/,
                      Context& /*context*/) {
  throw Error(ErrorCode::InvalidArgument,
              "This build of hexhex cannot quantize maps. Install Eigen (libeigen3-dev) and build "
              "it anew.");
}
#endif

QuantizedMap quantize(const TetMapView& map, const QuantizeOptions& options) {
  Context context;
  return quantize(map, options, context);
}

}  // namespace hexhex
