// The propeller engine's enlargement of tets: time of its vertices, summed over several maps at
// scales 1, 2 and 4.
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include <extract/steps.hpp>

#include "ablation/benchmarks.hpp"
#include "bench_maps.hpp"

namespace hexhex::bench {

namespace {

const std::vector<TetMap>& maps() {
  static const std::vector<TetMap> all = [] {
    std::vector<TetMap> made;
    for (const BenchMap& map : scalableMaps()) made.push_back(makeMap(map));
    return made;
  }();
  return all;
}

/// One extraction of every map at every scale.
struct Sums {
  double vertexSeconds = 0;
  double seconds = 0;
  std::uint64_t hexes = 0;

  void extractAll(double epsilon) {
    extraction::EngineOptions options(ExtractOptions{.engine = Engine::Propeller});
    options.epsilon = epsilon;
    for (const TetMap& map : maps()) {
      for (const int scale : {1, 2, 4}) {
        options.scale = scale;
        extractOne(map, options);
      }
    }
  }

  void extractOne(const TetMap& map, const extraction::EngineOptions& options) {
    Context context(1);
    ExtractStatistics statistics;
    hexes += extraction::extractWith(map, options, context, &statistics).cells.size();
    seconds += statistics.seconds;
    for (const StageTime& time : context.stageTimes()) {
      if (time.stage == "vertices") vertexSeconds += time.seconds;
    }
  }
};

void epsilonBenchmark(benchmark::State& state, double epsilon) {
  Sums sums;
  for (auto _ : state) {
    const double before = sums.vertexSeconds;
    sums.extractAll(epsilon);
    state.SetIterationTime(sums.vertexSeconds - before);
  }
  const auto runs = static_cast<double>(state.iterations());
  state.counters["vertex_seconds"] = sums.vertexSeconds / runs;
  state.counters["seconds"] = sums.seconds / runs;
  state.counters["hexes"] = static_cast<double>(sums.hexes) / runs;
}

}  // namespace

void registerEpsilon() {
  struct Epsilon {
    const char* name;
    double value;
  };
  constexpr std::array<Epsilon, 10> kEpsilons = {
      {{"0", 0},
       {"1e-16", 1e-16},
       {"1e-12", 1e-12},
       {"1e-9", 1e-9},
       {"1e-6", 1e-6},
       {"1e-3", 1e-3},
       {"1e-2", 1e-2},
       {"1e-1", 1e-1},
       {"1", 1},
       {"inf", std::numeric_limits<double>::infinity()}}};
  for (const Epsilon& epsilon : kEpsilons) {
    const std::string name = std::string("epsilon/all/epsilon:") + epsilon.name + "/threads:1";
    benchmark::RegisterBenchmark(
        name.c_str(),
        [epsilon](benchmark::State& state) { epsilonBenchmark(state, epsilon.value); })
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
  }
}

}  // namespace hexhex::bench
