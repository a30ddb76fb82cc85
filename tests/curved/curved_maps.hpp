// The maps that curved meshes are tested on: every generated kind in generic, degenerate and mixed
// position, and the real ones that are not too large.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <hexhex/io.hpp>
#include <hexhex/samples.hpp>

#include "extract/support.hpp"

namespace hexhex::test {

struct CurvedMap {
  std::string name;
  TetMap map;
};

/// Options that differ in what matters: tets aligned with the grid, in general position, with many
/// vertices on it, much smaller and much larger than cells; with all kinds of charts.
inline std::vector<SampleOptions> curvedOptions() {
  std::vector<SampleOptions> all(6);
  all[0].cells = 2;  // aligned with the grid: everything is degenerate
  all[1].cells = 2;
  all[1].refine = 3;
  all[1].jitter = 0.6;
  all[1].charts = ChartStyle::Random;
  all[2].cells = 3;
  all[2].refine = 2;
  all[2].jitter = 0.7;
  all[2].onLattice = 0.5;
  all[2].charts = ChartStyle::Blocks;
  all[3].cells = 1;
  all[3].refine = 4;
  all[3].jitter = 0.3;
  all[3].onLattice = 0.2;
  all[3].charts = ChartStyle::Random;
  all[4].cells = 5;
  all[4].refine = 1;
  all[4].jitter = 0.9;
  all[4].charts = ChartStyle::Random;
  all[5].cells = 4;
  all[5].refine = 3;  // rational positions: lines through edges and vertices that are off the grid
  all[5].offset = 1e6;
  all[5].charts = ChartStyle::Random;
  return all;
}

/// All kinds with all options; fewer, in turn, where effort is scaled down.
inline std::vector<CurvedMap> generatedMaps() {
  std::vector<CurvedMap> maps;
  const std::vector<SampleOptions> options = curvedOptions();
  const auto count = static_cast<std::size_t>(cases(static_cast<int>(options.size())));
  std::size_t turn = 0;
  for (const SampleKindName& kind : sampleKinds()) {
    for (std::size_t i = 0; i < std::min(count, options.size()); ++i) {
      const std::size_t number = (turn + i) % options.size();
      const TetMap map = generateSample(kind.kind, options[number]).map;
      maps.push_back({std::string(kind.name) + " " + std::to_string(number), map});
      if (number == 3 || number == 5) {
        maps.push_back({maps.back().name + ", charts kept", withChartsKept(map)});
      }
    }
    ++turn;
  }
  return maps;
}

/// A solid torus with so few cells around that different edges and faces have the same vertices
/// (2), or that edges come back to where they begin (1).
inline TetMap tightTorus(int cellsAround) {
  constexpr int kBlocks = 6;  // around, along w; each one cell long
  SampleOptions options;
  options.cells = 1;
  options.refine = 3;
  options.jitter = 0.3;
  TetMap map = generateSample(SampleKind::Torus, options).map;
  for (TetParameters& corners : map.parameters) {
    for (Vec3& u : corners) u[2] *= static_cast<double>(cellsAround) / kBlocks;
  }
  return map;
}

/// Real maps that exist here, those of less than about ten thousand cells; the first ones where
/// effort is scaled down.
inline std::vector<CurvedMap> realMaps() {
  const char* chosen = std::getenv("HEXHEX_DATA");
  const auto folder = std::filesystem::path(chosen != nullptr ? chosen : HEXHEX_DATA_DIR) / "maps";
  const std::vector<const char*> names = {"fandisk_r0.01",
                                          "s15c_cylinder_r0.01",
                                          "fanpart_r0.1",
                                          "s17c_sphere_r0.1",
                                          "s01c_cube_r1",
                                          "rockerarm",
                                          "double-torus_r1",
                                          "fandisk_r1",
                                          "s17c_sphere_r1",
                                          "prisma_r1",
                                          "n04c_transition_prism_r1"};
  const auto count = static_cast<std::size_t>(cases(static_cast<int>(names.size())));
  std::vector<CurvedMap> maps;
  for (std::size_t i = 0; i < std::min(count, names.size()); ++i) {
    const std::filesystem::path file = folder / (std::string(names[i]) + ".hexex");
    if (std::filesystem::exists(file)) maps.push_back({names[i], readMap(file)});
  }
  return maps;
}

}  // namespace hexhex::test
