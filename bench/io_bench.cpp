// Reading a map from a .hexex file that the system holds in its cache.
#include <random>
#include <string>
#include <system_error>

#include <benchmark/benchmark.h>

#include <hexhex/io.hpp>

#include "bench_maps.hpp"
#include "benchmarks.hpp"

namespace hexhex::bench {

namespace {

/// A map in the folder for temporary files; it lives as long as this object.
class TemporaryMap {
 public:
  TemporaryMap()
      : path_(std::filesystem::temp_directory_path() /
              ("hexhex_bench_" + std::to_string(std::random_device()()) + ".hexex")) {
    writeMap(load(middleMap()), path_);
  }
  ~TemporaryMap() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  TemporaryMap(const TemporaryMap&) = delete;
  TemporaryMap& operator=(const TemporaryMap&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

 private:
  std::filesystem::path path_;
};

void reading(benchmark::State& state) {
  static const TemporaryMap file;
  for (auto _ : state) benchmark::DoNotOptimize(readMap(file.path()).tets.data());
  state.SetBytesProcessed(state.iterations() *
                          static_cast<std::int64_t>(std::filesystem::file_size(file.path())));
  state.counters["tets"] = static_cast<double>(load(middleMap()).tets.size());
}

}  // namespace

void registerFiles() {
  benchmark::RegisterBenchmark(("read_hexex/" + middleMap().name).c_str(), reading)
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond);
}

}  // namespace hexhex::bench
