// J. Gregson, A. Sheffer, E. Zhang, "All-hex mesh generation via volumetric polycube deformation",
// Computer Graphics Forum 30 (2011); M. Livesu et al., "PolyCut: Monotone graph-cuts for polycube
// base-complex construction", ACM Transactions on Graphics 32 (2013).
#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <shape/labels.hpp>
#include <shape/polycube_map.hpp>
#include <shape/rotation.hpp>

#include <base/stage.hpp>

namespace hexhex::shape {
namespace {

/// Labels of which a map is tried, one after the other.
constexpr std::size_t kMostTries = 2;

std::vector<FaceFlags> flagsOf(const Surface& surface, const Labels& labels, std::size_t tets) {
  std::vector<FaceFlags> flags(tets, FaceFlags{-1, -1, -1, -1});
  for (std::size_t t = 0; t < labels.size(); ++t) {
    const adjacency::HalfFace h = surface.faces[t];
    flags[adjacency::tetOf(h)][static_cast<std::size_t>(adjacency::localOf(h))] =
        static_cast<std::int8_t>(labels[t]);
  }
  return flags;
}

/// "2 charts with fewer than four corners, 1 turning point"
std::string faultsOf(const LabelReport& report) {
  std::string text;
  const auto add = [&](std::uint64_t count, const char* what) {
    if (count == 0) return;
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + what;
  };
  add(report.badLoops, "too few corners around charts");
  add(report.badCorners, "corners of too many charts");
  add(report.oppositeEdges, "edges between opposite labels");
  add(report.turningPoints, "points where borders turn back");
  add(report.wrongTurns, "charts whose right angles do not add up");
  return text;
}

[[noreturn]] void fail(const Error& problem, const PositiveTets& tets, const LabelReport& report) {
  const std::string labels = report.isValid()
                                 ? "labels were found, but no map of them"
                                 : "the best labels that were found have " + faultsOf(report);
  throw Error(ErrorCode::NotMeshable,
              "No polycube of the shape was found: " + labels + ". " + problem.what() +
                  " Another seed may find other labels; a finer tet mesh leaves more room.",
              tets.givenPlace(problem.place()));
}

std::vector<CheckedLabels> label(PositiveTets& tets, Surface& surface, std::uint64_t seed,
                                 ShapeReport& report, Context& context) {
  Stage stage(context, "labelling");
  report.rotation = bestRotation(surface, seed);
  surface.turn(report.rotation);
  tets.turn(report.rotation);
  return labelsOf(surface, seed, stage);
}

}  // namespace

TetMap polycubeMap(PositiveTets tets, Surface surface, std::uint64_t seed, ShapeReport& report,
                   Context& context) {
  const std::vector<CheckedLabels> found = label(tets, surface, seed, report, context);
  std::optional<Error> problem;
  for (std::size_t i = 0; i < std::min(kMostTries, found.size()); ++i) {
    // What is not valid may still be good enough, but not beside what is and was not.
    if (i > 0 && !found[i].verdict.report.isValid()) break;
    report.labels = found[i].verdict.report;
    report.labelMoves = found[i].moves;
    try {
      TetMap map = mapFromFlags(
          tets.mesh(), flagsOf(surface, found[i].labels, tets.mesh().tets.size()), context);
      for (Vec3& point : map.points) point = turnedBack(report.rotation, point);
      return map;
    } catch (const Error& error) {
      if (error.code() != ErrorCode::InvalidArgument && error.code() != ErrorCode::FlippedTet) {
        throw;
      }
      if (!problem) problem = error;
    }
  }
  fail(*problem, tets, found.front().verdict.report);
}

}  // namespace hexhex::shape
