// Makes a map for a part that has none: of a polycube, or along a frame field.
#include <string>

#include <hexhex/shape.hpp>

#if defined(HEXHEX_HAS_QUANTIZE)
#include <algorithm>
#include <array>
#include <limits>
#include <numbers>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <quantize/quantized_map.hpp>
#include <shape/frames_map.hpp>
#include <shape/polycube_map.hpp>
#include <shape/positive_tets.hpp>
#include <shape/sharp_edges.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#else
#include <base/missing_library.hpp>
#endif

namespace hexhex {

#if defined(HEXHEX_HAS_QUANTIZE)
namespace shape {
namespace {

void requireInRange(const ShapeOptions& options) {
  if (options.featureAngle >= 0 && options.featureAngle <= 180) return;
  throw Error(ErrorCode::InvalidArgument,
              "The feature angle has to be from 0 to 180 degrees, and is " +
                  std::to_string(options.featureAngle) + ".");
}

/// Maximum numbers of tets for frames and for polycubes; more take minutes and gigabytes.
constexpr std::size_t kMostForFrames = 250'000;
constexpr std::size_t kMostTets = 500'000;

void requireFewEnough(const TetMesh& tets) {
  if (tets.tets.size() <= kMostTets) return;
  throw Error(ErrorCode::TooLarge,
              "The part has " + std::to_string(tets.tets.size()) +
                  " tets; maps are made of up to " + std::to_string(kMostTets) +
                  ". Tets about as large as the hexahedra are small enough: mesh the part with "
                  "longer edges. The number of hexahedra does not depend on it.");
}

TetMap framesMap(const PositiveTets& tets, const ShapeOptions& options, Context& context) {
  if (tets.mesh().tets.size() > kMostForFrames) {
    throw Error(ErrorCode::NotMeshable,
                "Frames are found for up to " + std::to_string(kMostForFrames) +
                    " tets, and here are " + std::to_string(tets.mesh().tets.size()) + ".");
  }
  Stage stage(context, "frames");
  try {
    return mapFromFrames(tets.mesh(), options.featureAngle, stage);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::TransitionResidual && error.code() != ErrorCode::FlippedTet) {
      throw;
    }
    throw Error(ErrorCode::NotMeshable, error.what(), tets.givenPlace(error.place()));
  }
}

/// Adds untagged sharp edges with a new tag.
void addSharpEdges(const std::vector<FeatureEdge>& sharp, Features& features) {
  std::int32_t tag = 1;
  std::set<std::array<Index, 2>> known;
  for (const FeatureEdge& edge : features.edges) {
    if (edge.tag == 0) continue;
    const auto [a, b] = edge.vertices;
    known.insert({std::min(a, b), std::max(a, b)});
    if (edge.tag >= tag && edge.tag < std::numeric_limits<std::int32_t>::max()) tag = edge.tag + 1;
  }
  for (const FeatureEdge& edge : sharp) {
    if (!known.contains(edge.vertices)) features.edges.push_back({edge.vertices, tag});
  }
  if (!known.empty()) features.names.push_back({1, tag, "sharp"});
}

ShapedMap finish(const TetMesh& given, TetMap map, const ShapeOptions& options, ShapeReport report,
                 Context& context) {
  Stage stage(context, "features");
  std::copy(given.points.begin(), given.points.end(), map.points.begin());
  report.addedTets = map.tets.size() - given.tets.size();
  // With frames, all features are edges of the mesh.
  const FoundFeatures features = featuresOf(map, options.featureAngle * std::numbers::pi / 180,
                                            report.method == ShapeMethod::Frames, stage);
  report.featureEdges = features.count;
  report.taggedEdges = features.aligned;
  report.innerFaces = features.innerFaces;
  report.alignedFaces = features.alignedFaces;
  report.alignedArea = features.alignedArea;
  addSharpEdges(features.tagged, map.features);
  report.distortion = quantization::distortionOf(map.points, map.tets, map.parameters);
  return {std::move(map), report};
}

ShapedMap mapBy(ShapeMethod method, const TetMesh& given, const PositiveTets& tets,
                const Surface& surface, const ShapeOptions& options, Context& context) {
  ShapeReport report;
  report.method = method;
  TetMap map = method == ShapeMethod::Frames
                   ? framesMap(tets, options, context)
                   : polycubeMap(tets, surface, options.seed, workFor(tets.mesh().tets.size()),
                                 report, context);
  return finish(given, std::move(map), options, report, context);
}

ShapedMap makeMap(const TetMesh& given, const ShapeOptions& options, Context& context) {
  const PositiveTets tets(given);
  const Surface surface = readSurface(tets, context);
  if (options.method != ShapeMethod::Auto) {
    return mapBy(options.method, given, tets, surface, options, context);
  }
  std::optional<Error> noFrames;
  try {
    return mapBy(ShapeMethod::Frames, given, tets, surface, options, context);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::NotMeshable) throw;
    noFrames = error;
  }
  try {
    return mapBy(ShapeMethod::Polycube, given, tets, surface, options, context);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::NotMeshable) throw;
    throw Error(error.code(), std::string(error.what()) + " Frames: " + noFrames->what(),
                error.place());
  }
}

}  // namespace
}  // namespace shape

ShapedMap mapFromTets(const TetMesh& tets, const ShapeOptions& options, Context& context) {
  constexpr std::array<WorkStep, 5> kSteps = {
      {{"surface", 0.1}, {"frames", 6}, {"labelling", 2}, {"mapFromFlags", 4}, {"features", 0.1}}};
  return inSteps(context, "mapFromTets", kSteps, [&] {
    shape::requireInRange(options);
    shape::requireFewEnough(tets);
    ShapedMap result;
    withThreads(context.threads(), [&] { result = shape::makeMap(tets, options, context); });
    return result;
  });
}
#else
ShapedMap mapFromTets(const TetMesh& /*tets*/, const ShapeOptions& /*options*/,
                      Context& /*context*/) {
  failWithoutLibrary("make maps of tets", "Eigen (libeigen3-dev)");
}
#endif

}  // namespace hexhex
