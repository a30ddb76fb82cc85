// What each special path gains: whole extractions with it and without it, in turn, on the maps of
// the evaluation. An entry of kEntries is all that a new one takes. (docs/results/ablation.md)
#include <algorithm>
#include <array>
#include <chrono>
#include <string>
#include <sys/resource.h>
#include <utility>

#include <benchmark/benchmark.h>

#include <base/memory.hpp>
#include <extract/steps.hpp>

#include "ablation/benchmarks.hpp"
#include "bench_maps.hpp"
#include "memory.hpp"

namespace hexhex::bench {

namespace {

/// One switch, and how an extraction goes that shows what it does.
struct Entry {
  const char* name;
  bool EngineSwitches::*option;
  Engine engine = Engine::Atlas;
  int threads = 1;
  bool samePoints = true;  ///< else the meshes are the same up to numbering
};

constexpr std::array kEntries = {
    Entry{"huge_pages", &EngineSwitches::hugePages},
    Entry{"page_pool", &EngineSwitches::pagePool},
    Entry{"look_across_cuts", &EngineSwitches::lookAcrossCuts},
    Entry{"few_points", &EngineSwitches::fewPoints},
    // Vertices are numbered along axes of charts.
    Entry{"unfold_charts", &EngineSwitches::unfoldCharts, Engine::Atlas, 1, false},
    Entry{"regular_vertices", &EngineSwitches::regularVertices},
    Entry{"flat_stars", &EngineSwitches::flatStars},
};

/// Of extractions with the switch on, or off.
struct Totals {
  double cpu = 0;   ///< seconds of the processor, in the program and in the system
  double wall = 0;  ///< seconds
};

double processorSeconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

HexMesh extractOnce(const Entry& entry, const BenchMap& map, bool on, Totals& totals) {
  ExtractOptions options;
  options.engine = entry.engine;
  options.scale = map.scale;
  EngineSwitches switches;
  switches.*entry.option = on;
  const TetMap& input = load(map);
  releaseFreeMemory();
  useHugePages(switches.hugePages, switches.pagePool);
  Context context(entry.threads);
  const double cpu = processorSeconds();
  const auto begin = std::chrono::steady_clock::now();
  HexMesh mesh = extraction::extractWith(input, {options, switches}, context);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
  totals.cpu += processorSeconds() - cpu;
  totals.wall += wall.count();
  useHugePages(true, true);
  return mesh;
}

bool isSame(const HexMesh& a, const HexMesh& b, bool samePoints) {
  if (!samePoints) return a.points.size() == b.points.size() && a.cells.size() == b.cells.size();
  return a.points == b.points && a.cells == b.cells && a.generatorTet == b.generatorTet &&
         a.generatorCorners == b.generatorCorners;
}

void compare(benchmark::State& state, const Entry& entry, const BenchMap& map) {
  Totals with;
  Totals without;
  std::uint64_t bytes = 0;
  {
    // Also so that the first one measured does not find a cold machine.
    Totals untimed;
    const PeakMemory peak;
    const HexMesh mesh = extractOnce(entry, map, true, untimed);
    if (!isSame(mesh, extractOnce(entry, map, false, untimed), entry.samePoints)) {
      state.SkipWithError("the meshes with and without the switch differ");
      return;
    }
    bytes = peak.growth().value_or(0);
    state.counters["hexes"] = static_cast<double>(mesh.cells.size());
  }
  // Else the host may still have the memory that the first extraction touches.
  warmFreeMemory(bytes, entry.threads);
  bool on = true;  // whatever comes second may find warmer caches, so they take turns
  for (auto _ : state) {
    const double before = with.wall + without.wall;
    benchmark::DoNotOptimize(extractOnce(entry, map, on, on ? with : without));
    benchmark::DoNotOptimize(extractOnce(entry, map, !on, on ? without : with));
    on = !on;
    state.SetIterationTime(with.wall + without.wall - before);
  }
  const auto runs = static_cast<double>(state.iterations());
  state.counters["tets"] = static_cast<double>(load(map).tets.size());
  state.counters["cpu_seconds_with"] = with.cpu / runs;
  state.counters["cpu_seconds_without"] = without.cpu / runs;
  state.counters["seconds_with"] = with.wall / runs;
  state.counters["seconds_without"] = without.wall / runs;
  state.counters["cpu_ratio"] = without.cpu / with.cpu;
  state.counters["ratio"] = without.wall / with.wall;
}

}  // namespace

void registerSwitches() {
  for (const BenchMap& map : ablationMaps()) {
    for (const Entry& entry : kEntries) {
      const std::string name = "ablation/" + map.name + "/switch:" + entry.name +
                               "/threads:" + std::to_string(entry.threads);
      benchmark::RegisterBenchmark(
          name.c_str(), [entry, map](benchmark::State& state) { compare(state, entry, map); })
          ->UseManualTime()
          ->Unit(benchmark::kMillisecond);
    }
  }
}

}  // namespace hexhex::bench
