// The public entries of curved meshes.
#include <optional>
#include <string>
#include <utility>

#include <curved/arcs.hpp>
#include <curved/edge_guest.hpp>
#include <curved/lagrange.hpp>
#include <curved/patches.hpp>
#include <curved/recorded_arcs.hpp>

#include <hexhex/curved.hpp>
#include <hexhex/extractor.hpp>

#include <base/parallel.hpp>
#include <extract/prepared_extractor.hpp>
#include <extract/steps.hpp>

namespace hexhex {

namespace {

constexpr std::size_t kGrain = 1 << 16;

/// From the tets as the library orders their corners to the caller's.
void toCallersCorners(const OrientedMap& input, Array<CornerSet>& corners, Stage& stage) {
  if (!input.cornersReversed) return;
  parallelFor(stage, corners.size(), kGrain,
              [&](std::size_t i) { corners[i] = input.callersCorners(corners[i]); });
}

/// @param edges  nothing if they are still to be numbered
void addPatches(const PreparedMap& map, const LatticeNumbers& vertices, const ElementNumbers* edges,
                PiecewiseLinearMesh& result, Context& context) {
  Stage stage(context, "patches");
  std::optional<ElementNumbers> own;
  if (edges == nullptr) edges = &own.emplace(map, ElementKind::Edges, stage);
  const ElementNumbers faces(map, ElementKind::Faces, stage);
  result.patches = cutPatches({map, vertices, *edges, faces, result.arcs}, stage);
  toCallersCorners(map.input, result.patches.generatorCorners, stage);
  toCallersCorners(map.input, result.patches.polygonCorners, stage);
}

/// What arcs need of the engine that finds the mesh.
struct FindingsForArcs {
  /// @param map  scaled
  FindingsForArcs(const PreparedMap& map, Engine engine) {
    if (engine == Engine::Atlas) of.guest = &guest.emplace(map);
  }

  EngineFindings of;
  std::optional<EdgeGuest> guest;  ///< of the atlas engine
};

/// @param map    scaled
/// @param found  by the engine that found the mesh
void addParts(const PreparedMap& map, FindingsForArcs& found, PiecewiseLinearParts parts,
              PiecewiseLinearMesh& result, Context& context) {
  Stage arcStage(context, "arcs");
  const bool withPatches = parts == PiecewiseLinearParts::ArcsAndPatches;
  if (!found.guest) {
    const LatticeNumbers vertices(map, std::move(found.of.lines.value()), result.mesh.points.size(),
                                  arcStage);
    result.arcs = gatherArcs(map, vertices, std::move(found.of.edges), arcStage);
    arcStage.finish();
    if (withPatches) addPatches(map, vertices, nullptr, result, context);
  } else {
    const auto [vertices, edges] = found.guest->finish(arcStage);
    result.arcs = traceArcs(map, vertices, edges, arcStage);
    arcStage.finish();
    if (withPatches) addPatches(map, vertices, &edges, result, context);
  }
  toCallersCorners(map.input, result.arcs.generatorCorners, arcStage);
  toCallersCorners(map.input, result.arcs.segmentCorners, arcStage);
}

void requireOrder(int order) {
  if (order >= 1 && order <= kMaxOrder) return;
  throw Error(ErrorCode::InvalidArgument, "The order is " + std::to_string(order) +
                                              ". Choose one from 1 to " +
                                              std::to_string(kMaxOrder) + ".");
}

/// @param map  scaled for the mesh; receives the scale of the nodes
LagrangeMesh withNodes(HexMesh mesh, PreparedMap& map, int order, Context& context) {
  LagrangeMesh result = groupNodes(mesh, map, order, context);
  result.features = std::move(mesh.features);
  result.regions = std::move(mesh.regions);
  return result;
}

}  // namespace

PiecewiseLinearMesh extractPiecewiseLinear(const TetMapView& map, PiecewiseLinearParts parts,
                                           const ExtractOptions& options, Context& context,
                                           ExtractStatistics* statistics) {
  checkOptions(options);
  PiecewiseLinearMesh result;
  runExtraction({}, context, statistics, [&](ExtractStatistics& filled) {
    ScaledMap scaled = prepareScaled(map, options, {}, context, filled);
    FindingsForArcs findings(scaled.map, options.engine);
    result.mesh = extractScaled(map, scaled, options, context, filled, &findings.of);
    addParts(scaled.map, findings, parts, result, context);
  });
  return result;
}

LagrangeMesh extractLagrange(const TetMapView& map, int order, const ExtractOptions& options,
                             Context& context, ExtractStatistics* statistics) {
  requireOrder(order);
  checkOptions(options);
  LagrangeMesh result;
  runExtraction({}, context, statistics, [&](ExtractStatistics& filled) {
    ScaledMap scaled = prepareScaled(map, options, {order}, context, filled);
    result =
        withNodes(extractScaled(map, scaled, options, context, filled), scaled.map, order, context);
  });
  return result;
}

PiecewiseLinearMesh Extractor::extractPiecewiseLinear(PiecewiseLinearParts parts,
                                                      const ExtractOptions& options,
                                                      Context& context,
                                                      ExtractStatistics* statistics) {
  PiecewiseLinearMesh result;
  prepared_->run(options, {}, context, statistics,
                 [&](std::uint64_t cells, ExtractStatistics& filled) {
                   FindingsForArcs findings(prepared_->map(), options.engine);
                   result.mesh = prepared_->mesh(cells, options, context, filled, &findings.of);
                   addParts(prepared_->map(), findings, parts, result, context);
                 });
  return result;
}

LagrangeMesh Extractor::extractLagrange(int order, const ExtractOptions& options, Context& context,
                                        ExtractStatistics* statistics) {
  requireOrder(order);
  LagrangeMesh result;
  prepared_->run(options, {order}, context, statistics,
                 [&](std::uint64_t cells, ExtractStatistics& filled) {
                   HexMesh mesh = prepared_->mesh(cells, options, context, filled);
                   result = withNodes(std::move(mesh), prepared_->mapToScale(), order, context);
                 });
  return result;
}

}  // namespace hexhex
