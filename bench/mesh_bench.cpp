// What happens to a finished mesh: quality and verification.
#include <benchmark/benchmark.h>

#include <hexhex/extract.hpp>
#include <hexhex/quality.hpp>
#include <hexhex/verify.hpp>

#include "bench_maps.hpp"
#include "benchmarks.hpp"

namespace hexhex::bench {

namespace {

const HexMesh& middleMesh() {
  static const HexMesh mesh = extract(load(middleMap()));
  return mesh;
}

/// Throughput in terms of the mesh's points and cells.
void setCounters(benchmark::State& state, const HexMesh& mesh) {
  const std::size_t bytes = mesh.points.size() * sizeof(Vec3) + mesh.cells.size() * sizeof(Hex);
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(bytes));
  state.counters["million_hexes"] = static_cast<double>(mesh.cells.size()) * 1e-6;
}

void quality(benchmark::State& state) {
  const HexMesh& mesh = middleMesh();
  for (auto _ : state) {
    Context context(1);
    benchmark::DoNotOptimize(summarize(scaledJacobians(mesh, context)));
  }
  setCounters(state, mesh);
}

void verification(benchmark::State& state) {
  const HexMesh& mesh = middleMesh();
  const TetMap& map = load(middleMap());
  for (auto _ : state) {
    Context context(1);
    if (!verify(map, mesh, {}, context).passed()) {
      state.SkipWithError("the mesh failed its verification");
      return;
    }
  }
  setCounters(state, mesh);
}

}  // namespace

void registerMesh() {
  const std::string suffix = "/" + middleMap().name + "/threads:1";
  benchmark::RegisterBenchmark(("quality" + suffix).c_str(), quality)
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark(("verify" + suffix).c_str(), verification)
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond);
}

}  // namespace hexhex::bench
