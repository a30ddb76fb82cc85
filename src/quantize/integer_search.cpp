#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <quantize/bend/bend_problem.hpp>
#include <quantize/bend/edge_turns.hpp>
#include <quantize/cell_limit.hpp>
#include <quantize/integer_search.hpp>
#include <quantize/integers/block_structure.hpp>

#include <base/vector3.hpp>

namespace hexhex::quantization {

namespace {

/// An attempt: at which density integers are sought, and for which blocks.
struct Candidate {
  enum Kind : std::uint8_t {
    AsWanted,   ///< close to the requested number of cells
    WithSplit,  ///< the same, but tets that stay flipped may be split: more cells cost less than
                ///< more tets
    Denser,     ///< many more cells, to report a number that works
  } kind;
  double density;  ///< number of cells, relative to the request
  bool reduced;    ///< whether needless walls are removed
  const char* why;
};

/// Densities close to the requested number of cells.
constexpr std::array<Candidate, 10> kNear = {{
    {Candidate::AsWanted, 1, true, "as wanted"},
    {Candidate::AsWanted, 1, false, "with all walls, which hold each block where it is"},
    {Candidate::AsWanted, 1.1, true, "slightly more cells, where rounding up makes room"},
    {Candidate::AsWanted, 0.92, true,
     "slightly fewer cells, where rounding down leaves room to others"},
    {Candidate::AsWanted, 1.35, true, "a tenth finer"},
    {Candidate::AsWanted, 1.1, false, "slightly more cells with all walls"},
    {Candidate::AsWanted, 0.85, true, "a twentieth coarser"},
    {Candidate::AsWanted, 1.2, false, "a fifth more cells with all walls"},
    {Candidate::AsWanted, 1.2, true, "a fifth more cells"},
    {Candidate::AsWanted, 1.6, true, "a sixth finer: as far as may pass for what is wanted"},
}};
/// Maximum growth of the number of tets by splits; more rarely helps.
constexpr double kSplitGrowth = 1.25;
/// Splits hardly ever help if more than kMostMended of the tets stay flipped. If more than
/// kHopelessShare still are after kFewAttempts, similar integers do not help either.
constexpr double kMostMended = 0.01;
constexpr double kHopelessShare = 0.1;
constexpr std::uint64_t kFewAttempts = 3;
/// No attempt starts after this many solver steps times tets in total (some seconds). Large maps
/// get kMostSteps steps all the same, and take longer. The setup of an attempt takes as long as
/// kStepsOfBeginning steps.
constexpr double kMostSearchWork = 4e6;
constexpr double kMostSteps = 400;
constexpr double kStepsOfBeginning = 30;
constexpr double kDenser = 1.5;
constexpr int kMostDensities = 10;

/// All attempts, in order.
std::vector<Candidate> candidatesFor(double cellsWanted) {
  std::vector<Candidate> all(kNear.begin(), kNear.end());
  for (Candidate candidate : kNear) {
    candidate.kind = Candidate::WithSplit;
    all.push_back(candidate);
  }
  double density = kDenser;
  for (int step = 0; step < kMostDensities; ++step, density *= kDenser) {
    if (cellsWanted * density > kMostCells) break;
    for (const bool reduced : {true, false}) {
      all.push_back({Candidate::Denser, density, reduced, "to find a number that works"});
    }
  }
  return all;
}

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

double cellsWanted(const TetMapView& map, const SeamlessMap& seamless,
                   const QuantizeOptions& options) {
  double cells = options.cells;
  if (options.scale > 0) cells = std::pow(options.scale, 3) * volumeOf(seamless);
  if (options.edgeLength > 0) cells = spaceVolume(map) / std::pow(options.edgeLength, 3);
  requireNumberable(cells);
  return std::max(cells, 1.0);
}

class Search {
 public:
  Search(SeamlessMap seamless, double cellsWanted, const QuantizeOptions& options, Context& context)
      : options_(options), context_(context), seamless_(std::move(seamless)) {
    irregularEdges_ =
        irregularEdges(adjacency::EdgeFans(seamless_.topology), seamless_.topology.tets,
                       std::span<const lattice::LatticeTet>(seamless_.corners));
    report_.cellsWanted = cellsWanted;
    report_.displacement = seamless_.maxDisplacement;
    report_.integersBy = solver_.name;
  }

  FoundMap run() {
    const std::vector<Candidate> candidates = candidatesFor(report_.cellsWanted);
    for (const Candidate& candidate : candidates) {
      if (!isWorthIt(candidate)) continue;
      std::optional<BentMap> bent = attempt(candidate, candidates.size());
      if (!bent) continue;
      if (candidate.kind == Candidate::Denser && !options_.densify) {
        fail(std::to_string(report_.cells) +
             " cells work: ask for so many, or let it choose (densify)");
      }
      return {std::move(*bent), std::move(irregularEdges_), report_};
    }
    fail("Nor were any up to " + std::to_string(std::llround(mostCells_)) +
         " cells found that it can be bent onto: make arcs of the map's blocks less different in "
         "length");
  }

 private:
  [[nodiscard]] bool isWorthIt(const Candidate& candidate) const {
    const auto tets = static_cast<double>(seamless_.corners.size());
    if (steps_ > std::max(kMostSteps, kMostSearchWork / tets)) return false;
    const bool isHopeless = report_.attempts >= kFewAttempts && leastFlipped_ > kHopelessShare;
    if (candidate.kind == Candidate::Denser) return candidate.reduced || !isHopeless;
    if (candidate.kind == Candidate::WithSplit && leastFlipped_ > kMostMended) return false;
    return !isHopeless;
  }

  /// The block structure, traced on first use.
  const BlockStructure& blocks(bool reduced) {
    std::optional<BlockStructure>& blocks = blocks_[reduced ? 1 : 0];
    if (!blocks) blocks.emplace(seamless_, reduced, context_);
    report_.blocks = blocks->complex().blockCount;
    report_.arcs = blocks->complex().arcs.size();
    return *blocks;
  }

  std::optional<BentMap> attempt(const Candidate& candidate, std::size_t most) {
    const BlockStructure& structure = blocks(candidate.reduced);
    mostCells_ = std::max(mostCells_, report_.cellsWanted * candidate.density);
    const std::optional<Choice> choice =
        structure.choose(report_.cellsWanted * candidate.density, solver_, context_);
    const bool mayGrow = candidate.kind == Candidate::WithSplit;
    if (!choice || tried_.contains({mayGrow, candidate.reduced, choice->integers})) {
      return std::nullopt;
    }
    tried_.insert({mayGrow, candidate.reduced, choice->integers});
    ++report_.attempts;
    const MotorcycleComplex& complex = structure.complex();
    BendProblem problem =
        bendProblem(seamless_, complex, BlockIntegers(complex, choice->integers), choice->scale);
    problem.irregularEdges = irregularEdges_;
    Stage stage(context_, "bending");
    context_.report("bending " + std::to_string(report_.attempts) + " of at most " +
                        std::to_string(most) + ": " + std::to_string(std::llround(choice->cells)) +
                        " cells in " + std::to_string(report_.blocks) + " blocks" +
                        (mayGrow ? ", with split tets (" : " (") + candidate.why + ')',
                    0);
    BentMap bent = bend(std::move(problem), {.maxGrowth = mayGrow ? kSplitGrowth : 1}, stage);
    steps_ += bent.iterations + kStepsOfBeginning;
    if (!bent.isValid()) {
      remember(bent, candidate, *choice, complex);
      return std::nullopt;
    }
    report(*choice, bent);
    return bent;
  }

  /// Keeps what the message about a failure needs.
  void remember(const BentMap& bent, const Candidate& candidate, const Choice& choice,
                const MotorcycleComplex& complex) {
    if (bent.flippedTets.empty()) return;
    leastFlipped_ = std::min(leastFlipped_, static_cast<double>(bent.flippedTets.size()) /
                                                static_cast<double>(bent.tets.size()));
    if (candidate.kind == Candidate::Denser && flippedTet_ != kNone) return;
    flippedTet_ = bent.parentTet[bent.tightness.tet];
    flippedWhere_ = "block " + std::to_string(complex.blockOf[flippedTet_] + 1) + " of " +
                    std::to_string(complex.blockCount) + " with " +
                    std::to_string(std::llround(choice.cells)) + " cells";
    flippedWhy_ = bent.isWound ? ": the map winds otherwise around edges of tets that are positive"
                               : bent.tightness.describe();
  }

  void report(const Choice& choice, const BentMap& bent) {
    report_.scale = choice.scale;
    report_.cells = static_cast<std::uint64_t>(std::llround(choice.cells));
    const auto [least, most] = std::minmax_element(choice.integers.begin(), choice.integers.end());
    report_.shortestArc = static_cast<std::uint64_t>(*least);
    report_.longestArc = static_cast<std::uint64_t>(*most);
    report_.splitEdges = bent.splitEdges.size();
    report_.addedTets = bent.tets.size() - seamless_.corners.size();
  }

  /// @param whatWorks  outcome of the search at higher densities, for the message
  [[noreturn]] void fail(const std::string& whatWorks) const {
    const std::string message = "The map cannot be bent onto integers for about " +
                                std::to_string(std::llround(report_.cellsWanted)) + " cells: ";
    const std::string advice = ". " + whatWorks + '.';
    if (tried_.empty()) {
      const bool isRounded = report_.integersBy == "rounding";
      throw Error(ErrorCode::FlippedTet,
                  message + "none were found for the " + std::to_string(report_.arcs) +
                      " arcs of its motorcycle complex" + advice +
                      (isRounded ? " Or let HiGHS find them (pip install highsbox, and "
                                   "HEXHEX_HIGHS names its libhighs.so)."
                                 : ""));
    }
    if (flippedTet_ == kNone) {
      throw Error(ErrorCode::HalfIntegerFixedPoint,
                  message + "they leave no position for a vertex" + advice);
    }
    throw Error(ErrorCode::FlippedTet,
                message + "tets stay flipped in " + flippedWhere_ + ", after " +
                    std::to_string(report_.attempts) + " attempts" + flippedWhy_ + advice,
                {PlaceKind::Tet, flippedTet_});
  }

  const QuantizeOptions& options_;
  Context& context_;
  SeamlessMap seamless_;
  IrregularEdges irregularEdges_;
  std::array<std::optional<BlockStructure>, 2> blocks_;  ///< with all walls; without needless ones
  IntegerSolver solver_ = integerSolver();
  QuantizeReport report_;
  /// Attempts so far: with splits, with reduced blocks, integers. Densities close to each other
  /// often lead to the same integers.
  std::set<std::tuple<bool, bool, std::vector<std::int64_t>>> tried_;
  double steps_ = 0;         ///< of the solver, in all attempts
  double mostCells_ = 0;     ///< the highest number attempted
  double leastFlipped_ = 1;  ///< the lowest share of flipped tets after an attempt
  Index flippedTet_ = kNone;
  /// Where and why that tet is flipped, in words. The tet is that of the last attempt close to the
  /// requested density, or else of the first one that has flipped tets.
  std::string flippedWhere_;
  std::string flippedWhy_;
};

}  // namespace

FoundMap findBentMap(SeamlessMap seamless, const TetMapView& map, const QuantizeOptions& options,
                     Context& context) {
  const double cells = cellsWanted(map, seamless, options);
  return Search(std::move(seamless), cells, options, context).run();
}

}  // namespace hexhex::quantization
