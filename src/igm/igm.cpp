// Runs the steps of Section 5.1 in sequence.
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <igm/defects.hpp>
#include <igm/igm.hpp>
#include <igm/input.hpp>
#include <igm/regular_vertices.hpp>
#include <igm/unfold_charts.hpp>

namespace hexhex::igm {

namespace {

/// From a quarter on, the nearest integer is no longer the obvious one for two corners of an edge.
constexpr double kMaxTolerance = 0.25;

void checkArguments(double tolerance, int scale) {
  if (!(tolerance >= 0) || tolerance >= kMaxTolerance) {
    throw Error(ErrorCode::InvalidArgument, "The tolerance is " + std::to_string(tolerance) +
                                                ". Choose it from 0 up to, but below, 0.25.");
  }
  if (scale < 1) {
    throw Error(ErrorCode::InvalidArgument,
                "The scale is " + std::to_string(scale) + ". Choose an integer from 1.");
  }
}

[[noreturn]] void throwContradiction() {
  throw Error(ErrorCode::Internal,
              "The mesh failed a check of its topology, but nothing is wrong with it. This is a "
              "bug; please report it with the map.");
}

/// RegularVertices::isIrregular as if no vertex were certainly regular.
Array<std::uint8_t> usedVertices(const adjacency::TetTopology& topology) {
  Array<std::uint8_t> used(topology.pointCount);
  for (Index v = 0; v < topology.pointCount; ++v) used[v] = topology.isIsolated(v) ? 0 : 1;
  return used;
}

/// Measured on maps of a million tets.
constexpr std::array<WorkStep, 7> kPrepareSteps = {{{"input", 0.5},
                                                    {"topology", 4},
                                                    {"unfolding", 1},
                                                    {"regular vertices", 2},
                                                    {"transitions", 1},
                                                    {"singularities", 1},
                                                    {"sanitization", 3}}};

/// One preparation, step by step.
class Preparation {
 public:
  Preparation(const TetMapView& map, double tolerance, int maxScale, Context& context,
              DefectCollector& defects, const EngineSwitches& switches)
      : map_(map),
        tolerance_(tolerance),
        maxScale_(maxScale),
        context_(context),
        defects_(defects),
        switches_(switches) {}

  [[nodiscard]] PreparedMap run(ChartChoice charts) {
    if (!read()) return std::move(prepared_);
    Array<lattice::Gauge> unfolding;
    if (charts == ChartChoice::Unfolded && needsUnfolding(prepared_.topology, prepared_.input)) {
      Stage stage(context_, "unfolding");
      unfolding = unfoldCharts(prepared_.topology, prepared_.input, stage);
      prepared_.isUnfolded = true;
    }
    const LocalParameters parameters(prepared_.input);
    RegularVertices regular;
    {
      Stage stage(context_, "regular vertices");
      regular = findRegularVertices(prepared_.topology, parameters, stage);
      if (!switches_.regularVertices) regular.isIrregular = usedVertices(prepared_.topology);
    }
    Transitions transitions;
    if (!parameters.tooLarge()) transitions = findTransitions(parameters, unfolding, regular);
    VertexKinds vertices;
    if (!findSingularities(parameters, transitions, regular, vertices)) return std::move(prepared_);
    Stage stage(context_, "sanitization");
    prepared_.exact =
        sanitize(prepared_.topology, parameters, std::move(transitions), regular, vertices,
                 prepared_.singularities, tolerance_, maxScale_, stage, defects_);
    return std::move(prepared_);
  }

 private:
  /// @return whether the input is good enough to go on
  [[nodiscard]] bool read() {
    {
      Stage stage(context_, "input");
      prepared_.input = readInput(map_, stage, defects_);
      if (!defects_.empty()) return false;
    }
    defects_.setCornersReversed(prepared_.input.cornersReversed);
    // Flipped tets falsify angles, hence singularities, hence where vertices snap.
    if (prepared_.input.flippedTets) defects_.setRootCause(ErrorCode::FlippedTet);
    Stage stage(context_, "topology");
    prepared_.topology = buildTopology(prepared_.input.view, stage, defects_);
    return defects_.empty();
  }

  [[nodiscard]] Transitions findTransitions(const LocalParameters& parameters,
                                            const Array<lattice::Gauge>& unfolding,
                                            const RegularVertices& regular) {
    Stage stage(context_, "transitions");
    Transitions transitions = computeTransitions(prepared_.topology, parameters, regular,
                                                 prepared_.input.view.rotations, tolerance_, stage);
    prepared_.chartJumps = countGivenTransitions(prepared_.topology, transitions, unfolding, stage);
    return transitions;
  }

  /// @return whether there is an exact map to find
  [[nodiscard]] bool findSingularities(const LocalParameters& parameters,
                                       const Transitions& transitions,
                                       const RegularVertices& regular, VertexKinds& vertices) {
    Stage stage(context_, "singularities");
    const auto& valences = prepared_.input.view.edgeValences;
    const Array<HalfFaceTransition> faceTransitions =
        findHalfFaceTransitions(prepared_.topology, regular, transitions, stage);
    vertices = classifyVertices(prepared_.topology, parameters, regular, faceTransitions, valences,
                                switches_.flatStars, stage);
    std::optional<Singularities> singularities = computeSingularities(
        prepared_.topology, parameters, regular, faceTransitions, vertices, valences, stage);
    if (!singularities) {
      collectTopologyDefects(prepared_.topology, stage, defects_);
      if (defects_.empty()) throwContradiction();
      return false;
    }
    if (parameters.tooLarge()) {
      defects_.add(ErrorCode::TooLarge, {}, parameters.largest());
      return false;
    }
    for (const SingularEdge& edge : singularities->edges) {
      if (edge.boundary || edge.valence != 1) continue;
      defects_.add(ErrorCode::AmbiguousMesh, {PlaceKind::Edge, edge.vertex0, edge.vertex1}, 0);
    }
    prepared_.singularities = std::move(*singularities);
    collectMisfits(transitions, defects_);
    return true;
  }

  const TetMapView& map_;
  double tolerance_;
  int maxScale_;
  Context& context_;
  DefectCollector& defects_;
  const EngineSwitches& switches_;
  PreparedMap prepared_;
};

}  // namespace

PreparedMap prepareMap(const TetMapView& map, double tolerance, int maxScale, Context& context,
                       DefectCollector& defects, ChartChoice charts,
                       const EngineSwitches& switches) {
  checkArguments(tolerance, maxScale);
  if (!switches.unfoldCharts) charts = ChartChoice::AsGiven;
  const WorkSteps steps(context, "prepare", kPrepareSteps);
  PreparedMap prepared =
      Preparation(map, tolerance, maxScale, context, defects, switches).run(charts);
  if (defects.empty() || !prepared.isUnfolded) return prepared;
  defects.clear();
  prepared = {};  // frees its memory before the next one takes some
  return Preparation(map, tolerance, maxScale, context, defects, switches)
      .run(ChartChoice::AsGiven);
}

}  // namespace hexhex::igm
