// Repair of a few dozen flipped and flat tets in large maps, and as yardsticks in the same run what
// the undamaged maps take: their check, which a repair does twice, and their extraction.
#include <array>
#include <cstdint>
#include <string>

#include <benchmark/benchmark.h>

#include <hexhex/check.hpp>
#include <hexhex/extract.hpp>
#include <hexhex/repair.hpp>
#include <hexhex/samples.hpp>

#include "bench_maps.hpp"
#include "benchmarks.hpp"
#include "memory.hpp"

namespace hexhex::bench {

namespace {

constexpr int kDefects = 36;

/// 84 tets per refine^3: 112,000 and 896,000 tets.
constexpr std::array<int, 2> kRefines = {11, 22};

BenchMap sphere(int refine) {
  BenchMap map;
  map.name = "sphere_";
  map.name += std::to_string(84 * refine * refine * refine) + "_tets";
  map.kind = SampleKind::Sphere;
  map.options.refine = refine;
  map.options.cells = 2 * refine;
  map.options.charts = ChartStyle::Blocks;
  map.options.jitter = 0.3;
  return map;
}

BenchMap damaged(int refine, const DefectKindName& kind) {
  BenchMap map = sphere(refine);
  map.name += '_';
  map.name += kind.name;
  map.options.defects = kDefects;
  map.options.defectKind = kind.kind;
  return map;
}

void setPeak(benchmark::State& state, const PeakMemory& peak) {
  if (const auto bytes = peak.growth()) {
    state.counters["peak_megabytes"] = static_cast<double>(*bytes) * 1e-6;
  }
}

void checking(benchmark::State& state, const BenchMap& what) {
  const TetMap& map = load(what);
  for (auto _ : state) {
    const PeakMemory peak;
    Context context(1);
    const CheckReport report = check(map, {}, context);
    setPeak(state, peak);
    if (!report.valid()) state.SkipWithError("the undamaged map is not valid");
  }
  state.counters["tets"] = static_cast<double>(map.tets.size());
}

void extraction(benchmark::State& state, const BenchMap& what) {
  const TetMap& map = load(what);
  for (auto _ : state) {
    const PeakMemory peak;
    Context context(1);
    benchmark::DoNotOptimize(extract(map, {}, context));
    setPeak(state, peak);
  }
  state.counters["tets"] = static_cast<double>(map.tets.size());
}

void repairing(benchmark::State& state, const BenchMap& what) {
  const TetMap& map = load(what);
  RepairReport report;
  for (auto _ : state) {
    const PeakMemory peak;
    Context context(1);
    benchmark::DoNotOptimize(repair(map, {}, context, &report));
    setPeak(state, peak);
    if (!report.changed) state.SkipWithError("nothing was repaired");
  }
  std::uint64_t patch = 0;
  for (const RepairedRegion& region : report.regions) patch += region.tets;
  state.counters["tets"] = static_cast<double>(map.tets.size());
  state.counters["bad_tets"] = static_cast<double>(report.badTets);
  state.counters["patch_tets"] = static_cast<double>(patch);
}

/// Time of all threads; wall-clock time says little on a machine that does other things.
template <class Function>
void add(const std::string& name, Function function, const BenchMap& map) {
  benchmark::RegisterBenchmark(name.c_str(),
                               [function, map](benchmark::State& state) { function(state, map); })
      ->MeasureProcessCPUTime()
      ->Unit(benchmark::kMillisecond);
}

}  // namespace

void registerRepair() {
  for (const int refine : kRefines) {
    const BenchMap sound = sphere(refine);
    add("repair/" + sound.name + "/undamaged:check", checking, sound);
    add("repair/" + sound.name + "/undamaged:extract", extraction, sound);
    if (!canRepair()) continue;
    for (const DefectKindName& kind : defectKinds()) {
      std::string name = "repair/" + sound.name + "/defects:";
      name += kind.name;
      add(name, repairing, damaged(refine, kind));
    }
  }
}

}  // namespace hexhex::bench
