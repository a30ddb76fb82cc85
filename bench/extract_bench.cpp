// The whole extraction, from raw input arrays to finished arrays, with its stages; and in the same
// run the yardstick: copying the finished points and cells into fresh memory.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <benchmark/benchmark.h>

#include <hexhex/check.hpp>
#include <hexhex/extract.hpp>

#include "bench_maps.hpp"
#include "benchmarks.hpp"
#include "core_speed.hpp"
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

/// Of the iterations of one benchmark.
struct Totals {
  double extraction = 0;  ///< sum
  double first = 0;       ///< of these, the first
  double copy = 0;        ///< sum
  std::optional<std::uint64_t> peakBytes;
  double coreSpeed = 0;       ///< additions per nanosecond of each thread
  double coreSpeedAlone = 0;  ///< of one thread at a time
  std::vector<StageTime> stages;
  std::size_t hexes = 0;   ///< of the mesh
  std::size_t points = 0;  ///< of the mesh

  void add(double elapsed, const std::vector<StageTime>& times) {
    if (extraction == 0) first = elapsed;
    extraction += elapsed;
    for (const StageTime& time : times) add(time);
  }

 private:
  void add(const StageTime& time) {
    const auto found = std::find_if(stages.begin(), stages.end(), [&time](const StageTime& known) {
      return known.stage == time.stage;
    });
    if (found == stages.end()) {
      stages.push_back(time);
    } else {
      found->seconds += time.seconds;
    }
  }
};

/// Name of a stage's counter; the number keeps the stages in the order in which they ran.
std::string counterOf(std::size_t number, const std::string& stage) {
  return std::string("stage ") + (number < 10 ? "0" : "") + std::to_string(number) + ": " + stage;
}

void setCounters(benchmark::State& state, const Totals& totals, std::size_t tets) {
  const auto runs = static_cast<double>(state.iterations());
  const auto hexes = static_cast<double>(totals.hexes);
  const auto points = static_cast<double>(totals.points);
  state.counters["tets"] = static_cast<double>(tets);
  state.counters["hexes"] = hexes;
  state.counters["seconds"] = totals.extraction / runs;
  state.counters["seconds_of_first"] = totals.first;
  state.counters["seconds_of_copy"] = totals.copy / runs;
  state.counters["ratio_to_yardstick"] = totals.extraction / totals.copy;
  state.counters["additions_per_ns"] = totals.coreSpeed;
  state.counters["additions_per_ns_alone"] = totals.coreSpeedAlone;
  state.counters["bytes_of_result"] = hexes * sizeof(Hex) + points * sizeof(Vec3);
  if (totals.peakBytes) state.counters["peak_bytes"] = static_cast<double>(*totals.peakBytes);
  for (std::size_t i = 0; i < totals.stages.size(); ++i) {
    state.counters[counterOf(i, totals.stages[i].stage)] = totals.stages[i].seconds / runs;
  }
}

struct Case {
  const BenchMap& map;
  Engine engine;
  int threads;
  int scale;

  /// Tells this case from all others.
  [[nodiscard]] std::string name() const {
    return map.name + (engine == Engine::Atlas ? "/atlas/" : "/propeller/") +
           std::to_string(threads) + "/" + std::to_string(scale);
  }
};

/// Extracts again and again, from memory that is free and warm, but not this process's own. Only
/// the first extraction of a small map finds caches that know nothing of it.
void extraction(benchmark::State& state, const Case& what) {
  const TetMap& map = load(what.map);
  ExtractOptions options;
  options.engine = what.engine;
  options.scale = what.scale;
  const std::uint64_t bytes = peakOf(what.name(), [&] {
    Context context(what.threads);
    benchmark::DoNotOptimize(extract(map, options, context).cells.data());
  });
  Totals totals;
  HexMesh mesh;
  warmFreeMemory(bytes, what.threads);
  const PeakMemory peak;
  for (auto _ : state) {
    mesh = {};
    releaseFreeMemory();
    Context context(what.threads);
    const auto begin = std::chrono::steady_clock::now();
    mesh = extract(map, options, context);
    const double elapsed = seconds(std::chrono::steady_clock::now() - begin);
    state.SetIterationTime(elapsed);
    totals.add(elapsed, context.stageTimes());
  }
  totals.peakBytes = peak.growth();
  totals.coreSpeed = additionsPerNanosecond(what.threads);
  totals.coreSpeedAlone = additionsPerNanosecond(1);
  for (benchmark::IterationCount i = 0; i < state.iterations(); ++i) {
    totals.copy += secondsOfCopy(mesh);
  }
  totals.hexes = mesh.cells.size();
  totals.points = mesh.points.size();
  setCounters(state, totals, map.tets.size());
}

/// Whether memory suffices for this scale, with either engine.
bool fits(const BenchMap& map, int scale) {
  // The propeller engine takes up to 250 bytes, and the copy of the result 60.
  constexpr double kBytesPerHex = 350;
  static std::string checkedName;
  static double cells = 0;
  if (checkedName != map.name) {
    cells = static_cast<double>(check(load(map)).expected.cells);
    checkedName = map.name;
  }
  const auto available = availableMemory();
  return !available ||
         cells * scale * scale * scale * kBytesPerHex < 0.8 * static_cast<double>(*available);
}

std::string nameOf(Engine engine) {
  return engine == Engine::Atlas ? "engine:atlas" : "engine:propeller";
}

/// @param prefix  family, map, and what else tells the case from others
template <class F>
void add(const std::string& prefix, const Case& what, const F& f) {
  const std::string name =
      prefix + "/" + nameOf(what.engine) + "/threads:" + std::to_string(what.threads);
  benchmark::RegisterBenchmark(name.c_str(), f)->UseManualTime()->Unit(benchmark::kMillisecond);
}

void add(const std::string& prefix, const Case& what) {
  add(prefix, what, [what](benchmark::State& state) { extraction(state, what); });
}

/// One and two threads; if `many`, also up to all cores.
std::vector<int> threadCounts(bool many) {
  std::vector<int> counts = {1, 2};
  if (!many) return counts;
  const auto cores = static_cast<int>(std::thread::hardware_concurrency());
  for (int power = 2; power < cores; power *= 2) {
    for (const int count : {power + power / 2, 2 * power}) {
      if (count <= cores) counts.push_back(count);
    }
  }
  if (counts.back() < cores) counts.push_back(cores);
  return counts;
}

/// Whether extraction is measured for all numbers of threads.
bool isForThreads(const BenchMap& map) {
  constexpr std::array<std::string_view, 4> kNames = {
      "sphere_blocks_million", "sphere_blocks_middle", "sphere_blocks_high", "s17c_sphere_r100_x2"};
  return std::find(kNames.begin(), kNames.end(), map.name) != kNames.end();
}

constexpr std::array<Engine, 2> kEngines = {Engine::Atlas, Engine::Propeller};

}  // namespace

void registerExtraction() {
  for (const BenchMap& map : benchMaps()) {
    for (const Engine engine : kEngines) {
      for (const int threads : threadCounts(isForThreads(map))) {
        add("extract/" + map.name, {map, engine, threads, map.scale});
      }
    }
  }
}

void registerScales() {
  for (const BenchMap& map : scalableMaps()) {
    for (const int scale : {1, 2, 3, 4, 6, 8, 10, 12, 16}) {
      for (const Engine engine : kEngines) {
        const Case what = {map, engine, 1, scale};
        add("scale/" + map.name + "/scale:" + std::to_string(scale), what,
            [what](benchmark::State& state) {
              if (fits(what.map, what.scale)) {
                extraction(state, what);
              } else {
                state.SkipWithError("not enough memory for this scale");
              }
            });
      }
    }
  }
}

void registerDensities() {
  for (const BenchMap& map : densityMaps()) {
    for (const Engine engine : kEngines) add("density/" + map.name, {map, engine, 1, map.scale});
  }
}

}  // namespace hexhex::bench
