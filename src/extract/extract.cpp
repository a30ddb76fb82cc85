// The public entry: options and errors around the paper's pipeline.
#include <chrono>
#include <limits>
#include <optional>
#include <string>

#include <hexhex/extract.hpp>

#include <extract/global_connectivity.hpp>
#include <extract/pipeline.hpp>
#include <map/measures.hpp>
#include <map/prepare.hpp>

namespace hexhex {

namespace {

void checkOptions(const ExtractOptions& options) {
  if (!(options.epsilon >= 0)) {
    throw Error(ErrorCode::InvalidArgument, "Epsilon is " + std::to_string(options.epsilon) +
                                                ". Choose a number from 0, or infinity.");
  }
}

HexMesh extractInArena(const TetMapView& map, const ExtractOptions& options, Context& context,
                       ExtractStatistics& statistics) {
  DefectCollector defects;
  PreparedMap prepared = prepareMap(map, options.tolerance, options.scale, context, defects);
  defects.throwIfAny();
  statistics.mirrored = prepared.input.mirrored;
  statistics.tetsInvertedInSpace = prepared.input.tetsInvertedInSpace;
  statistics.maxDisplacement = prepared.exact.maxDisplacement;
  statistics.maxTransitionResidual = prepared.exact.transitions.maxResidual;
  statistics.chartJumps = prepared.exact.transitions.jumps;
  statistics.innerFaces = prepared.exact.transitions.innerFaces;
  statistics.singularEdges = prepared.singularities.edges.size();
  const auto s = static_cast<std::uint64_t>(options.scale);
  std::uint64_t expectedCells = 0;
  {
    Stage stage(context, "scaling");
    expectedCells = parametricVolume(prepared.exact, stage) * s * s * s;
    scaleMap(prepared.exact, options.scale, stage);
  }
  return runPipeline(prepared, expectedCells, options.epsilon, context, statistics);
}

}  // namespace

HexMesh extract(const TetMapView& map, const ExtractOptions& options, Context& context,
                ExtractStatistics* statistics) {
  checkOptions(options);
  const auto begin = std::chrono::steady_clock::now();
  ExtractStatistics local;
  ExtractStatistics& filled = statistics != nullptr ? *statistics : local;
  filled = {};
  HexMesh mesh;
  try {
    withThreads(context.threads(), [&] { mesh = extractInArena(map, options, context, filled); });
  } catch (const MissingVertex& missing) {
    throw Error(ErrorCode::Internal,
                "The map passed all checks, but a hex vertex is missing. This is a bug; please "
                "report it with the map.",
                {PlaceKind::Tet, missing.tet});
  } catch (const std::bad_alloc&) {
    throw Error(ErrorCode::OutOfMemory,
                "Not enough memory for the extraction. Lower the scale, or use a machine with more "
                "memory.");
  }
  filled.threads = effectiveThreads(context.threads());
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  filled.seconds = seconds.count();
  return mesh;
}

HexMesh extract(const TetMapView& map, const ExtractOptions& options) {
  Context context;
  return extract(map, options, context);
}

}  // namespace hexhex
