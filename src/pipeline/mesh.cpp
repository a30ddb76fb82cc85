// From tets alone to a hexahedral mesh: the stages of the library one after the other.
#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include <hexhex/error.hpp>
#include <hexhex/extractor.hpp>
#include <hexhex/mesh.hpp>

#include <base/stage.hpp>
#include <improve/moving.hpp>

namespace hexhex {

namespace pipeline {
namespace {

void requirePassed(const VerifyReport& report) {
  for (const VerifyItem& item : report.items) {
    if (item.passed) continue;
    throw Error(ErrorCode::VerificationFailed,
                "The mesh does not agree with the map of the part: " + item.name + ": expected " +
                    item.expected + ", found " + item.found +
                    ". This is a bug; please report it with the part.");
  }
}

/// Takes tagged edges for those that are found by angle, which vertices may leave if nothing else
/// helps.
ImproveReport improveWithoutTags(HexMesh& mesh, TetMapView map, const ImproveOptions& options,
                                 Context& context) {
  map.features = {};
  HexFeatures features = std::exchange(mesh.features, {});
  ImproveReport report = improve(mesh, map, options, context);
  mesh.features = std::move(features);
  return report;
}

void improvePart(MeshedPart& part, const ImproveOptions& options, Context& context) {
  HexMesh other = part.mesh;
  part.improvement = improve(part.mesh, part.map, options, context);
  if (part.improvement.after.allPositive() || part.mesh.features.edges.empty()) return;
  ImproveReport report = improveWithoutTags(other, part.map, options, context);
  if (report.notPositive.size() >= part.improvement.notPositive.size()) return;
  part.mesh = std::move(other);
  part.improvement = std::move(report);
  part.tagsReleased = true;
}

MeshedPart meshBy(ShapeMethod method, const TetMesh& tets, const MeshOptions& options,
                  Context& context) {
  ShapeOptions shape = options.shape;
  shape.method = method;
  MeshedPart part;
  const ShapedMap seamless = mapFromTets(tets, shape, context);
  part.shape = seamless.report;
  QuantizedMap quantized = quantize(seamless.map, options.quantize, context);
  part.quantization = std::move(quantized.report);
  part.map = std::move(quantized.map);
  {
    Extractor extractor(part.map, {}, context);
    part.mesh = extractor.extract({}, context);
    part.verification = extractor.verify(part.mesh, {}, context);
  }
  requirePassed(part.verification);
  improvePart(part, options.improve, context);
  return part;
}

/// What keeps one way from a mesh, and perhaps not another.
bool isOfTheWay(const Error& error) {
  return error.code() == ErrorCode::NotMeshable || error.code() == ErrorCode::FlippedTet;
}

MeshedPart meshByBest(const TetMesh& tets, const MeshOptions& options, Context& context) {
  std::optional<MeshedPart> best;
  std::optional<Error> problem;
  for (const ShapeMethod method : {ShapeMethod::Frames, ShapeMethod::Polycube}) {
    try {
      MeshedPart part = meshBy(method, tets, options, context);
      if (!best ||
          improvement::meritOf(part.improvement) > improvement::meritOf(best->improvement)) {
        best = std::move(part);
      }
    } catch (const Error& error) {
      if (!isOfTheWay(error)) throw;
      problem = error;
    }
  }
  if (!best) throw Error(*problem);
  return std::move(*best);
}

}  // namespace
}  // namespace pipeline

MeshedPart meshFromTets(const TetMesh& tets, const MeshOptions& options, Context& context) {
  constexpr std::array<WorkStep, 6> kWay = {{{"mapFromTets", 20},
                                             {"quantize", 10},
                                             {"Extractor", 0.1},
                                             {"Extractor::extract", 0.5},
                                             {"Extractor::verify", 0.3},
                                             {"improve", 10}}};
  std::vector<WorkStep> steps(kWay.begin(), kWay.end());
  if (options.shape.method == ShapeMethod::Auto) {
    steps.insert(steps.end(), kWay.begin(), kWay.end());
  }
  return inSteps(context, "meshFromTets", steps, [&] {
    return options.shape.method == ShapeMethod::Auto
               ? pipeline::meshByBest(tets, options, context)
               : pipeline::meshBy(options.shape.method, tets, options, context);
  });
}

}  // namespace hexhex
