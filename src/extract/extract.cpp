// The paper's pipeline: preprocessing, vertices, local connectivity, global connectivity, cells.
#include <hexhex/extract.hpp>

#include <chrono>
#include <extract/generator_ids.hpp>
#include <extract/global_connectivity.hpp>
#include <extract/hex_cells.hpp>
#include <extract/hex_vertices.hpp>
#include <extract/local_connectivity.hpp>
#include <limits>
#include <map/measures.hpp>
#include <map/prepare.hpp>
#include <optional>
#include <string>

namespace hexhex {

namespace {

constexpr std::size_t kGrain = 4096;

Array<NormalSigns> computeNormalSigns(const ExactMap& map, Stage& stage) {
  Array<NormalSigns> signs(map.corners.size());
  parallelFor(stage, map.corners.size(), kGrain,
              [&](std::size_t t) { signs[t] = NormalSigns(map.corners[t]); });
  return signs;
}

/// One extraction of a map that has passed all checks.
class Extraction {
 public:
  Extraction(const PreparedMap& map, std::uint64_t expectedCells, Context& context,
             ExtractStatistics& statistics)
      : map_(map), expectedCells_(expectedCells), context_(context), statistics_(statistics) {}

  /// @throws MissingVertex if epsilon was too small
  HexMesh run(double epsilon) {
    HexVertices vertices;
    Array<NormalSigns> signs;
    {
      Stage stage(context_, "vertices");
      vertices = extractVertices(map_, epsilon, stage);
    }
    LocalConnectivity local;
    {
      Stage stage(context_, "local connectivity");
      signs = computeNormalSigns(map_.exact, stage);
      local = extractLocalConnectivity(map_, signs, vertices, stage);
      // A vertex that was overlooked leaves corners behind that make up no whole number of cells.
      if (countCells(vertices, local) != expectedCells_) throw MissingVertex{0};
    }
    GlobalConnectivity global;
    {
      Stage stage(context_, "global connectivity");
      global = traceOpposites(map_, signs, vertices, local, stage);
      vertices.lines = {};
      signs = {};
    }
    HexMesh mesh;
    {
      Stage stage(context_, "cells");
      mesh.cells = collectCells(vertices, local, global, stage);
      if (mesh.cells.size() != expectedCells_) throw MissingVertex{0};
      describeGenerators(map_, vertices, mesh, stage);
      count(vertices, local, global);
      mesh.points = std::move(vertices.positions);
    }
    return mesh;
  }

 private:
  void count(const HexVertices& vertices, const LocalConnectivity& local,
             const GlobalConnectivity& global) {
    statistics_.generators = {};
    statistics_.vertices = {};
    for (const Generator& generator : vertices.generators) {
      const auto kind = static_cast<std::size_t>(generator.kind());
      ++statistics_.generators[kind];
      statistics_.vertices[kind] += generator.vertexCount;
    }
    statistics_.localPropellers = 0;
    for (std::size_t i = kConstantConfigurations; i < local.configurations.size(); ++i) {
      statistics_.localPropellers += local.configurations[i].propellerCount;
    }
    statistics_.globalPropellers = global.opposites.size();
  }

  const PreparedMap& map_;
  std::uint64_t expectedCells_;
  Context& context_;
  ExtractStatistics& statistics_;
};

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
  Extraction extraction(prepared, expectedCells, context, statistics);
  statistics.epsilon = options.epsilon;
  try {
    return extraction.run(options.epsilon);
  } catch (const MissingVertex&) {
    if (!(options.epsilon < TetRasterizer::kEverything)) throw;
  }
  // Section 5.2.3: with infinite epsilon all points of the bounding box are tried.
  statistics.epsilonFallback = true;
  statistics.epsilon = std::numeric_limits<double>::infinity();
  return extraction.run(statistics.epsilon);
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
