// A map for a part that has none: labels for its boundary, and a polycube's map from these.
#include <string>

#include <hexhex/shape.hpp>

#if defined(HEXHEX_HAS_QUANTIZE)
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <quantize/polycube/labels.hpp>
#include <quantize/quantized_map.hpp>
#include <shape/features.hpp>
#include <shape/labels.hpp>
#include <shape/rotation.hpp>
#include <shape/surface.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <igm/defects.hpp>
#endif

namespace hexhex {

#if defined(HEXHEX_HAS_QUANTIZE)
namespace shape {
namespace {

/// Labels of which a map is tried, one after the other.
constexpr std::size_t kMostTries = 2;

void requireInRange(const ShapeOptions& options) {
  if (options.featureAngle >= 0 && options.featureAngle <= 180) return;
  throw Error(ErrorCode::InvalidArgument,
              "The feature angle has to be from 0 to 180 degrees, and is " +
                  std::to_string(options.featureAngle) + ".");
}

/// Tets whose corners are in an order that makes them positive in space.
class PositiveTets {
 public:
  explicit PositiveTets(const TetMesh& given) : mesh_(given), isSwapped_(given.tets.size()) {
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
      Tet& tet = mesh_.tets[t];
      const auto exists = [&](Index v) { return v < mesh_.points.size(); };
      if (!std::all_of(tet.begin(), tet.end(), exists)) continue;  // an error later on
      const auto edge = [&](std::size_t i) {
        return minus(mesh_.points[tet[i]], mesh_.points[tet[0]]);
      };
      isSwapped_[t] = tripleProduct(edge(1), edge(2), edge(3)) < 0;
      if (isSwapped_[t]) std::swap(tet[2], tet[3]);
    }
  }

  [[nodiscard]] const TetMesh& mesh() const { return mesh_; }
  void turn(const Rotation& rotation) {
    for (Vec3& point : mesh_.points) point = turned(rotation, point);
  }
  [[nodiscard]] Place givenPlace(const Place& place) const {
    if (place.kind != PlaceKind::Face || !isSwapped_[place.index] || place.second < 2) return place;
    return {place.kind, place.index, 5 - place.second};
  }

 private:
  TetMesh mesh_;
  std::vector<bool> isSwapped_;
};

/// The boundary of tets that are a manifold.
Surface readSurface(const PositiveTets& tets, Context& context) {
  Stage stage(context, "surface");
  try {
    quantization::LabelledMesh mesh = quantization::readUnlabelled(tets.mesh(), stage);
    Surface surface = surfaceOf(mesh.topology, tets.mesh().points);
    if (isManifold(surface)) return surface;
    igm::DefectCollector defects;
    igm::collectTopologyDefects(mesh.topology, stage, defects);
    defects.throwIfAny();
    throw Error(ErrorCode::Internal, "The boundary is no manifold, but the tets are.");
  } catch (const Error& error) {
    if (error.code() != ErrorCode::Orientation) throw;
    throw Error(ErrorCode::Orientation,
                "Two tets lie on the same side of the triangle between them: one of them is folded "
                "over. Mesh the object again, or move vertices there.",
                tets.givenPlace(error.place()));
  }
}

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

class PolycubeMapper {
 public:
  PolycubeMapper(const TetMesh& given, const ShapeOptions& options, Context& context)
      : given_(given), options_(options), context_(context), tets_(given) {}

  ShapedMap run() {
    Surface surface = readSurface(tets_, context_);
    std::vector<CheckedLabels> found = label(surface);
    std::optional<Error> problem;
    for (std::size_t i = 0; i < std::min(kMostTries, found.size()); ++i) {
      // What is not valid may still be good enough, but not beside what is and was not.
      if (i > 0 && !found[i].verdict.report.isValid()) break;
      result_.report.labels = found[i].verdict.report;
      result_.report.labelMoves = found[i].moves;
      try {
        return finish(mapFromFlags(
            tets_.mesh(), flagsOf(surface, found[i].labels, given_.tets.size()), context_));
      } catch (const Error& error) {
        if (error.code() != ErrorCode::InvalidArgument && error.code() != ErrorCode::FlippedTet) {
          throw;
        }
        if (!problem) problem = error;
      }
    }
    fail(*problem, found.front().verdict.report);
  }

 private:
  std::vector<CheckedLabels> label(Surface& surface) {
    Stage stage(context_, "labelling");
    result_.report.method = ShapeMethod::Polycube;
    result_.report.rotation = bestRotation(surface, options_.seed);
    surface.turn(result_.report.rotation);
    tets_.turn(result_.report.rotation);
    return labelsOf(surface, options_.seed, stage);
  }

  [[noreturn]] void fail(const Error& problem, const LabelReport& report) const {
    const std::string labels = report.isValid()
                                   ? "labels were found, but no map of them"
                                   : "the best labels that were found have " + faultsOf(report);
    throw Error(ErrorCode::NotMeshable,
                "No polycube of the shape was found: " + labels + ". " + problem.what() +
                    " Another seed may find other labels; a finer tet mesh leaves more room.",
                tets_.givenPlace(problem.place()));
  }

  ShapedMap finish(TetMap map) {
    Stage stage(context_, "features");
    std::copy(given_.points.begin(), given_.points.end(), map.points.begin());
    for (std::size_t v = given_.points.size(); v < map.points.size(); ++v) {
      map.points[v] = turnedBack(result_.report.rotation, map.points[v]);
    }
    ShapeReport& report = result_.report;
    report.addedTets = map.tets.size() - given_.tets.size();
    const FoundFeatures features =
        featuresOf(map, options_.featureAngle * std::numbers::pi / 180, stage);
    report.featureEdges = features.count;
    report.taggedEdges = features.aligned.size();
    map.features.edges = features.aligned;
    report.distortion = quantization::distortionOf(map.points, map.tets, map.parameters);
    result_.map = std::move(map);
    return std::move(result_);
  }

  const TetMesh& given_;
  const ShapeOptions& options_;
  Context& context_;
  PositiveTets tets_;
  ShapedMap result_;
};

}  // namespace
}  // namespace shape

ShapedMap mapFromTets(const TetMesh& tets, const ShapeOptions& options, Context& context) {
  constexpr std::array<WorkStep, 4> kSteps = {
      {{"surface", 0.1}, {"labelling", 2}, {"mapFromFlags", 4}, {"features", 0.1}}};
  return inSteps(context, "mapFromTets", kSteps, [&] {
    shape::requireInRange(options);
    ShapedMap result;
    withThreads(context.threads(),
                [&] { result = shape::PolycubeMapper(tets, options, context).run(); });
    return result;
  });
}
#else
ShapedMap mapFromTets(const TetMesh& /*tets*/, const ShapeOptions& /*options*/,
                      Context& /*context*/) {
  throw Error(ErrorCode::InvalidArgument,
              "This build of hexhex cannot make maps of tets. Install Eigen (libeigen3-dev) and "
              "build it anew.");
}
#endif

}  // namespace hexhex
