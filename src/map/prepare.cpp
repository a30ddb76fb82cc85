#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <map/local_parameters.hpp>
#include <map/plain_vertices.hpp>
#include <map/prepare.hpp>
#include <map/topology_defects.hpp>
#include <map/unfold_charts.hpp>

namespace hexhex {

namespace {

/// From a quarter on, the nearest integer stops being the obvious one for two corners of an edge.
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

PreparedMap prepare(const TetMapView& map, double tolerance, int maxScale, Context& context,
                    DefectCollector& defects, ChartChoice charts) {
  PreparedMap prepared;
  {
    Stage stage(context, "input");
    prepared.input = readInput(map, stage, defects);
    if (!defects.empty()) return prepared;
  }
  const TetMapView& view = prepared.input.view;
  defects.setCornersReversed(prepared.input.cornersReversed);
  // Flipped tets falsify angles, hence singularities, hence what is snapped where.
  if (prepared.input.flippedTets) defects.setRootCause(ErrorCode::FlippedTet);
  {
    Stage stage(context, "topology");
    prepared.topology = buildTopology(view, stage, defects);
    if (!defects.empty()) return prepared;
  }
  Unfolding unfolding;
  if (charts == ChartChoice::Unfolded && needsUnfolding(prepared.topology, prepared.input)) {
    Stage stage(context, "unfolding");
    unfolding = unfoldCharts(prepared.topology, prepared.input, stage);
    prepared.isUnfolded = true;
  }
  const LocalParameters parameters(prepared.input);
  PlainVertices plain;
  std::vector<StarBlock> stars;
  {
    Stage stage(context, "plain vertices");
    plain = findPlainVertices(prepared.topology, parameters, stage);
  }
  Transitions transitions;
  if (!parameters.tooLarge()) {
    Stage stage(context, "transitions");
    transitions =
        computeTransitions(prepared.topology, parameters, plain, view.rotations, tolerance, stage);
    prepared.chartJumps = unfolding.countGivenJumps(prepared.topology, transitions, stage);
    if (hasManyJumps(prepared.topology, transitions)) {
      prepared.gauges = computeGauges(prepared.topology, transitions, stage);
    }
  }
  {
    Stage stage(context, "singularities");
    collectStars(prepared.topology, parameters, plain, view.edgeValences,
                 parameters.tooLarge() ? nullptr : &transitions, stars, stage);
    std::optional<Singularities> singularities =
        computeSingularities(prepared.topology, parameters, plain, view.edgeValences, stars, stage);
    if (!singularities) {
      collectTopologyDefects(prepared.topology, stage, defects);
      if (defects.empty()) throwContradiction();
      return prepared;
    }
    if (parameters.tooLarge()) {
      defects.add(ErrorCode::TooLarge, {}, parameters.largest());
      return prepared;
    }
    prepared.singularities = std::move(*singularities);
    collectMisfits(transitions, defects);
  }
  Stage stage(context, "sanitization");
  prepared.exact = sanitize(prepared.topology, parameters, std::move(transitions), plain, stars,
                            prepared.singularities, tolerance, maxScale, stage, defects);
  return prepared;
}

}  // namespace

PreparedMap prepareMap(const TetMapView& map, double tolerance, int maxScale, Context& context,
                       DefectCollector& defects, ChartChoice charts) {
  checkArguments(tolerance, maxScale);
  PreparedMap prepared = prepare(map, tolerance, maxScale, context, defects, charts);
  if (defects.empty() || !prepared.isUnfolded) return prepared;
  defects.clear();
  return prepare(map, tolerance, maxScale, context, defects, ChartChoice::AsGiven);
}

}  // namespace hexhex
