#include "bench_maps.hpp"

#include <cstdlib>
#include <initializer_list>
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

/// Slightly more than a million tets, 0.1 hexahedra for each.
void addMillionTets(std::vector<BenchMap>& maps) {
  maps.push_back(
      generated("sphere_blocks_million", SampleKind::Sphere, ChartStyle::Blocks, 24, 23));
  maps.push_back(
      generated("cylinder_random_million", SampleKind::Cylinder, ChartStyle::Random, 28, 26));
}

/// @return nothing if the file is missing
std::optional<BenchMap> real(const std::string& name, int scale) {
  const char* fromEnvironment = std::getenv("HEXHEX_DATA");
  const std::filesystem::path folder =
      fromEnvironment != nullptr ? fromEnvironment : HEXHEX_DATA_DIR;
  BenchMap map;
  map.name = name;
  map.file = folder / "maps" / (name + ".hexex");
  map.scale = scale;
  if (!std::filesystem::exists(map.file)) return std::nullopt;
  return map;
}

struct Real {
  const char* name;
  int scale;
};

void addReal(std::vector<BenchMap>& maps, std::initializer_list<Real> names) {
  for (const Real& r : names) {
    std::optional<BenchMap> map = real(r.name, r.scale);
    if (!map) continue;
    map->name += "_x" + std::to_string(r.scale);
    maps.push_back(*map);
  }
}

BenchMap scalableSphere() {
  return generated("sphere_blocks", SampleKind::Sphere, ChartStyle::Blocks, 9, 4);
}

std::vector<BenchMap> makeScalable() {
  std::vector<BenchMap> maps = {scalableSphere()};
  for (const char* name : {"s17c_sphere_r1", "rockerarm"}) {
    if (const std::optional<BenchMap> map = real(name, 1)) maps.push_back(*map);
  }
  return maps;
}

std::vector<BenchMap> makeDensities() {
  struct Density {
    const char* name;  ///< about as many hexahedra per tet
    int cells;
    int refine;
  };
  // As many tets as keep both the map and its mesh within a few million elements.
  constexpr std::array<Density, 11> kDensities = {{{"0.01", 10, 20},
                                                   {"0.03", 14, 20},
                                                   {"0.1", 21, 20},
                                                   {"0.3", 28, 18},
                                                   {"1", 37, 16},
                                                   {"3", 40, 12},
                                                   {"10", 49, 10},
                                                   {"30", 57, 8},
                                                   {"100", 64, 6},
                                                   {"300", 61, 4},
                                                   {"1000", 69, 3}}};
  std::vector<BenchMap> maps;
  maps.reserve(kDensities.size());
  for (const Density& d : kDensities) {
    maps.push_back(generated(std::string("sphere_blocks_d") + d.name, SampleKind::Sphere,
                             ChartStyle::Blocks, d.cells, d.refine));
  }
  return maps;
}

}  // namespace

const std::vector<BenchMap>& benchMaps() {
  static const std::vector<BenchMap> maps = [] {
    std::vector<BenchMap> all;
    addGenerated(all);
    addMillionTets(all);
    addReal(all, {{"s17c_sphere_r0.1", 1},
                  {"s17c_sphere_r10", 1},
                  {"s17c_sphere_r100", 2},
                  {"rockerarm", 8}});
    return all;
  }();
  return maps;
}

const std::vector<BenchMap>& checkedMaps() {
  static const std::vector<BenchMap> maps = [] {
    std::vector<BenchMap> all = {middleMap()};
    addReal(all, {{"rockerarm", 1},
                  {"s17c_sphere_r10", 1},
                  {"fandisk_r100", 1},
                  {"rockerarm", 8},
                  {"rockerarm", 12},
                  {"s17c_sphere_r100", 2}});
    return all;
  }();
  return maps;
}

const BenchMap& writtenMap() {
  static const BenchMap map = [] {
    if (const std::optional<BenchMap> found = real("s17c_sphere_r100", 4)) return *found;
    BenchMap sphere = scalableSphere();
    sphere.scale = 16;
    return sphere;
  }();
  return map;
}

const std::vector<BenchMap>& scalableMaps() {
  static const std::vector<BenchMap> maps = makeScalable();
  return maps;
}

const std::vector<BenchMap>& densityMaps() {
  static const std::vector<BenchMap> maps = makeDensities();
  return maps;
}

const std::vector<BenchMap>& ablationMaps() {
  static const std::vector<BenchMap> maps = [] {
    std::vector<BenchMap> all = benchMaps();
    std::erase_if(all, [](const BenchMap& map) { return map.name.ends_with("_million"); });
    BenchMap large = scalableSphere();
    large.scale = 12;
    large.name += "_x12";
    all.push_back(large);
    return all;
  }();
  return maps;
}

const BenchMap& middleMap() {
  static const BenchMap map =
      generated("sphere_blocks_middle", SampleKind::Sphere, ChartStyle::Blocks, 47, 12);
  return map;
}

const BenchMap& sphereMap() {
  static const BenchMap map = real("s17c_sphere_r1", 1).value_or(scalableSphere());
  return map;
}

TetMap makeMap(const BenchMap& map) {
  return map.file.empty() ? generateSample(map.kind, map.options).map : readMap(map.file);
}

const TetMap& load(const BenchMap& map) {
  static std::string loadedName;
  static std::optional<TetMap> loaded;
  if (!loaded || loadedName != map.name) {
    loaded.reset();
    loaded = makeMap(map);
    loadedName = map.name;
  }
  return *loaded;
}

}  // namespace hexhex::bench
