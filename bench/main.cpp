// Benchmarks of the engine. See docs/performance.md; bench/run makes the table there.
#include <benchmark/benchmark.h>

#include "benchmarks.hpp"

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  hexhex::bench::registerExtraction();
  hexhex::bench::registerMesh();
  hexhex::bench::registerFiles();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
