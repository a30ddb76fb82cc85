#include <utility>

#include <propeller/global_connectivity.hpp>
#include <propeller/hex_cells.hpp>
#include <propeller/hex_vertices.hpp>
#include <propeller/local_connectivity.hpp>
#include <propeller/pipeline.hpp>

namespace hexhex::propeller {

namespace {

constexpr std::size_t kPipelineGrain = 4096;

Array<lattice::NormalSigns> computeNormalSigns(const igm::ExactMap& map, Stage& stage) {
  Array<lattice::NormalSigns> signs(map.corners.size());
  parallelFor(stage, map.corners.size(), kPipelineGrain,
              [&](std::size_t t) { signs[t] = lattice::NormalSigns(map.corners[t]); });
  return signs;
}

void count(const HexVertices& vertices, const LocalConnectivity& local,
           const GlobalConnectivity& global, ExtractStatistics& statistics) {
  statistics.generators = vertices.tables.numbers().generatorCounts;
  statistics.vertices = vertices.tables.numbers().vertexCounts;
  statistics.localPropellers = 0;
  for (std::size_t i = kConstantConfigurations; i < local.configurations.size(); ++i) {
    statistics.localPropellers += local.configurations[i].propellerCount;
  }
  statistics.globalPropellers = global.opposites.size();
}

}  // namespace

HexMesh runPipeline(const igm::PreparedMap& map, std::uint64_t expectedCells, double epsilon,
                    Context& context, ExtractStatistics& statistics) {
  statistics.epsilon = epsilon;
  HexMesh mesh;
  HexVertices vertices = [&] {
    Stage stage(context, "vertices");
    HexVertices swept(map, epsilon, stage);
    mesh.points.resize(swept.tables.count());
    mesh.generatorTet.resize(swept.tables.count());
    mesh.generatorCorners.resize(swept.tables.count());
    swept.tables.describe({mesh.points, mesh.generatorTet, mesh.generatorCorners}, stage);
    return swept;
  }();
  Array<lattice::NormalSigns> signs;
  LocalConnectivity local;
  {
    Stage stage(context, "local connectivity");
    signs = computeNormalSigns(map.exact, stage);
    local = extractLocalConnectivity(map, signs, vertices, stage);
    // A vertex that was overlooked leaves corners behind that make up no whole number of cells.
    if (countCells(vertices, local) != expectedCells) failForMissingVertex({});
  }
  GlobalConnectivity global;
  {
    Stage stage(context, "global connectivity");
    global = traceOpposites(map, signs, vertices, local, stage);
  }
  {
    Stage stage(context, "cells");
    mesh.cells = collectCells(map, signs, vertices, local, global, stage);
    if (mesh.cells.size() != expectedCells) failForMissingVertex({});
  }
  count(vertices, local, global, statistics);
  return mesh;
}

}  // namespace hexhex::propeller
