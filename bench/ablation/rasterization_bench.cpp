// How the grid points of all tets are found, each with the simplex in whose interior it lies: by
// exact predicates at every point of the bounding box, at the ends of all lines of tets enlarged by
// epsilon, as in the paper, or just where zeros of planes do not tell. (The paper's Figure 22)
#include <array>
#include <cstdint>
#include <string>
#include <utility>

#include <benchmark/benchmark.h>

#include <lattice/tet_rasterizer.hpp>

#include "ablation/benchmarks.hpp"
#include "ablation/scaled_map.hpp"

namespace hexhex::bench {

namespace {

/// What must be the same for all methods: the number of points, also by simplex.
struct Found {
  std::uint64_t points = 0;
  std::array<std::uint64_t, 16> bySimplex{};

  void add(lattice::CornerMask simplex, std::uint64_t count) {
    points += count;
    bySimplex[simplex] += count;
  }
  /// A line of points by the simplices of its ends.
  void addLine(lattice::CornerMask left, lattice::CornerMask inner, lattice::CornerMask right,
               std::uint64_t count) {
    if (count == 0) return;
    add(left, 1);
    if (count > 1) add(right, 1);
    if (count > 2) add(inner, count - 2);
  }
  [[nodiscard]] bool operator==(const Found&) const = default;
};

struct BoundingBox {
  static void run(const lattice::LatticeTet& corners, std::int64_t unit, Found& found) {
    const lattice::GridBox box = lattice::gridBox(corners, unit);
    lattice::GridPoint z{};
    for (z[0] = box.range[0].first; z[0] <= box.range[0].last; ++z[0]) {
      for (z[1] = box.range[1].first; z[1] <= box.range[1].last; ++z[1]) {
        for (z[2] = box.range[2].first; z[2] <= box.range[2].last; ++z[2]) {
          const lattice::CornerMask simplex = lattice::simplexOf(corners, z, unit);
          if (simplex != lattice::kNoSimplex) found.add(simplex, 1);
        }
      }
    }
  }
};

void findLines(const lattice::LatticeTet& corners, std::int64_t unit, double epsilon,
               Found& found) {
  lattice::TetRasterizer(corners, unit, epsilon)
      .sweep(lattice::kVertexGrid, [&found](const lattice::SweptLine& line) {
        found.addLine(line.left, line.inner(), line.right, line.count);
      });
}

struct Enlarged {
  static void run(const lattice::LatticeTet& corners, std::int64_t unit, Found& found) {
    constexpr double kEpsilon = 1e-6;
    findLines(corners, unit, kEpsilon, found);
  }
};

struct Lines {
  static void run(const lattice::LatticeTet& corners, std::int64_t unit, Found& found) {
    findLines(corners, unit, 0, found);
  }
};

template <class Method>
Found findAll(const igm::ExactMap& map) {
  Found found;
  for (const lattice::LatticeTet& corners : map.corners) Method::run(corners, map.unit, found);
  return found;
}

/// What the fastest method finds; computed once per scale.
const Found& expected(int scale) {
  static int scaleOfFound = 0;
  static Found found;
  if (scaleOfFound != scale) {
    found = findAll<Lines>(scaledMap(scale).exact);
    scaleOfFound = scale;
  }
  return found;
}

template <class Method>
void rasterization(benchmark::State& state, int scale) {
  const igm::PreparedMap& map = scaledMap(scale);
  Found found;
  for (auto _ : state) {
    found = findAll<Method>(map.exact);
    benchmark::DoNotOptimize(found);
  }
  if (found != expected(scale)) {
    state.SkipWithError("the methods found different points");
    return;
  }
  state.counters["tets"] = static_cast<double>(map.exact.corners.size());
  state.counters["points"] = static_cast<double>(found.points);
}

template <class Method>
void add(const std::string& method) {
  for (const int scale : kScales) {
    const std::string name = "rasterization/" + sphereMap().name +
                             "/scale:" + std::to_string(scale) + "/method:" + method;
    benchmark::RegisterBenchmark(
        name.c_str(), [scale](benchmark::State& state) { rasterization<Method>(state, scale); })
        ->UseRealTime()
        ->Unit(benchmark::kMillisecond);
  }
}

}  // namespace

void registerRasterization() {
  add<BoundingBox>("box");
  add<Enlarged>("epsilon");
  add<Lines>("lines");
}

}  // namespace hexhex::bench
