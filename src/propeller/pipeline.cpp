// Vertices, local connectivity, global connectivity, cells.
#include <limits>
#include <utility>

#include <propeller/generator_ids.hpp>
#include <propeller/global_connectivity.hpp>
#include <propeller/hex_cells.hpp>
#include <propeller/hex_vertices.hpp>
#include <propeller/local_connectivity.hpp>
#include <propeller/pipeline.hpp>

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
      if (countCells(vertices, local) != expectedCells_) throw MissingVertex{};
    }
    GlobalConnectivity global;
    {
      Stage stage(context_, "global connectivity");
      global = traceOpposites(map_, signs, vertices, local, stage);
    }
    HexMesh mesh;
    {
      Stage stage(context_, "cells");
      mesh.cells = collectCells(map_, signs, vertices, local, global, stage);
      if (mesh.cells.size() != expectedCells_) throw MissingVertex{};
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

}  // namespace

HexMesh runPipeline(const PreparedMap& map, std::uint64_t expectedCells, double epsilon,
                    Context& context, ExtractStatistics& statistics) {
  Extraction extraction(map, expectedCells, context, statistics);
  statistics.epsilon = epsilon;
  try {
    return extraction.run(epsilon);
  } catch (const MissingVertex&) {
    if (!(epsilon < TetRasterizer::kEverything)) throw;
  }
  statistics.epsilonFallback = true;
  statistics.epsilon = std::numeric_limits<double>::infinity();
  return extraction.run(statistics.epsilon);
}

}  // namespace hexhex
