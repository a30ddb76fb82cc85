// Benchmarks of the engines through the public face. See docs/results/performance.md.
#include <benchmark/benchmark.h>

#include "benchmarks.hpp"

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  hexhex::bench::registerExtraction();
  hexhex::bench::registerScales();
  hexhex::bench::registerDensities();
  hexhex::bench::registerMesh();
  hexhex::bench::registerFiles();
  hexhex::bench::registerCurved();
  hexhex::bench::registerRepair();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
