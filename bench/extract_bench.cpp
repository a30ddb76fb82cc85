// The whole extraction, from raw input arrays to finished arrays, with its stages; and in the same
// run the yardstick: copying the finished points and cells into fresh memory.
#include <chrono>
#include <cstring>
#include <map>
#include <memory>
#include <span>

#include <benchmark/benchmark.h>

#include <hexhex/extract.hpp>

#include "bench_maps.hpp"
#include "benchmarks.hpp"
#include "memory.hpp"

namespace hexhex::bench {

namespace {

double seconds(std::chrono::steady_clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

/// Copies an array into memory that was not touched before.
template <class T>
void copyToFresh(std::span<const T> from) {
  const auto bytes = std::make_unique_for_overwrite<std::byte[]>(from.size_bytes());
  std::memcpy(bytes.get(), from.data(), from.size_bytes());
  benchmark::DoNotOptimize(bytes.get());
  benchmark::ClobberMemory();
}

double secondsOfCopy(const HexMesh& mesh) {
  releaseFreeMemory();
  const auto begin = std::chrono::steady_clock::now();
  copyToFresh(std::span(mesh.points.data(), mesh.points.size()));
  copyToFresh(std::span(mesh.cells.data(), mesh.cells.size()));
  return seconds(std::chrono::steady_clock::now() - begin);
}

/// Sums over the iterations of one benchmark.
struct Totals {
  double extraction = 0;
  double copy = 0;
  double peakBytes = 0;
  std::map<std::string, double> stages;
  bool peakKnown = true;
};

void setCounters(benchmark::State& state, const Totals& totals, std::size_t tets,
                 std::size_t hexes) {
  const auto runs = static_cast<double>(state.iterations());
  const double nsPerTet = 1e9 / (runs * static_cast<double>(tets));
  const double nsPerHex = 1e9 / (runs * static_cast<double>(hexes));
  state.counters["tets"] = static_cast<double>(tets);
  state.counters["million_hexes"] = static_cast<double>(hexes) * 1e-6;
  state.counters["ns_per_tet"] = totals.extraction * nsPerTet;
  state.counters["ns_per_hex"] = totals.extraction * nsPerHex;
  if (totals.peakKnown) {
    state.counters["bytes_per_hex"] = totals.peakBytes / (runs * static_cast<double>(hexes));
    state.counters["peak_MB"] = totals.peakBytes / runs * 1e-6;
  }
  state.counters["ratio_to_yardstick"] = totals.extraction / totals.copy;
  for (const auto& [stage, time] : totals.stages) {
    state.counters["ns_per_tet: " + stage] = time * nsPerTet;
    state.counters["ns_per_hex: " + stage] = time * nsPerHex;
  }
}

void extraction(benchmark::State& state, const BenchMap& benchMap, int threads) {
  const TetMap& map = load(benchMap);
  ExtractOptions options;
  options.scale = benchMap.scale;
  Totals totals;
  std::size_t hexes = 0;
  for (auto _ : state) {
    Context context(threads);
    const PeakMemory peak;
    const auto begin = std::chrono::steady_clock::now();
    const HexMesh mesh = extract(map, options, context);
    const double elapsed = seconds(std::chrono::steady_clock::now() - begin);
    state.SetIterationTime(elapsed);
    totals.extraction += elapsed;
    if (const auto growth = peak.growth()) {
      totals.peakBytes += static_cast<double>(*growth);
    } else {
      totals.peakKnown = false;
    }
    for (const StageTime& stage : context.stageTimes()) totals.stages[stage.stage] += stage.seconds;
    totals.copy += secondsOfCopy(mesh);
    hexes = mesh.cells.size();
  }
  setCounters(state, totals, map.tets.size(), hexes);
}

}  // namespace

void registerExtraction() {
  for (const BenchMap& map : benchMaps()) {
    for (const int threads : {1, 2}) {
      const std::string name = "extract/" + map.name + "/threads:" + std::to_string(threads);
      benchmark::RegisterBenchmark(
          name.c_str(),
          [&map, threads](benchmark::State& state) { extraction(state, map, threads); })
          ->UseManualTime()
          ->Unit(benchmark::kMillisecond);
    }
  }
}

}  // namespace hexhex::bench
