// J. Gregson, A. Sheffer, E. Zhang, "All-hex mesh generation via volumetric polycube deformation",
// Computer Graphics Forum 30 (2011); M. Livesu et al., "PolyCut: Monotone graph-cuts for polycube
// base-complex construction", ACM Transactions on Graphics 32 (2013).
#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <quantize/polycube/polycube.hpp>
#include <shape/labels.hpp>
#include <shape/polycube_map.hpp>
#include <shape/rotation.hpp>

#include <base/stage.hpp>
#include <base/vector3.hpp>

namespace hexhex::shape {
namespace {

/// Budget for all attempts together, about twenty seconds.
constexpr double kMostWork = 4e7;
/// Minimum budget in solver steps, for large meshes.
constexpr double kStepsOfAll = 300;

std::vector<FaceFlags> flagsOf(const Surface& surface, const Labels& labels, std::size_t tets) {
  std::vector<FaceFlags> flags(tets, FaceFlags{-1, -1, -1, -1});
  for (std::size_t t = 0; t < labels.size(); ++t) {
    const adjacency::HalfFace h = surface.faces[t];
    flags[adjacency::tetOf(h)][static_cast<std::size_t>(adjacency::localOf(h))] =
        static_cast<std::int8_t>(labels[t]);
  }
  return flags;
}

/// For example "2 too few corners around charts, 1 points where borders turn back".
std::string faultsOf(const LabelReport& report) {
  std::string text;
  const auto add = [&](std::uint64_t count, const char* what) {
    if (count == 0) return;
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + what;
  };
  add(report.badLoops, "too few corners around charts");
  add(report.badCorners, "corners of too many charts, or without room");
  add(report.oppositeEdges, "edges between opposite labels");
  add(report.turningPoints, "points where borders turn back");
  add(report.wrongTurns, "charts whose right angles do not add up");
  add(report.flatCharts, "charts without room between two of their edges");
  return text;
}

/// @param isSpent  whether the search ended because the budget was used up
[[noreturn]] void fail(const Error& problem, const PositiveTets& tets, const LabelReport& report,
                       bool isSpent) {
  const std::string labels = report.isValid()
                                 ? "labels were found, but no map of them"
                                 : "the best labels that were found have " + faultsOf(report);
  throw Error(ErrorCode::NotMeshable,
              "No polycube of the shape was found: " + labels + ". " + problem.what() +
                  (isSpent ? " The search ended at the bound of its work." : "") +
                  " Another seed may find other labels; a finer tet mesh leaves more room.",
              tets.givenPlace(problem.place()));
}

CheckedLabels label(const Surface& surface, const LabelCosts& costs, std::uint64_t seed,
                    double& workLeft, Context& context) {
  Stage stage(context, "labelling");
  return labelsOf(surface, costs, seed, workLeft, stage);
}

/// The centroid of the place of an error.
Vec3 pointAt(const TetMesh& mesh, const Place& place) {
  std::vector<Vec3> points;
  if (place.kind == PlaceKind::Vertex || place.kind == PlaceKind::Edge) {
    points.push_back(mesh.points[place.index]);
    if (place.kind == PlaceKind::Edge) points.push_back(mesh.points[place.second]);
  } else {
    for (const Index v : mesh.tets[place.index]) points.push_back(mesh.points[v]);
  }
  return centreOf(points);
}

}  // namespace

double workFor(std::size_t tets) {
  return std::max(kMostWork, kStepsOfAll * static_cast<double>(tets));
}

TetMap polycubeMap(PositiveTets tets, Surface surface, std::uint64_t seed, double workLeft,
                   ShapeReport& report, Context& context) {
  report.rotation = bestRotation(surface, seed);
  surface.turn(report.rotation);
  tets.turn(report.rotation);
  LabelCosts costs(surface);
  std::optional<Error> problem;
  LabelReport best;
  // Labels without a map mostly fail at one or two corners, close to where tets stay flipped.
  for (std::uint64_t attempt = 0; attempt < kMostAttempts && workLeft > 0; ++attempt) {
    const CheckedLabels found = label(surface, costs, seed + attempt, workLeft, context);
    const bool isValid = found.verdict.report.isValid();
    // Invalid labels may have a map, but hardly where valid ones had none.
    if (problem && best.isValid() && !isValid) continue;
    report.labels = found.verdict.report;
    report.labelMoves = found.moves;
    try {
      TetMap map = quantization::mapFromLabels(
          tets.mesh(), flagsOf(surface, found.labels, tets.mesh().tets.size()), workLeft, context);
      for (Vec3& point : map.points) point = turnedBack(report.rotation, point);
      return map;
    } catch (const Error& error) {
      if (error.code() != ErrorCode::InvalidArgument && error.code() != ErrorCode::FlippedTet) {
        throw;
      }
      costs.avoidCornersAt(pointAt(tets.mesh(), error.place()));
      if (problem && (best.isValid() || !isValid)) continue;
      problem = error;
      best = found.verdict.report;
    }
  }
  fail(*problem, tets, best, workLeft <= 0);
}

}  // namespace hexhex::shape
