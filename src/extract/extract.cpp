// The public entry: options and errors around the paper's pipeline.
#include <chrono>
#include <cmath>
#include <limits>
#include <new>
#include <string>

#include <atlas/atlas.hpp>

#include <hexhex/extract.hpp>
#include <hexhex/stream.hpp>

#include <extract/features.hpp>
#include <extract/global_connectivity.hpp>
#include <extract/pipeline.hpp>
#include <extract/scaled_map.hpp>
#include <map/measures.hpp>

namespace hexhex {

namespace {

void checkOptions(const ExtractOptions& options) {
  if (!(options.epsilon >= 0)) {
    throw Error(ErrorCode::InvalidArgument, "Epsilon is " + std::to_string(options.epsilon) +
                                                ". Choose a number from 0, or infinity.");
  }
}

/// cells * scale^3
/// @param limit  of what can be numbered
std::uint64_t scaledCells(std::uint64_t cells, int scale, double limit) {
  const double estimate = static_cast<double>(cells) * std::pow(scale, 3);
  if (estimate >= limit) {
    throw Error(ErrorCode::TooLarge,
                "The mesh would have about " + std::to_string(std::llround(estimate / 1e6)) +
                    " million cells, more than the " + std::to_string(std::llround(limit / 1e6)) +
                    " million that can be numbered. Lower the scale.");
  }
  const auto s = static_cast<std::uint64_t>(scale);
  return cells * s * s * s;
}

}  // namespace

ScaledMap prepareScaled(const TetMapView& map, const ExtractOptions& options,
                        const ScaleLimits& limits, Context& context,
                        ExtractStatistics& statistics) {
  DefectCollector defects;
  if (options.scale > std::numeric_limits<int>::max() / limits.furtherScale) {
    throw Error(ErrorCode::TooLarge, "The scale is too large. Lower it.");
  }
  ScaledMap scaled{prepareMap(map, options.tolerance, options.scale * limits.furtherScale, context,
                              defects)};
  defects.throwIfAny();
  PreparedMap& prepared = scaled.map;
  statistics.mirrored = prepared.input.mirrored;
  statistics.tetsInvertedInSpace = prepared.input.tetsInvertedInSpace;
  statistics.maxDisplacement = prepared.exact.maxDisplacement;
  statistics.maxTransitionResidual = prepared.exact.transitions.maxResidual;
  statistics.chartJumps = prepared.exact.transitions.jumps;
  statistics.innerFaces = prepared.exact.transitions.innerFaces;
  statistics.singularEdges = prepared.singularities.edges.size();
  Stage stage(context, "scaling");
  scaled.expectedCells =
      scaledCells(parametricVolume(prepared.exact), options.scale, limits.cells);
  scaleMap(prepared.exact, options.scale, stage);
  return scaled;
}

HexMesh extractScaled(ScaledMap& scaled, const ExtractOptions& options, Context& context,
                      ExtractStatistics& statistics) {
  if (options.engine == Engine::Atlas) {
    return runAtlas(scaled.map, scaled.expectedCells, context, statistics);
  }
  {
    Stage stage(context, "stars");
    addStars(scaled.map.topology, stage);
  }
  return runPipeline(scaled.map, scaled.expectedCells, options.epsilon, context, statistics);
}

void runExtraction(const ExtractOptions& options, Context& context, ExtractStatistics* statistics,
                   const std::function<void(ExtractStatistics&)>& work) {
  checkOptions(options);
  const auto begin = std::chrono::steady_clock::now();
  ExtractStatistics local;
  ExtractStatistics& filled = statistics != nullptr ? *statistics : local;
  filled = {};
  try {
    withThreads(context.threads(), [&] { work(filled); });
  } catch (const MissingVertex& missing) {
    throw Error(ErrorCode::Internal,
                "The map passed all checks, but a hex vertex is missing. This is a bug; please "
                "report it with the map.",
                {PlaceKind::Tet, missing.tet});
  } catch (const std::bad_alloc&) {
    throw Error(ErrorCode::OutOfMemory,
                "Not enough memory for the extraction. Lower the scale, extract piece by piece, or "
                "use a machine with more memory.");
  }
  filled.threads = effectiveThreads(context.threads());
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  filled.seconds = seconds.count();
}

HexMesh extract(const TetMapView& map, const ExtractOptions& options, Context& context,
                ExtractStatistics* statistics) {
  HexMesh mesh;
  runExtraction(options, context, statistics, [&](ExtractStatistics& filled) {
    requireValidTags(map);
    ScaledMap scaled = prepareScaled(map, options, {}, context, filled);
    mesh = extractScaled(scaled, options, context, filled);
    carryTags(map, scaled.map, mesh, context);
  });
  return mesh;
}

void extractTo(MeshSink& sink, const TetMapView& map, const ExtractOptions& options,
               Context& context, ExtractStatistics* statistics) {
  runExtraction(options, context, statistics, [&](ExtractStatistics& filled) {
    constexpr double kMaxCells = 0x1p60;
    const ScaledMap scaled = prepareScaled(map, options, {1, kMaxCells}, context, filled);
    streamAtlas(scaled.map, scaled.expectedCells, sink, context, filled);
  });
}

HexMesh extract(const TetMapView& map, const ExtractOptions& options) {
  Context context;
  return extract(map, options, context);
}

}  // namespace hexhex
