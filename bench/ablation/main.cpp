// Comparisons of alternatives inside the library. See docs/results/performance.md,
// docs/results/ablation.md.
#include <benchmark/benchmark.h>

#include "ablation/benchmarks.hpp"

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  hexhex::bench::registerEpsilon();
  hexhex::bench::registerRasterization();
  hexhex::bench::registerLookup();
  hexhex::bench::registerSwitches();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
