// The public entries of curved meshes.
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <hexhex/curved.hpp>
#include <hexhex/extractor.hpp>

#include <base/parallel.hpp>
#include <curved/arc_guest.hpp>
#include <curved/arcs.hpp>
#include <curved/edge_guest.hpp>
#include <curved/lagrange.hpp>
#include <curved/patches.hpp>
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

/// The arc of every edge.
/// @param keys  of arcs, in their order
Array<Index> arcsOfEdges(const ElementNumbers& edges, std::span<const EdgeKey> keys, Stage& stage) {
  Array<Index> arcOf(keys.size());
  parallelBlocks(stage, keys.size(), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   LineHint hint;
                   for (std::size_t arc = begin; arc < end; ++arc) {
                     const EdgeKey& key = keys[arc];
                     arcOf[edges.find(key.tet, key.axis, key.z, hint)] = static_cast<Index>(arc);
                   }
                 });
  return arcOf;
}

/// Looks on while an engine finds the mesh, and adds the parts of a piecewise-linear one.
class PartsOfMesh {
 public:
  /// @param map  scaled
  PartsOfMesh(const PreparedMap& map, PiecewiseLinearParts parts, Engine engine)
      : map_(map), withPatches_(parts == PiecewiseLinearParts::ArcsAndPatches) {
    if (engine == Engine::Atlas) {
      guests_.sweep = &edgeGuest_.emplace(map);
    } else {
      guests_.trace = &arcGuest_.emplace(map, withPatches_);
    }
  }
  PartsOfMesh(const PartsOfMesh&) = delete;
  PartsOfMesh& operator=(const PartsOfMesh&) = delete;
  PartsOfMesh(PartsOfMesh&&) = delete;
  PartsOfMesh& operator=(PartsOfMesh&&) = delete;
  ~PartsOfMesh() = default;

  /// Of the engine.
  [[nodiscard]] const EngineGuests& guests() const noexcept { return guests_; }

  /// When the engine is done.
  void add(PiecewiseLinearMesh& result, Context& context) {
    Stage arcStage(context, "arcs");
    if (edgeGuest_) {
      const auto [vertices, edges] = edgeGuest_->finish(arcStage);
      result.arcs = traceArcs(map_, vertices, edges, arcStage);
      arcStage.finish();
      if (withPatches_) {
        Stage stage(context, "patches");
        addPatches(vertices, edges, {}, result, stage);
      }
    } else {
      result.arcs = arcGuest_->takeArcs();
      arcStage.finish();
      if (withPatches_) {
        Stage stage(context, "patches");
        addPatchesOfArcGuest(result, stage);
      }
    }
    toCallersCorners(map_.input, result.arcs.generatorCorners, arcStage);
    toCallersCorners(map_.input, result.arcs.segmentCorners, arcStage);
  }

 private:
  void addPatches(const LatticeNumbers& vertices, const ElementNumbers& edges,
                  std::span<const Index> arcOf, PiecewiseLinearMesh& result, Stage& stage) const {
    const ElementNumbers faces(map_, ElementKind::Faces, stage);
    result.patches = cutPatches({map_, vertices, edges, faces, result.arcs, arcOf}, stage);
    toCallersCorners(map_.input, result.patches.generatorCorners, stage);
    toCallersCorners(map_.input, result.patches.polygonCorners, stage);
  }
  void addPatchesOfArcGuest(PiecewiseLinearMesh& result, Stage& stage) const {
    const LatticeNumbers vertices = arcGuest_->numbers(stage);
    const ElementNumbers edges(map_, ElementKind::Edges, stage);
    const Array<Index> arcOf = arcsOfEdges(edges, arcGuest_->keys(), stage);
    addPatches(vertices, edges, arcOf, result, stage);
  }

  const PreparedMap& map_;
  bool withPatches_;
  std::optional<EdgeGuest> edgeGuest_;  ///< of the atlas engine
  std::optional<ArcGuest> arcGuest_;    ///< of the propeller engine
  EngineGuests guests_;
};

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
    PartsOfMesh partsOfMesh(scaled.map, parts, options.engine);
    result.mesh = extractScaled(map, scaled, options, context, filled, partsOfMesh.guests());
    partsOfMesh.add(result, context);
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
  prepared_->run(
      options, {}, context, statistics, [&](std::uint64_t cells, ExtractStatistics& filled) {
        PartsOfMesh partsOfMesh(prepared_->map(), parts, options.engine);
        result.mesh = prepared_->mesh(cells, options, context, filled, partsOfMesh.guests());
        partsOfMesh.add(result, context);
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
