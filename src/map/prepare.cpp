#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <map/local_parameters.hpp>
#include <map/plain_vertices.hpp>
#include <map/prepare.hpp>
#include <map/topology_defects.hpp>
#include <map/unfolded_vertices.hpp>

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

}  // namespace

PreparedMap prepareMap(const TetMapView& map, double tolerance, int maxScale, Context& context,
                       DefectCollector& defects) {
  checkArguments(tolerance, maxScale);
  PreparedMap prepared;
  {
    Stage stage(context, "input");
    prepared.input = readInput(map, stage, defects);
    if (!defects.empty()) return prepared;
  }
  const TetMapView& view = prepared.input.view;
  const LocalParameters parameters(prepared.input);
  defects.setCornersReversed(prepared.input.cornersReversed);
  // Flipped tets falsify angles, hence singularities, hence what is snapped where.
  if (prepared.input.flippedTets) defects.setRootCause(ErrorCode::FlippedTet);
  PlainVertices plain;
  std::vector<StarBlock> stars;
  {
    Stage stage(context, "topology");
    prepared.topology = buildTopology(view, stage, defects);
    if (!defects.empty()) return prepared;
    plain = findPlainVertices(prepared.topology, parameters, stage);
  }
  Transitions transitions;
  if (!parameters.tooLarge()) {
    Stage stage(context, "transitions");
    transitions =
        computeTransitions(prepared.topology, parameters, plain, view.rotations, tolerance, stage);
    if (hasManyJumps(prepared.topology, transitions)) {
      prepared.gauges = computeGauges(prepared.topology, transitions, stage);
    }
  }
  {
    Stage stage(context, "singularities");
    std::vector<StarBlock> unfolded;
    // What the caller claims about edges is looked up for each, hence no star is spared then.
    if (!prepared.gauges.of.empty() && view.edgeValences.empty()) {
      unfolded = unfoldVertices(prepared.topology, parameters, prepared.gauges, plain, stage);
    }
    collectStars(prepared.topology, parameters, plain, view.edgeValences,
                 parameters.tooLarge() ? nullptr : &transitions, stars, stage);
    std::move(unfolded.begin(), unfolded.end(), std::back_inserter(stars));
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

}  // namespace hexhex
