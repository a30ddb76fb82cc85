// The public entry points for curved meshes.
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include <hexhex/curved.hpp>
#include <hexhex/extractor.hpp>

#include <base/parallel.hpp>
#include <curved/arcs.hpp>
#include <curved/blending.hpp>
#include <curved/element_numbers.hpp>
#include <curved/lagrange.hpp>
#include <curved/patches.hpp>
#include <extract/prepared_extractor.hpp>
#include <extract/steps.hpp>

namespace hexhex::curved {

namespace {

constexpr std::size_t kExtractCurvedGrain = 1 << 16;

/// Converts corners from the library's order of each tet's corners to the caller's.
void toCallersCorners(const igm::OrientedMap& input, Array<CornerSet>& corners, Stage& stage) {
  if (!input.cornersReversed) return;
  parallelFor(stage, corners.size(), kExtractCurvedGrain,
              [&](std::size_t i) { corners[i] = input.callersCorners(corners[i]); });
}

/// The mesh of a map, and the parts of a piecewise-linear one.
/// @param map      scaled
/// @param extract  extract(SweepObserver*) returns the mesh, made by the atlas engine if there is
///                 an observer
template <class Extract>
PiecewiseLinearMesh withParts(const igm::PreparedMap& map, PiecewiseLinearParts parts,
                              Engine engine, Context& context, const Extract& extract) {
  PiecewiseLinearMesh result;
  std::optional<EdgeObserver> observer;
  if (engine == Engine::Atlas) observer.emplace(map);
  result.mesh = extract(observer ? &*observer : nullptr);
  Stage arcStage(context, "arcs");
  const auto [vertices, edges] =
      observer ? observer->finish(arcStage) : numberVerticesAndEdges(map, arcStage);
  result.arcs = traceArcs(map, vertices, edges, arcStage);
  arcStage.finish();
  if (parts == PiecewiseLinearParts::ArcsAndPatches) {
    Stage stage(context, "patches");
    const ElementNumbers faces(map, ElementKind::Faces, stage);
    result.patches = cutPatches({map, vertices, edges, faces, result.arcs}, stage);
    toCallersCorners(map.input, result.patches.generatorCorners, stage);
    toCallersCorners(map.input, result.patches.polygonCorners, stage);
  }
  toCallersCorners(map.input, result.arcs.generatorCorners, arcStage);
  toCallersCorners(map.input, result.arcs.segmentCorners, arcStage);
  return result;
}

void requireOrder(int order) {
  if (order >= 1 && order <= kMaxOrder) return;
  throw Error(ErrorCode::InvalidArgument, "The order is " + std::to_string(order) +
                                              ". Choose one from 1 to " +
                                              std::to_string(kMaxOrder) + ".");
}

/// @param map  scaled for the mesh; is rescaled for the nodes
LagrangeMesh withNodes(HexMesh mesh, igm::PreparedMap& map, int order, CurvedNodes nodes,
                       Context& context) {
  LagrangeMesh result = groupNodes(mesh, map, order, context);
  result.features = std::move(mesh.features);
  result.regions = std::move(mesh.regions);
  if (nodes == CurvedNodes::Blended) {
    Stage stage(context, "blending");
    result.straightenedCells = blendNodes(result, stage);
  }
  return result;
}

}  // namespace

}  // namespace hexhex::curved

namespace hexhex {

PiecewiseLinearMesh extractPiecewiseLinear(const TetMapView& map, PiecewiseLinearParts parts,
                                           const ExtractOptions& options, Context& context,
                                           ExtractStatistics* statistics) {
  PiecewiseLinearMesh result;
  const extraction::ReportedCall call{"extractPiecewiseLinear", extraction::kPiecewiseSteps};
  extraction::runExtraction(call, {}, context, statistics, [&](ExtractStatistics& filled) {
    extraction::ScaledMap scaled = extraction::prepareScaled(map, options, {}, context, filled);
    result = curved::withParts(
        scaled.map, parts, options.engine, context, [&](sweep::SweepObserver* observer) {
          return extraction::extractScaled(scaled, options, context, filled, observer);
        });
  });
  return result;
}

LagrangeMesh extractLagrange(const TetMapView& map, int order, const ExtractOptions& options,
                             Context& context, ExtractStatistics* statistics) {
  curved::requireOrder(order);
  LagrangeMesh result;
  const extraction::ReportedCall call{"extractLagrange", extraction::kLagrangeSteps};
  extraction::runExtraction(call, {}, context, statistics, [&](ExtractStatistics& filled) {
    extraction::ScaledMap scaled =
        extraction::prepareScaled(map, options, {order}, context, filled);
    result = curved::withNodes(extraction::extractScaled(scaled, options, context, filled),
                               scaled.map, order, options.curvedNodes, context);
  });
  return result;
}

PiecewiseLinearMesh Extractor::extractPiecewiseLinear(PiecewiseLinearParts parts,
                                                      const ExtractOptions& options,
                                                      Context& context,
                                                      ExtractStatistics* statistics) {
  PiecewiseLinearMesh result;
  prepared_->run({"Extractor::extractPiecewiseLinear", extraction::kPiecewiseSteps}, options, {},
                 context, statistics, [&](std::uint64_t cells, ExtractStatistics& filled) {
                   result = curved::withParts(prepared_->map(), parts, options.engine, context,
                                              [&](sweep::SweepObserver* observer) {
                                                return prepared_->mesh(cells, options, context,
                                                                       filled, observer);
                                              });
                 });
  return result;
}

LagrangeMesh Extractor::extractLagrange(int order, const ExtractOptions& options, Context& context,
                                        ExtractStatistics* statistics) {
  curved::requireOrder(order);
  LagrangeMesh result;
  prepared_->run({"Extractor::extractLagrange", extraction::kLagrangeSteps}, options, {order},
                 context, statistics, [&](std::uint64_t cells, ExtractStatistics& filled) {
                   HexMesh mesh = prepared_->mesh(cells, options, context, filled);
                   result = curved::withNodes(std::move(mesh), prepared_->mapToScale(), order,
                                              options.curvedNodes, context);
                 });
  return result;
}

}  // namespace hexhex
