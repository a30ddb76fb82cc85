#include <string>
#include <utility>

#include <map/prepare.hpp>

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

}  // namespace

PreparedMap prepareMap(const TetMapView& map, double tolerance, int maxScale, Context& context,
                       DefectCollector& defects) {
  checkArguments(tolerance, maxScale);
  PreparedMap prepared;
  {
    Stage stage(context, "input");
    checkInput(map, stage, defects);
    if (!defects.empty()) return prepared;
    prepared.input = orientMap(map, stage);
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
  Stage localStage(context, "transitions");
  const LocalParameters parameters(view, localStage, defects);
  if (!defects.empty()) return prepared;
  Transitions transitions = computeTransitions(prepared.topology, parameters, view.rotations,
                                               tolerance, localStage, defects);
  localStage.finish();
  {
    Stage stage(context, "singularities");
    prepared.singularities =
        computeSingularities(prepared.topology, parameters, view.edgeValences, stage);
  }
  Stage stage(context, "sanitization");
  prepared.exact = sanitize(prepared.topology, parameters, std::move(transitions),
                            prepared.singularities, tolerance, maxScale, stage, defects);
  if (!defects.has(ErrorCode::TooLarge)) checkPositive(prepared.exact, stage, defects);
  return prepared;
}

}  // namespace hexhex
