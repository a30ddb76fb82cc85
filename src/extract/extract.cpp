// The public entry: options and errors around the paper's pipeline.
#include <chrono>
#include <cmath>
#include <new>
#include <string>

#include <atlas/atlas.hpp>

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

/// cells * scale^3, if it can be numbered in 32 bits.
std::uint64_t scaledCells(std::uint64_t cells, int scale) {
  const double estimate = static_cast<double>(cells) * std::pow(scale, 3);
  if (estimate >= kNone) {
    throw Error(ErrorCode::TooLarge,
                "The mesh would have about " + std::to_string(std::llround(estimate / 1e6)) +
                    " million cells, more than the 4,294 million that 32-bit indices can number. "
                    "Lower the scale.");
  }
  const auto s = static_cast<std::uint64_t>(scale);
  return cells * s * s * s;
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
  std::uint64_t expectedCells = 0;
  {
    Stage stage(context, "scaling");
    expectedCells = scaledCells(parametricVolume(prepared.exact), options.scale);
    scaleMap(prepared.exact, options.scale, stage);
  }
  if (options.engine == Engine::Atlas) {
    return runAtlas(prepared, expectedCells, context, statistics);
  }
  {
    Stage stage(context, "stars");
    addStars(prepared.topology, stage);
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
