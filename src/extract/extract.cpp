// The public functions: options and errors around the engines.
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include <hexhex/extract.hpp>
#include <hexhex/io.hpp>
#include <hexhex/stream.hpp>

#include <atlas/atlas.hpp>
#include <extract/mesh_tags.hpp>
#include <extract/steps.hpp>
#include <igm/measures.hpp>
#include <propeller/propeller.hpp>
#include <repair/repair_map.hpp>

namespace hexhex::extraction {

namespace {

/// Whether to try a repair, even if this build can only say that it cannot: for flipped and flat
/// tets, and for what they may have caused, as they falsify angles around edges and thereby
/// singularities. Other defects are repaired only if rounding was requested.
bool isToBeRepaired(const igm::DefectCollector& defects, const ExtractOptions& options) {
  if (options.repair == nullptr) return false;
  const auto found = [&](ErrorCode code) { return defects.has(code); };
  return options.round || found(ErrorCode::FlippedTet) || found(ErrorCode::SingularityOffLattice) ||
         found(ErrorCode::TransitionResidual) || found(ErrorCode::HalfIntegerFixedPoint);
}

/// Prepares the map, or what a repair makes of it.
ValidMap prepareOrRepair(const TetMapView& map, int maxScale, const EngineOptions& options,
                         Context& context) {
  std::shared_ptr<const TetMap> before;  // of an earlier call: it may own the map of this one
  if (options.repair != nullptr) before = std::exchange(*options.repair, {}).map;
  {
    igm::DefectCollector defects;
    igm::PreparedMap prepared = igm::prepareMap(map, options.tolerance, maxScale, context, defects,
                                                igm::ChartChoice::Unfolded, options.switches);
    if (defects.empty()) return {std::move(prepared), map, std::move(before)};
    if (!isToBeRepaired(defects, options)) defects.throwIfAny();
  }
  const RepairOptions repair{options.tolerance, maxScale, options.round, true};
  auto repaired = std::make_shared<const TetMap>(
      repairs::repairInArena(map, repair, context, options.repair->report));
  igm::DefectCollector defects;
  igm::PreparedMap prepared =
      igm::prepareMap(*repaired, options.tolerance, maxScale, context, defects,
                      igm::ChartChoice::Unfolded, options.switches);
  defects.throwIfAny();
  options.repair->map = repaired;
  return {std::move(prepared), *repaired, repaired};
}

}  // namespace

ValidMap prepareValid(const TetMapView& map, int maxScale, const EngineOptions& options,
                      Context& context, ExtractStatistics& statistics) {
  requireValidTags(map);
  ValidMap valid = prepareOrRepair(map, maxScale, options, context);
  const igm::PreparedMap& prepared = valid.prepared;
  statistics.mirrored = prepared.input.mirrored;
  statistics.tetsInvertedInSpace = prepared.input.tetsInvertedInSpace;
  statistics.maxDisplacement = prepared.exact.maxDisplacement;
  statistics.maxTransitionResidual = prepared.exact.transitions.maxResidual;
  statistics.chartJumps = prepared.chartJumps;
  statistics.innerFaces = prepared.exact.transitions.innerFaces;
  statistics.singularEdges = prepared.singularities.edges.size();
  return valid;
}

namespace {

constexpr std::array<WorkStep, 5> kPropellerSteps = {{{"stars", 0.1},
                                                      {"vertices", 4},
                                                      {"local connectivity", 8},
                                                      {"global connectivity", 12},
                                                      {"cells", 8}}};

}  // namespace

HexMesh runEngine(igm::PreparedMap& map, std::uint64_t expectedCells, const EngineOptions& options,
                  Context& context, ExtractStatistics& statistics, sweep::SweepObserver* observer) {
  if (options.engine == Engine::Atlas) {
    return atlas::runAtlas(map, expectedCells, context, statistics, options.switches, observer);
  }
  const WorkSteps steps(context, "engine", kPropellerSteps);
  {
    Stage stage(context, "stars");
    adjacency::addStars(map.topology, stage);
  }
  return propeller::runPipeline(map, expectedCells, options.epsilon, context, statistics);
}

void throwOutOfMemory() {
  throw Error(ErrorCode::OutOfMemory,
              "Not enough memory for the extraction. Lower the scale, extract piece by piece, or "
              "use a machine with more memory.");
}

ScaledMap prepareScaled(const TetMapView& map, const EngineOptions& options,
                        const ScaleLimits& limits, Context& context,
                        ExtractStatistics& statistics) {
  if (options.scale > std::numeric_limits<int>::max() / limits.furtherScale) {
    throw Error(ErrorCode::TooLarge, "The scale is too large. Lower it.");
  }
  ValidMap valid =
      prepareValid(map, options.scale * limits.furtherScale, options, context, statistics);
  ScaledMap scaled{std::move(valid.prepared), valid.source, std::move(valid.owner)};
  Stage stage(context, "scaling");
  igm::ExactMap& exact = scaled.map.exact;
  scaled.expectedCells =
      igm::scaledCells(igm::parametricVolume(exact), options.scale, limits.cells);
  igm::scaleMap(exact, options.scale, stage);
  return scaled;
}

HexMesh extractScaled(ScaledMap& scaled, const EngineOptions& options, Context& context,
                      ExtractStatistics& statistics, sweep::SweepObserver* observer) {
  HexMesh mesh =
      runEngine(scaled.map, scaled.expectedCells, options, context, statistics, observer);
  carryTags(scaled.source, scaled.map, mesh, context);
  return mesh;
}

HexMesh extractWith(const TetMapView& map, const EngineOptions& options, Context& context,
                    ExtractStatistics* statistics) {
  HexMesh mesh;
  runExtraction({"extract"}, {}, context, statistics, [&](ExtractStatistics& filled) {
    ScaledMap scaled = prepareScaled(map, options, {}, context, filled);
    mesh = extractScaled(scaled, options, context, filled);
  });
  return mesh;
}

}  // namespace hexhex::extraction

namespace hexhex {

HexMesh extract(const TetMapView& map, const ExtractOptions& options, Context& context,
                ExtractStatistics* statistics) {
  return extraction::extractWith(map, options, context, statistics);
}

void extractTo(MeshSink& sink, const TetMapView& map, const ExtractOptions& options,
               Context& context, ExtractStatistics* statistics) {
  extraction::runExtraction({"extractTo"}, {}, context, statistics, [&](ExtractStatistics& filled) {
    const extraction::ScaledMap scaled = extraction::prepareScaled(
        map, options, {1, extraction::kMaxStreamedCells}, context, filled);
    atlas::streamAtlas(scaled.map, scaled.expectedCells, sink, context, filled);
  });
}

void extractToFile(const std::filesystem::path& file, const TetMapView& map,
                   const ExtractOptions& options, Context& context, ExtractStatistics* statistics) {
  const std::unique_ptr<MeshSink> sink = openMeshSink(file, context);
  extractTo(*sink, map, options, context, statistics);
}

HexMesh extract(const TetMapView& map, const ExtractOptions& options) {
  Context context;
  return extract(map, options, context);
}

}  // namespace hexhex
