#include "bench_maps.hpp"

#include <cstdlib>
#include <optional>

#include <hexhex/io.hpp>

namespace hexhex::bench {

namespace {

/// Tets are displaced, so that lattice points fall anywhere, but keep a good shape.
constexpr double kJitter = 0.1;

BenchMap generated(const std::string& name, SampleKind kind, ChartStyle charts, int cells,
                   int refine) {
  BenchMap map;
  map.name = name;
  map.kind = kind;
  map.options.cells = cells;
  map.options.refine = refine;
  map.options.charts = charts;
  map.options.jitter = kJitter;
  return map;
}

/// Hexahedra per tet are cells^3 / (12 refine^3).
void addGenerated(std::vector<BenchMap>& maps) {
  struct Density {
    const char* name;
    int cells;
    int refine;
  };
  constexpr std::array<Density, 3> kDensities = {{
      {"low", 17, 16},     // 0.100 hexahedra per tet
      {"middle", 47, 12},  // 5.007
      {"high", 61, 4},     // 295.5
  }};
  for (const Density& d : kDensities) {
    const std::string density = d.name;
    maps.push_back(generated("sphere_blocks_" + density, SampleKind::Sphere, ChartStyle::Blocks,
                             d.cells, d.refine));
    maps.push_back(generated("cylinder_random_" + density, SampleKind::Cylinder, ChartStyle::Random,
                             d.cells, d.refine));
  }
}

void addReal(std::vector<BenchMap>& maps) {
  const char* fromEnvironment = std::getenv("HEXHEX_DATA");
  const std::filesystem::path folder =
      fromEnvironment != nullptr ? fromEnvironment : HEXHEX_DATA_DIR;
  struct Real {
    const char* name;
    int scale;
  };
  constexpr std::array<Real, 4> kReal = {
      {{"s17c_sphere_r0.1", 1}, {"s17c_sphere_r10", 1}, {"s17c_sphere_r100", 2}, {"rockerarm", 8}}};
  for (const Real& real : kReal) {
    const std::filesystem::path file = folder / "maps" / (std::string(real.name) + ".hexex");
    if (!std::filesystem::exists(file)) continue;
    BenchMap map;
    map.name = std::string(real.name) + "_x" + std::to_string(real.scale);
    map.file = file;
    map.scale = real.scale;
    maps.push_back(map);
  }
}

}  // namespace

const std::vector<BenchMap>& benchMaps() {
  static const std::vector<BenchMap> maps = [] {
    std::vector<BenchMap> all;
    addGenerated(all);
    addReal(all);
    return all;
  }();
  return maps;
}

const BenchMap& middleMap() {
  static const BenchMap map =
      generated("sphere_blocks_middle", SampleKind::Sphere, ChartStyle::Blocks, 47, 12);
  return map;
}

const TetMap& load(const BenchMap& map) {
  static std::string loadedName;
  static std::optional<TetMap> loaded;
  if (!loaded || loadedName != map.name) {
    loaded.reset();
    loaded = map.file.empty() ? generateSample(map.kind, map.options).map : readMap(map.file);
    loadedName = map.name;
  }
  return *loaded;
}

}  // namespace hexhex::bench
