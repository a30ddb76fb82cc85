// Quantization: a seamless map, the boxes of its motorcycle complex, integers for their edges, and
// the map bent onto these.
#include <string>

#include <hexhex/quantize.hpp>

#if defined(HEXHEX_HAS_QUANTIZE)
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>
#include <tuple>
#include <utility>
#include <vector>
#if defined(__GLIBC__)
#include <malloc.h>
#endif

#include <quantize/bend/bend_problem.hpp>
#include <quantize/bend/edge_turns.hpp>
#include <quantize/quantized_map.hpp>
#include <quantize/seamless/integer_factor.hpp>

#include <base/vector3.hpp>
#endif

#if defined(HEXHEX_HAS_QUANTIZE)
namespace hexhex::quantization {
namespace {

/// As a share of its size, an almost seamless map may be so far from a seamless one.
constexpr double kAlmost = 0.01;
/// Arcs are longer than this share of the map's size, and than so many times what has made it
/// seamless.
constexpr double kArcNoise = 1e-9;
constexpr double kLengthUnits = 0x1p20;
constexpr double kArcNoiseShare = 16;
/// More hexahedra have more vertices than indices.
constexpr double kMostCells = 4e9;
/// The search for a scale ends when it is as near to the number of cells wanted as this.
constexpr double kNearEnough = 1.03;
constexpr int kScaleSteps = 6;
/// If a map cannot be bent onto its integers, others near to them may do, or those of a complex
/// that has all its walls.
struct Attempt {
  double density;
  bool reduced;
};
constexpr std::array<Attempt, 10> kAttempts = {{{1, true},
                                                {1, false},
                                                {1.1, true},
                                                {0.92, true},
                                                {1.35, true},
                                                {1.1, false},
                                                {0.85, true},
                                                {1.2, false},
                                                {1.2, true},
                                                {1.6, true}}};
/// Tets are split until there are so many times as many: first not at all, as other integers are
/// cheaper than tets; more rarely helps.
constexpr std::array<double, 2> kGrowths = {1, 1.25};
/// That mends few of them: hardly any map of which a larger share stays flipped, and if it is as
/// large after some attempts, other integers near to these do not help, either.
constexpr double kMostMended = 0.01;
constexpr double kHopelessShare = 0.1;
constexpr std::uint64_t kFewAttempts = 3;
/// If no attempt succeeds: steps of a search for a number of cells that works, how many there are
/// at most, and with which complex.
constexpr double kDenser = 1.5;
constexpr int kMostDensities = 10;
constexpr std::array<bool, 2> kReduced = {true, false};
constexpr std::uint64_t kMostAttempts =
    kGrowths.size() * kAttempts.size() + kMostDensities * kReduced.size();

/// Planes so near to each other, as a share of the map's size, are taken as one if walls between
/// them leave no room for tets: in turn. Cells are seldom smaller than the last.
constexpr std::array<double, 6> kApart = {0, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3};

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
  if (!(cells <= kMostCells)) {
    throw Error(ErrorCode::TooLarge,
                "A mesh of more than 4,000,000,000 cells cannot be numbered. "
                "Ask for fewer cells, or quantize for a part of them and "
                "extract with a scale.");
  }
  return std::max(cells, 1.0);
}

SeamlessMap seamlessMap(const TetMapView& map, const QuantizeOptions& options, double apart,
                        Context& context) {
  SeamlessMap seamless =
      makeSeamless(map, {options.tolerance, options.tolerance, options.wallTag, apart}, context);
  requirePositiveTets(seamless);
  return seamless;
}

/// Puts the smallest vertex of a tet first, and the smallest of the others second.
void sortCorners(Tet& tet, TetParameters& u) {
  // Even permutations only: two swaps each.
  const auto swap = [&](std::size_t a, std::size_t b) {
    std::swap(tet[a], tet[b]);
    std::swap(u[a], u[b]);
  };
  const auto first =
      static_cast<std::size_t>(std::min_element(tet.begin(), tet.end()) - tet.begin());
  if (first != 0) {
    swap(0, first);
    swap(first == 1 ? 2 : 1, first == 3 ? 2 : 3);
  }
  while (tet[1] > tet[2] || tet[1] > tet[3]) {
    swap(1, 2);
    swap(2, 3);
  }
}

/// The same map with tets and corners in an order that depends on vertices alone: so that the
/// outcome does not depend on the caller's.
/// @param[out] order  whose number each tet had
TetMap inCanonicalOrder(const TetMapView& map, std::vector<Index>& order) {
  const auto key = [&map](Index t) {
    Tet tet = map.tets[t];
    std::sort(tet.begin(), tet.end());
    return tet;
  };
  order.resize(map.tets.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::sort(order.begin(), order.end(),
            [&](Index a, Index b) { return std::pair(key(a), a) < std::pair(key(b), b); });
  TetMap sorted;
  sorted.points.assign(map.points.begin(), map.points.end());
  for (const Index t : order) {
    Tet tet = map.tets[t];
    TetParameters u = map.parameters[t];
    sortCorners(tet, u);
    sorted.tets.push_back(tet);
    sorted.parameters.push_back(u);
    if (!map.regions.empty()) sorted.regions.push_back(map.regions[t]);
  }
  sorted.features.vertices.assign(map.features.vertices.begin(), map.features.vertices.end());
  sorted.features.edges.assign(map.features.edges.begin(), map.features.edges.end());
  sorted.features.faces.assign(map.features.faces.begin(), map.features.faces.end());
  return sorted;
}

/// Whether tets name points that exist, and regions are as many.
bool areInRange(const TetMapView& map) {
  if (!map.regions.empty() && map.regions.size() != map.tets.size()) return false;
  return std::all_of(map.tets.begin(), map.tets.end(), [&map](const Tet& tet) {
    return std::all_of(tet.begin(), tet.end(), [&map](Index v) { return v < map.points.size(); });
  });
}

/// An error that names a tet of the sorted map, by the caller's number.
Error inCallersTerms(const Error& error, const TetMapView& map, const std::vector<Index>& order) {
  Place place = error.place();
  const bool isFace = place.kind == PlaceKind::Face;
  if (!(isFace || place.kind == PlaceKind::Tet) || place.index >= order.size()) return error;
  place.index = order[place.index];
  if (isFace) {
    const Tet& callers = map.tets[place.index];
    Tet sorted = callers;
    TetParameters unused{};
    sortCorners(sorted, unused);
    const auto corner = std::find(callers.begin(), callers.end(), sorted[place.second]);
    place.second = static_cast<std::uint64_t>(corner - callers.begin());
  }
  std::string text = error.what();
  const std::string said = " at " + toString(error.place());
  if (const std::size_t at = text.find(said); at != std::string::npos) {
    text.replace(at, said.size(), " at " + toString(place));
  }
  return {error.code(), text, place};
}

/// Gives tets the caller's numbers; parts that were split off come behind.
void restoreOrder(const std::vector<Index>& order, TetMap& map) {
  const auto restore = [&order](auto& values) {
    auto sorted = values;
    for (std::size_t i = 0; i < order.size(); ++i) values[order[i]] = sorted[i];
  };
  restore(map.tets);
  restore(map.parameters);
  if (!map.regions.empty()) restore(map.regions);
}

/// Gives what is free back to the system, before a step that takes much memory. The C library keeps
/// what lies between blocks in use, and puts large arrays elsewhere.
void returnFreeMemory() noexcept {
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
}

/// Integers for all arcs at one scale.
struct Choice {
  double scale = 0;
  std::vector<std::int64_t> integers;
  double cells = 0;
};

class Quantizer {
 public:
  /// @param apart  as in SeamlessOptions
  Quantizer(TetMap map, const QuantizeOptions& options, double apart, Context& context)
      : options_(options),
        context_(context),
        map_(std::move(map)),
        seamless_(seamlessMap(map_, options, apart, context)) {
    std::vector<TetParameters>().swap(map_.parameters);  // which are large
    irregularEdges_ = irregularEdges(EdgeFans(seamless_.topology), seamless_.topology.tets,
                                     std::span<const lattice::LatticeTet>(seamless_.corners));
    report_.cellsWanted = cellsWanted(map_, seamless_, options);
    report_.displacement = seamless_.maxDisplacement;
    report_.integersBy = solver_.name;
  }

  QuantizedMap run() {
    for (const double growth : kGrowths) {
      if (growth > 1 && leastFlipped_ > kMostMended) break;
      for (const Attempt& attempt : kAttempts) {
        if (isHopeless()) break;
        cutIntoBlocks(attempt.reduced);
        auto result = tryCells(report_.cellsWanted * attempt.density, growth);
        if (result) return std::move(*result);
      }
    }
    isDenser_ = true;
    double cells = report_.cellsWanted;
    for (int step = 0; step < kMostDensities && cells * kDenser <= kMostCells; ++step) {
      cells *= kDenser;
      for (const bool reduced : kReduced) {
        if (!reduced && isHopeless()) break;
        cutIntoBlocks(reduced);
        auto result = tryCells(cells, 1);
        if (result && !options_.densify) {
          fail(std::to_string(report_.cells) +
               " cells work: ask for so many, or let it choose (densify)");
        }
        if (result) return std::move(*result);
      }
    }
    fail("Nor were any up to " + std::to_string(std::llround(cells)) +
         " cells found that it can be bent onto: make arcs of the map's blocks less different in "
         "length");
  }

 private:
  [[nodiscard]] bool isHopeless() const {
    return report_.attempts >= kFewAttempts && leastFlipped_ > kHopelessShare;
  }

  /// Says which attempt this is.
  void announce(double cells, double growth) {
    context_.report("bending " + std::to_string(report_.attempts) + " of at most " +
                        std::to_string(kMostAttempts) + ": " + std::to_string(std::llround(cells)) +
                        " cells in " + std::to_string(report_.blocks) + " blocks" +
                        (growth > 1 ? ", with split tets" : ""),
                    0);
  }

  /// @param reduced  whether walls that nothing needs are taken away
  void cutIntoBlocks(bool reduced) {
    if (complex_ && isReduced_ == reduced) return;
    isReduced_ = reduced;
    complex_.reset();
    complex_ = traceComplex(seamless_, reduced, context_);
    program_.equations = arcEquations(*complex_);
    // Walls that would be one but for noise may become one.
    const double noise =
        std::max(kArcNoise * seamless_.size, kArcNoiseShare * seamless_.maxDisplacement);
    program_.least.clear();
    for (const Arc& arc : complex_->arcs) {
      program_.least.push_back(static_cast<double>(arc.length) < noise * seamless_.unit ? 0 : 1);
    }
    report_.blocks = complex_->blockCount;
    report_.arcs = complex_->arcs.size();
  }

  std::optional<QuantizedMap> tryCells(double cells, double growth) {
    const std::optional<Choice> choice = choose(cells);
    if (!choice || failed_.contains({growth, report_.blocks, choice->integers}))
      return std::nullopt;
    ++report_.attempts;
    BendProblem problem = bendProblem(seamless_, *complex_,
                                      BlockIntegers(*complex_, choice->integers), choice->scale);
    problem.irregularEdges = irregularEdges_;
    // Bending needs the memory, and rarely fails.
    const std::vector<Index> blockOf = std::move(complex_->blockOf);
    complex_.reset();
    returnFreeMemory();
    Stage stage(context_, "bending");
    announce(choice->cells, growth);
    BentMap bent = bend(std::move(problem), {.maxGrowth = growth}, stage);
    if (!bent.isValid()) {
      failed_.insert({growth, report_.blocks, choice->integers});
      const auto flipped = static_cast<double>(bent.flippedTets.size());
      if (flipped > 0) {
        leastFlipped_ = std::min(leastFlipped_, flipped / static_cast<double>(bent.tets.size()));
      }
      if (flipped > 0 && (!isDenser_ || flippedTet_ == kNone)) {
        flippedTet_ = bent.parentTet[bent.flippedTets.front()];
        flippedBlock_ = "block " + std::to_string(blockOf[flippedTet_] + 1) + " of " +
                        std::to_string(report_.blocks) + " with " +
                        std::to_string(std::llround(choice->cells)) + " cells";
      }
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
    stage.finish();
    seamless_ = SeamlessMap();  // checks need its memory
    returnFreeMemory();
    return finishQuantization(std::move(irregularEdges_), map_, std::move(bent), report_, context_);
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
      for (const Arc& arc : complex_->arcs) {
        // Without the noise that would decide between integers that are equally good.
        const double length = static_cast<double>(arc.length) / seamless_.unit * scale;
        program_.lengths.push_back(std::round(length * kLengthUnits) / kLengthUnits);
      }
      Choice choice{scale, solver_.solve(program_, context_), 0};
      if (choice.integers.empty()) {
        // Rounding finds some where arcs are longer.
        scale *= 1.2;
        continue;
      }
      choice.cells = BlockIntegers(*complex_, choice.integers).cellCount();
      scale *= std::cbrt(cells / choice.cells);
      if (!best || distance(choice) < distance(*best)) best = std::move(choice);
      if (distance(*best) < std::log(kNearEnough)) break;
    }
    return best;
  }

  /// @param whatWorks  what a search for larger numbers of cells has found
  [[noreturn]] void fail(const std::string& whatWorks) const {
    const std::string message = "The map cannot be bent onto integers for about " +
                                std::to_string(std::llround(report_.cellsWanted)) + " cells: ";
    const std::string advice = ". " + whatWorks + '.';
    if (failed_.empty()) {
      throw Error(
          ErrorCode::FlippedTet,
          message + "none were found for the " + std::to_string(report_.arcs) +
              " arcs of its motorcycle complex" + advice +
              (report_.integersBy == "rounding" ? " Or let HiGHS find them (pip install highsbox, "
                                                  "and HEXHEX_HIGHS names its libhighs.so)."
                                                : ""));
    }
    if (flippedTet_ == kNone) {
      throw Error(ErrorCode::HalfIntegerFixedPoint,
                  message + "they leave no position for a vertex" + advice);
    }
    throw Error(ErrorCode::FlippedTet,
                message + "tets stay flipped in " + flippedBlock_ + ", after " +
                    std::to_string(report_.attempts) + " attempts" + advice,
                {PlaceKind::Tet, flippedTet_});
  }

  const QuantizeOptions& options_;
  Context& context_;
  TetMap map_;  ///< without parameters
  SeamlessMap seamless_;
  IrregularEdges irregularEdges_;
  std::optional<MotorcycleComplex> complex_;
  bool isReduced_ = false;
  IntegerSolver solver_ = integerSolver();
  IntegerProgram program_;
  QuantizeReport report_;
  /// Integers that the map cannot be bent onto, if tets may grow so many times in number, of the
  /// complex with so many blocks. Those of the next density are often the same.
  std::set<std::tuple<double, std::uint64_t, std::vector<std::int64_t>>> failed_;
  double leastFlipped_ = 1;  ///< the least share of tets that an attempt has left so
  bool isDenser_ = false;    ///< while a number of cells that works is searched
  Index flippedTet_ = kNone;
  std::string flippedBlock_;  ///< of the same attempt, in words: the last before that, if any
};

/// Takes more and more planes as one until walls leave room between them.
QuantizedMap quantizeSorted(TetMap map, const QuantizeOptions& options, Context& context) {
  std::optional<Error> tooThin;
  for (const double apart : kApart) {
    try {
      return Quantizer(map, options, apart, context).run();
    } catch (const TooThinForWalls& error) {
      if (!tooThin) tooThin = error;
    } catch (const Error& error) {
      // Tets may have been flipped when planes became one.
      if (!tooThin || error.code() != ErrorCode::FlippedTet) throw;
    }
  }
  throw Error(*tooThin);
}

}  // namespace

}  // namespace hexhex::quantization
#endif

namespace hexhex {

#if defined(HEXHEX_HAS_QUANTIZE)

bool canQuantize() noexcept { return true; }

SeamlessReport examineSeamless(const TetMapView& map, Context& context) {
  constexpr std::array<WorkStep, 2> kSteps = {{{"seamless map", 4}, {"prepare", 1}}};
  WorkSteps steps(context, "examineSeamless", kSteps);
  SeamlessReport report;
  try {
    const quantization::SeamlessMap seamless =
        quantization::makeSeamless(map, {quantization::kAlmost, 0, 0}, context);
    report.displacement = seamless.maxDisplacement;
    report.cells = quantization::volumeOf(seamless);
    report.kind = report.displacement <= QuantizeOptions{}.tolerance * seamless.size
                      ? SeamlessKind::Seamless
                      : SeamlessKind::AlmostSeamless;
    if (report.kind == SeamlessKind::Seamless || !seamless.flippedAsGiven.empty()) {
      quantization::requirePositiveTets(seamless);
    }
    report.integerFactor = quantization::integerFactor(map, seamless, context);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::Cancelled) throw;
    report.kind = SeamlessKind::Neither;
    report.problem = error.what();
    const std::string where = toString(error.place());
    if (!where.empty()) report.problem += " [" + where + "]";
  }
  steps.finish();
  return report;
}

QuantizedMap quantize(const TetMapView& map, const QuantizeOptions& options, Context& context) {
  constexpr std::array<WorkStep, 5> kSteps = {{{"seamless map", 1},
                                               {"motorcycle complex", 2},
                                               {"integers", 2},
                                               {"bending", 4},
                                               {"singular curves", 0.2}}};
  quantization::checkOptions(options);
  WorkSteps steps(context, "quantize", kSteps);
  QuantizedMap result;
  withThreads(context.threads(), [&] {
    // What is wrong with the caller's arrays is found in them.
    if (map.parameters.size() != map.tets.size() || !quantization::areInRange(map)) {
      static_cast<void>(quantization::makeSeamless(map, {}, context));
    }
    std::vector<Index> order;
    TetMap sorted = quantization::inCanonicalOrder(map, order);
    try {
      result = quantization::quantizeSorted(std::move(sorted), options, context);
    } catch (const Error& error) {
      throw quantization::inCallersTerms(error, map, order);
    }
    quantization::restoreOrder(order, result.map);
  });
  steps.finish();
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
