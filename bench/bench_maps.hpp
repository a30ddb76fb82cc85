// The maps that are measured: generated ones of three densities, and real ones where they exist.
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

/// Low, middle and high density (0.1, 5 and 300 hexahedra per tet), then the real maps.
[[nodiscard]] const std::vector<BenchMap>& benchMaps();

/// The generated map of middle density with one chart per block.
[[nodiscard]] const BenchMap& middleMap();

/// Generates or reads a map. The last one stays in memory, because a benchmark's function is called
/// once per repetition; the reference is valid until the next call.
[[nodiscard]] const TetMap& load(const BenchMap& map);

}  // namespace hexhex::bench
