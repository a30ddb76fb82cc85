// The maps that are measured: generated ones, and real ones where they exist.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <hexhex/samples.hpp>
#include <hexhex/types.hpp>

namespace hexhex::bench {

/// A map and how it is extracted; `file` is empty for generated maps.
struct BenchMap {
  std::string name;
  SampleKind kind = SampleKind::Sphere;
  SampleOptions options;
  std::filesystem::path file;
  int scale = 1;
};

/// Low, middle and high density (0.1, 5 and 300 hexahedra per tet), low density with a million
/// tets, then the real maps.
[[nodiscard]] const std::vector<BenchMap>& benchMaps();

/// Maps to be extracted at many scales: a generated one and real ones, all with a few thousand
/// cells at scale 1.
[[nodiscard]] const std::vector<BenchMap>& scalableMaps();

/// Maps of the ablation: those of benchMaps() without a million tets, and the
/// generated one of scalableMaps() at a large scale.
[[nodiscard]] const std::vector<BenchMap>& ablationMaps();

/// Maps whose meshes are verified and certified: few, 50 and more than 100 hexahedra per tet.
[[nodiscard]] const std::vector<BenchMap>& checkedMaps();

/// The map whose mesh is written in all ways: 26.5 million cells, or a generated one.
[[nodiscard]] const BenchMap& writtenMap();

/// Generated maps of one kind, from 0.01 to 1000 hexahedra per tet.
[[nodiscard]] const std::vector<BenchMap>& densityMaps();

/// The generated map of middle density with one chart per block.
[[nodiscard]] const BenchMap& middleMap();

/// The map on which single steps are compared: the paper's, a ball (`s17c_sphere_r1`), or if it is
/// missing a generated one.
[[nodiscard]] const BenchMap& sphereMap();

/// Generates or reads a map, and keeps it in memory until the next call for another one, because a
/// benchmark's function is called once per repetition. The reference is valid as long.
[[nodiscard]] const TetMap& load(const BenchMap& map);

/// Generates or reads a map anew.
[[nodiscard]] TetMap makeMap(const BenchMap& map);

}  // namespace hexhex::bench
