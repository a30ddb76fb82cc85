// Arcs, patches and Lagrange cells: what they cost beyond an extraction without them, in CPU time.
// What engines do for arcs while they extract the mesh counts as arcs.
#include <cstdint>
#include <ctime>
#include <map>
#include <string>
#include <string_view>

#include <benchmark/benchmark.h>

#include <hexhex/curved.hpp>
#include <hexhex/extract.hpp>

#include "bench_maps.hpp"
#include "benchmarks.hpp"
#include "memory.hpp"

namespace hexhex::bench {

namespace {

/// The generator that the reference's figures are for: 64,000 hexahedra in general position.
BenchMap cube() {
  BenchMap map;
  map.name = "box_64000";
  map.kind = SampleKind::Box;
  map.options.cells = 20;
  map.options.refine = 7;
  map.options.jitter = 0.5;
  return map;
}

/// CPU time of stages, of all threads together, from where each begins to where the next does:
/// other work on the machine does not count.
class StageClock {
 public:
  /// What a Context is to be made with.
  [[nodiscard]] Context::Progress listener() {
    return [this](std::string_view stage, double share) {
      if (share == 0) begin(stage);
    };
  }
  void begin(std::string_view stage) {
    const std::clock_t now = std::clock();
    seconds_[stage_] += static_cast<double>(now - since_) / CLOCKS_PER_SEC;
    stage_ = stage;
    since_ = now;
  }
  [[nodiscard]] double seconds(const std::string& stage) const {
    const auto found = seconds_.find(stage);
    return found == seconds_.end() ? 0 : found->second;
  }
  [[nodiscard]] double total() const {
    double sum = 0;
    for (const auto& [stage, seconds] : seconds_) sum += seconds;
    return sum;
  }

 private:
  std::map<std::string, double> seconds_;
  std::string stage_;
  std::clock_t since_ = std::clock();
};

void setNanoseconds(benchmark::State& state, const std::string& what, double seconds,
                    std::size_t count) {
  const double perRun = seconds / static_cast<double>(state.iterations());
  state.counters["ns_per_" + what] = 1e9 * perRun / static_cast<double>(count);
  state.counters[what + "s"] = static_cast<double>(count);
}

/// Corners of all polylines, ends included.
std::size_t arcPoints(const Arcs& arcs) { return arcs.points.size() + 2 * arcs.count(); }

/// CPU time of run(context), up to its result; freeing that does not count.
template <class Run>
double secondsOf(int threads, std::uint64_t bytes, const Run& run) {
  warmFreeMemory(bytes, threads);
  releaseFreeMemory();
  StageClock clock;
  Context context(threads, clock.listener());
  const auto result = run(context);
  clock.begin("end");
  const double seconds = clock.total();
  benchmark::DoNotOptimize(&result);
  return seconds;
}

void piecewiseLinear(benchmark::State& state, const std::string& name, const BenchMap& what,
                     Engine engine, int threads) {
  const TetMap& map = load(what);
  ExtractOptions options;
  options.engine = engine;
  options.scale = what.scale;
  double arcs = 0;
  double patches = 0;
  double extraction = 0;
  std::size_t points = 0;
  std::size_t polygons = 0;
  std::size_t hexes = 0;
  const std::uint64_t bytes = peakOf(name, [&] {
    Context context(threads);
    benchmark::DoNotOptimize(
        extractPiecewiseLinear(map, PiecewiseLinearParts::ArcsAndPatches, options, context));
  });
  const auto secondsAlone = [&] {
    return secondsOf(threads, bytes,
                     [&](Context& context) { return extract(map, options, context); });
  };
  for (auto _ : state) {
    // Before and behind, as the machine's speed changes.
    const double before = secondsAlone();
    const double withArcs = secondsOf(threads, bytes, [&](Context& context) {
      return extractPiecewiseLinear(map, PiecewiseLinearParts::Arcs, options, context);
    });
    const double alone = (before + secondsAlone()) / 2;
    extraction += alone;
    arcs += withArcs - alone;
    warmFreeMemory(bytes, threads);
    releaseFreeMemory();
    StageClock clock;
    Context context(threads, clock.listener());
    ExtractStatistics statistics;
    const PiecewiseLinearMesh mesh = extractPiecewiseLinear(
        map, PiecewiseLinearParts::ArcsAndPatches, options, context, &statistics);
    state.SetIterationTime(statistics.seconds);
    clock.begin("end");
    patches += clock.seconds("patches");
    points = arcPoints(mesh.arcs);
    polygons = mesh.patches.polygonTet.size();
    hexes = mesh.mesh.cells.size();
  }
  setNanoseconds(state, "arc_point", arcs, points);
  setNanoseconds(state, "polygon", patches, polygons);
  state.counters["hexes"] = static_cast<double>(hexes);
  state.counters["arcs_to_extraction"] = arcs / extraction;
  state.counters["patches_to_extraction"] = patches / extraction;
}

void lagrange(benchmark::State& state, const BenchMap& what, int order) {
  const TetMap& map = load(what);
  ExtractOptions options;
  options.scale = what.scale;
  std::size_t nodes = 0;
  double seconds = 0;
  for (auto _ : state) {
    Context context(1);
    ExtractStatistics statistics;
    const LagrangeMesh mesh = extractLagrange(map, order, options, context, &statistics);
    state.SetIterationTime(statistics.seconds);
    seconds += statistics.seconds;
    nodes = mesh.points.size();
  }
  setNanoseconds(state, "node", seconds, nodes);
}

void add(const BenchMap& map) {
  for (const Engine engine : {Engine::Atlas, Engine::Propeller}) {
    for (const int threads : {1, 2}) {
      const std::string name = "arcs_and_patches/" + map.name +
                               (engine == Engine::Atlas ? "/engine:atlas" : "/engine:propeller") +
                               "/threads:" + std::to_string(threads);
      benchmark::RegisterBenchmark(name.c_str(),
                                   [name, map, engine, threads](benchmark::State& state) {
                                     piecewiseLinear(state, name, map, engine, threads);
                                   })
          ->UseManualTime()
          ->Unit(benchmark::kMillisecond);
    }
  }
}

}  // namespace

void registerCurved() {
  add(cube());
  for (const BenchMap& map : benchMaps()) {
    // A million faces and more take gigabytes.
    if (map.name.find("high") == std::string::npos && map.name != "s17c_sphere_r100_x2" &&
        map.name != "rockerarm_x8") {
      add(map);
    }
  }
  for (const int order : {2, 3}) {
    const BenchMap map = cube();
    const std::string name = "lagrange/" + map.name + "/order:" + std::to_string(order);
    benchmark::RegisterBenchmark(
        name.c_str(), [map, order](benchmark::State& state) { lagrange(state, map, order); })
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
  }
}

}  // namespace hexhex::bench
