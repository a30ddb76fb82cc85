// From tets to a hexahedral mesh: runs the stages of the library in sequence.
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <pipeline/best_way.hpp>
#include <pipeline/groups.hpp>
#include <quantize/cell_limit.hpp>
#include <shape/polycube_map.hpp>

#include <hexhex/error.hpp>
#include <hexhex/extractor.hpp>
#include <hexhex/mesh.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>

namespace hexhex {

namespace pipeline {
namespace {

/// Maximum number of polycubes to try as long as they have a map but no mesh; each takes as long as
/// the first.
constexpr std::uint64_t kMostPolycubes = 2;

/// Maximum number of tets for which both ways run at once, which takes 6 kB per tet.
constexpr std::size_t kMostTetsAtOnce = 200'000;

void requirePassed(const VerifyReport& report) {
  for (const VerifyItem& item : report.items) {
    if (item.passed) continue;
    throw Error(ErrorCode::VerificationFailed,
                "The mesh does not agree with the map of the part: " + item.name + ": expected " +
                    item.expected + ", found " + item.found +
                    ". This is a bug; please report it with the part.");
  }
}

/// Improves without tags. Edges found by angle remain, but vertices may leave them as a last
/// resort.
ImproveReport improveWithoutTags(HexMesh& mesh, TetMapView map, const ImproveOptions& options,
                                 Context& context) {
  map.features = {};
  HexFeatures features = std::exchange(mesh.features, {});
  ImproveReport report = improve(mesh, map, options, context);
  mesh.features = std::move(features);
  return report;
}

/// @param map  of the part, with the tags to preserve
void improvePart(MeshedPart& part, const TetMapView& map, const ImproveOptions& options,
                 Context& context) {
  HexMesh other = part.mesh;
  part.improvement = improve(part.mesh, map, options, context);
  if (part.improvement.after.allPositive() || part.mesh.features.edges.empty()) return;
  ImproveReport report = improveWithoutTags(other, map, options, context);
  if (report.notPositive.size() >= part.improvement.notPositive.size()) return;
  part.mesh = std::move(other);
  part.improvement = std::move(report);
  part.tagsReleased = true;
}

/// Meshes the seamless map whose report is in `part.shape`.
void meshOf(MeshedPart& part, const TetMap& seamless, const MeshOptions& options,
            Context& context) {
  QuantizedMap quantized = quantize(seamless, options.quantize, context);
  part.quantization = std::move(quantized.report);
  part.map = std::move(quantized.map);
  {
    Extractor extractor(part.map, {}, context);
    part.mesh = extractor.extract({}, context);
    part.verification = extractor.verify(part.mesh, {}, context);
  }
  requirePassed(part.verification);
  Features held;
  withThreads(context.threads(), [&] {
    Stage stage(context, "groups");
    held = heldTags(part.map, stage);
  });
  TetMapView map(part.map);
  map.features = held;
  improvePart(part, map, options.improve, context);
  withThreads(context.threads(), [&] {
    Stage stage(context, "groups");
    part.missingCurves = tagBoundary(part.map, held, part.mesh, stage);
    part.missingGroups = missingGroups(part.map, part.mesh);
  });
}

/// @throws Refusal  if another map or way may lead to a mesh
MeshedPart meshBy(const ShapeOptions& shape, const TetMesh& tets, const MeshOptions& options,
                  Context& context) {
  constexpr std::array<WorkStep, 8> kSteps = {{{"mapFromTets", 20},
                                               {"quantize", 10},
                                               {"Extractor", 0.1},
                                               {"Extractor::extract", 0.5},
                                               {"Extractor::verify", 0.3},
                                               {"groups", 0.1},
                                               {"improve", 10},
                                               {"groups", 0.1}}};
  return inSteps(context, "meshFromTets", kSteps, [&] {
    MeshedPart part;
    bool hasMap = false;
    try {
      const ShapedMap seamless = mapFromTets(tets, shape, context);
      hasMap = true;
      part.shape = seamless.report;
      meshOf(part, seamless.map, options, context);
    } catch (const Error& error) {
      if (isOfTheWay(error.code(), hasMap)) {
        throw Refusal(error, hasMap && error.code() != ErrorCode::TooLarge);
      }
      throw;
    }
    return part;
  });
}

/// Frames have one map; a polycube has one for each seed of its labelling.
MeshedPart meshBy(ShapeMethod method, const TetMesh& tets, const MeshOptions& options,
                  Context& context) {
  ShapeOptions shape = options.shape;
  shape.method = method;
  const auto meshOfMap = [&](std::uint64_t map) {
    shape.seed = options.shape.seed + map * shape::kMostAttempts;
    return meshBy(shape, tets, options, context);
  };
  return firstMesh(meshOfMap, method == ShapeMethod::Polycube ? kMostPolycubes : 1);
}

}  // namespace
}  // namespace pipeline

MeshedPart meshFromTets(const TetMesh& tets, const MeshOptions& options, Context& context) {
  // Check before spending minutes on maps; quantize() refuses what is not a positive number.
  if (options.quantize.cells > 0) quantization::requireNumberable(options.quantize.cells);
  if (options.shape.method != ShapeMethod::Auto) {
    constexpr WorkStep kOnly{"meshFromTets", 1};  // of several maps, perhaps, one after the other
    return inSteps(context, "meshFromTets", {&kOnly, 1},
                   [&] { return pipeline::meshBy(options.shape.method, tets, options, context); });
  }
  const pipeline::Way way = [&](ShapeMethod method, Context& own) {
    return pipeline::meshBy(method, tets, options, own);
  };
  constexpr WorkStep kBoth{"both ways", 1};
  return inSteps(context, "meshFromTets", {&kBoth, 1}, [&] {
    return pipeline::bestOfBothWays(way, tets.tets.size() <= pipeline::kMostTetsAtOnce, context);
  });
}

}  // namespace hexhex
