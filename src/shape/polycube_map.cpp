// J. Gregson, A. Sheffer, E. Zhang, "All-hex mesh generation via volumetric polycube deformation",
// Computer Graphics Forum 30 (2011); M. Livesu et al., "PolyCut: Monotone graph-cuts for polycube
// base-complex construction", ACM Transactions on Graphics 32 (2013).
#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <quantize/polycube/polycube.hpp>
#include <shape/counted_faults.hpp>
#include <shape/labels.hpp>
#include <shape/loop_labels.hpp>
#include <shape/polycube_map.hpp>
#include <shape/rotation.hpp>

#include <base/stage.hpp>
#include <base/vector3.hpp>

namespace hexhex::shape {
namespace {

/// Rounds of smoothing per attempt. Labels of a smoothed part have fewer and larger charts: more of
/// its features cross them, but where those of the part itself have no map, they often do.
constexpr std::array<int, kMostAttempts> kSmoothing = {0, 0, 0, 10, 0, 20, 0, 5};
/// The first attempts that label the part as it is; later ones keep corners away from where others
/// had no map, which costs distance from the part.
constexpr std::uint64_t kFreeAttempts = 2;
/// Budget for all attempts together, about thirty seconds.
constexpr double kMostWork = 6e7;
/// Minimum budget in solver steps, for large meshes.
constexpr double kStepsOfAll = 300;
/// Labels by loops, where no others are valid: an additional share of the budget, and the moves of
/// their search.
constexpr double kShareOfLoops = 0.25;
constexpr std::uint64_t kMovesOfLoops = 1500;

std::vector<FaceFlags> flagsOf(const Surface& surface, const Labels& labels, std::size_t tets) {
  std::vector<FaceFlags> flags(tets, FaceFlags{-1, -1, -1, -1});
  for (std::size_t t = 0; t < labels.size(); ++t) {
    const adjacency::HalfFace h = surface.faces[t];
    flags[adjacency::tetOf(h)][static_cast<std::size_t>(adjacency::localOf(h))] =
        static_cast<std::int8_t>(labels[t]);
  }
  return flags;
}

std::string faultsOf(const LabelReport& report) {
  return countedFaults(
      {{"too few corners around charts", report.badLoops},
       {"corners of too many charts, without room, or where labels wind otherwise than normals",
        report.badCorners},
       {"edges between opposite labels", report.oppositeEdges},
       {"points where borders turn back", report.turningPoints},
       {"charts whose right angles do not add up", report.wrongTurns},
       {"charts without room between two of their edges", report.flatCharts}});
}

/// Whether an error says that labels have no map.
bool saysNoMap(const Error& error) {
  return error.code() == ErrorCode::InvalidArgument || error.code() == ErrorCode::FlippedTet;
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

/// Tries labels until some have a map.
class PolycubeSearch {
 public:
  PolycubeSearch(const PositiveTets& tets, const Surface& surface, ShapeReport& report,
                 Context& context)
      : tets_(tets), surface_(surface), costs_(surface), report_(report), context_(context) {}

  TetMap run(std::uint64_t seed, double mostWork) {
    double workLeft = mostWork;
    std::optional<CheckedLabels> invalid;  // the best of them
    for (std::uint64_t attempt = 0; attempt < kMostAttempts && workLeft > 0; ++attempt) {
      CheckedLabels found = label(attempt, seed, workLeft);
      if (found.verdict.report.isValid()) {
        if (std::optional<TetMap> map = mapOf(found, workLeft)) return std::move(*map);
      } else if (!invalid || found.verdict.energy < invalid->verdict.energy) {
        invalid = std::move(found);
      }
    }
    if (problem_) fail(workLeft <= 0, "");
    // Invalid labels hardly ever have a map, and none where valid ones do not.
    if (std::optional<TetMap> map = mapOf(*invalid, workLeft)) return std::move(*map);
    if (std::optional<TetMap> map = mapByLoops(seed, kShareOfLoops * mostWork)) {
      return std::move(*map);
    }
    fail(workLeft <= 0, " Labels by loops along handles have no map either.");
  }

 private:
  CheckedLabels label(std::uint64_t attempt, std::uint64_t seed, double& workLeft) {
    Stage stage(context_, "labelling");
    if (kSmoothing[attempt] == 0) {
      const LabelCosts costs = attempt < kFreeAttempts ? LabelCosts(surface_) : costs_;
      return labelsOf(surface_, costs, seed + attempt, workLeft, stage);
    }
    const Surface smooth = smoothed(surface_, tets_.mesh().points, kSmoothing[attempt]);
    CheckedLabels found = labelsOf(smooth, LabelCosts(smooth), seed + attempt, workLeft, stage);
    found.verdict.report.deviation = LabelCheck(surface_, costs_)(found.labels).report.deviation;
    return found;
  }

  std::optional<TetMap> mapOf(const CheckedLabels& found, double& workLeft) {
    report_.labels = found.verdict.report;
    report_.labelMoves = found.moves;
    try {
      return mapFrom(found.labels, tets_, surface_, workLeft);
    } catch (const Error& error) {
      if (!saysNoMap(error)) throw;
      // Labels without a map mostly fail at one or two corners, close to where tets stay flipped.
      costs_.avoidCornersAt(pointAt(tets_.mesh(), error.place()));
      problem_ = error;
      return std::nullopt;
    }
  }

  /// From labels by loops. Few have a map, and hardly any before a search has moved borders so that
  /// edges do not turn back.
  std::optional<TetMap> mapByLoops(std::uint64_t seed, double workLeft) {
    Stage stage(context_, "labelling");
    const std::optional<LoopLabels> loops = labelsByLoops(tets_, surface_, stage);
    if (!loops) return std::nullopt;
    const LabelCosts costs(loops->surface);
    LabelSearch search(loops->surface, costs, Random(seed, kMostAttempts));
    const CheckedLabels found = search.improve(loops->labels, kMovesOfLoops, context_);
    stage.finish();
    try {
      TetMap map = mapFrom(found.labels, loops->tets, loops->surface, workLeft);
      report_.labels = found.verdict.report;
      report_.labelMoves = found.moves;
      return map;
    } catch (const Error& error) {
      if (!saysNoMap(error)) throw;
      return std::nullopt;
    }
  }

  TetMap mapFrom(const Labels& labels, const PositiveTets& tets, const Surface& surface,
                 double& workLeft) {
    return quantization::mapFromLabels(
        tets.mesh(), flagsOf(surface, labels, tets.mesh().tets.size()), workLeft, context_);
  }

  [[noreturn]] void fail(bool isSpent, const std::string& more) const {
    const LabelReport& labels = report_.labels;
    throw Error(
        ErrorCode::NotMeshable,
        "No polycube of the shape was found: " +
            (labels.isValid() ? "labels were found, but no map of them"
                              : "the best labels that were found have " + faultsOf(labels)) +
            ". " + problem_->what() + more +
            (isSpent ? " The search ended at the bound of its work." : "") +
            " Another seed may find other labels; a finer tet mesh leaves more room.",
        tets_.givenPlace(problem_->place()));
  }

  const PositiveTets& tets_;
  const Surface& surface_;
  LabelCosts costs_;
  ShapeReport& report_;
  Context& context_;
  std::optional<Error> problem_;  ///< of the last labels without a map
};

}  // namespace

double workFor(std::size_t tets) {
  return std::max(kMostWork, kStepsOfAll * static_cast<double>(tets));
}

TetMap polycubeMap(PositiveTets tets, Surface surface, std::uint64_t seed, double workLeft,
                   ShapeReport& report, Context& context) {
  report.rotation = bestRotation(surface, seed);
  surface.turn(report.rotation);
  tets.turn(report.rotation);
  TetMap map = PolycubeSearch(tets, surface, report, context).run(seed, workLeft);
  for (Vec3& point : map.points) point = turnedBack(report.rotation, point);
  return map;
}

}  // namespace hexhex::shape
