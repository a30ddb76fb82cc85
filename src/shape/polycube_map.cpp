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
#include <shape/counted_faults.hpp>
#include <shape/handle_loops.hpp>
#include <shape/labels.hpp>
#include <shape/loop_labels.hpp>
#include <shape/polycube_map.hpp>
#include <shape/rotation.hpp>

#include <base/stage.hpp>
#include <base/vector3.hpp>

namespace hexhex::shape {
namespace {

/// Budget for all attempts together, about twenty seconds.
constexpr double kMostWork = 4e7;
/// Share of the budget for attempts with labels led around handles, in addition.
constexpr double kShareOfHandles = 0.5;
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

std::string faultsOf(const LabelReport& report) {
  return countedFaults({{"too few corners around charts", report.badLoops},
                        {"corners of too many charts, or without room", report.badCorners},
                        {"edges between opposite labels", report.oppositeEdges},
                        {"points where borders turn back", report.turningPoints},
                        {"charts whose right angles do not add up", report.wrongTurns},
                        {"charts without room between two of their edges", report.flatCharts}});
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

/// The mean of 1 minus the cosine between normals and labels.
double deviationOf(const Surface& surface, const Labels& labels) {
  double sum = 0;
  for (Index t = 0; t < labels.size(); ++t) {
    sum += surface.areas[t] * (1 - cosine(surface.normals[t], labels[t]));
  }
  return sum / surface.area;
}

/// Tries labels until some have a map.
class PolycubeSearch {
 public:
  PolycubeSearch(const PositiveTets& tets, const Surface& surface, std::uint64_t seed,
                 ShapeReport& report, Context& context)
      : tets_(tets), surface_(surface), seed_(seed), report_(report), context_(context) {}

  /// @param surface  with the normals that labels are to follow
  /// @param[in,out] costs  avoids corners where no map was found
  std::optional<TetMap> run(const Surface& surface, LabelCosts& costs, double workLeft) {
    // Labels without a map mostly fail at one or two corners, close to where tets stay flipped.
    for (std::uint64_t attempt = 0; attempt < kMostAttempts && workLeft > 0; ++attempt) {
      const CheckedLabels found = label(surface, costs, attempt, workLeft);
      const bool isValid = found.verdict.report.isValid();
      // Invalid labels may have a map, but hardly where valid ones had none.
      if (problem_ && best_.isValid() && !isValid) continue;
      report_.labels = found.verdict.report;
      report_.labels.deviation = deviationOf(surface_, found.labels);
      report_.labelMoves = found.moves;
      try {
        return quantization::mapFromLabels(tets_.mesh(),
                                           flagsOf(surface, found.labels, tets_.mesh().tets.size()),
                                           workLeft, context_);
      } catch (const Error& error) {
        if (error.code() != ErrorCode::InvalidArgument && error.code() != ErrorCode::FlippedTet) {
          throw;
        }
        costs.avoidCornersAt(pointAt(tets_.mesh(), error.place()));
        if (problem_ && (best_.isValid() || !isValid)) continue;
        problem_ = error;
        best_ = found.verdict.report;
      }
    }
    isSpent_ = workLeft <= 0;
    return std::nullopt;
  }

  [[noreturn]] void fail() const {
    const std::string labels = best_.isValid()
                                   ? "labels were found, but no map of them"
                                   : "the best labels that were found have " + faultsOf(best_);
    throw Error(ErrorCode::NotMeshable,
                "No polycube of the shape was found: " + labels + ". " + problem_->what() +
                    (isSpent_ ? " The search ended at the bound of its work." : "") +
                    " Another seed may find other labels; a finer tet mesh leaves more room.",
                tets_.givenPlace(problem_->place()));
  }

 private:
  CheckedLabels label(const Surface& surface, const LabelCosts& costs, std::uint64_t attempt,
                      double& workLeft) {
    Stage stage(context_, "labelling");
    return labelsOf(surface, costs, seed_ + attempt, workLeft, stage);
  }

  const PositiveTets& tets_;
  const Surface& surface_;
  std::uint64_t seed_;
  ShapeReport& report_;
  Context& context_;
  std::optional<Error> problem_;
  LabelReport best_;  ///< of the labels that have the problem
  bool isSpent_ = false;
};

/// Searches once more with labels that wind around handles, if there are any.
std::optional<TetMap> mapAroundHandles(PolycubeSearch& search, const Surface& surface,
                                       std::uint64_t seed, double workLeft, Context& context) {
  const std::vector<HandleLoop> loops = handleLoops(surface, seed, context);
  if (loops.empty()) return std::nullopt;
  Surface bent = surface;
  const Labels required = turnAroundHandles(bent, loops);
  LabelCosts costs(bent);
  costs.require(required);
  return search.run(bent, costs, workLeft);
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
  PolycubeSearch search(tets, surface, seed, report, context);
  std::optional<TetMap> map = search.run(surface, costs, workLeft);
  if (!map) map = mapAroundHandles(search, surface, seed, kShareOfHandles * workLeft, context);
  if (!map) search.fail();
  for (Vec3& point : map->points) point = turnedBack(report.rotation, point);
  return std::move(*map);
}

}  // namespace hexhex::shape
