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

/// With certificates, as `hexhex extract` takes both.
void quality(benchmark::State& state) {
  const HexMesh& mesh = middleMesh();
  for (auto _ : state) {
    Context context(static_cast<int>(state.range(0)));
    benchmark::DoNotOptimize(certify(mesh, context));
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
  benchmark::RegisterBenchmark(("quality/" + middleMap().name).c_str(), quality)
      ->ArgName("threads")
      ->Arg(1)
      ->Arg(2)
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond);
  const std::string suffix = "/" + middleMap().name + "/threads:1";
  benchmark::RegisterBenchmark(("verify" + suffix).c_str(), verification)
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond);
}

}  // namespace hexhex::bench
