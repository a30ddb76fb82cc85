// Files: reading and writing, beside the yardstick of plainly writing as many bytes. All files are
// in the system's cache.
#include <algorithm>
#include <chrono>
#include <ctime>
#include <fcntl.h>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <system_error>
#include <unistd.h>
#include <vector>

#include <benchmark/benchmark.h>

#include <hexhex/extract.hpp>
#include <hexhex/io.hpp>
#include <hexhex/quality.hpp>
#include <hexhex/survey.hpp>

#include "bench_maps.hpp"
#include "benchmarks.hpp"

namespace hexhex::bench {

namespace {

/// A folder for temporary files; it lives as long as this object.
class TemporaryFolder {
 public:
  TemporaryFolder()
      : path_(std::filesystem::temp_directory_path() /
              ("hexhex_bench_" + std::to_string(std::random_device()()))) {
    std::filesystem::create_directory(path_);
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const {
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

const TemporaryFolder& folder() {
  static const TemporaryFolder folder;
  return folder;
}

double secondsSince(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Time of all threads of this process together: what others do on this machine is not in it.
double cpuSeconds() {
  return static_cast<double>(std::clock()) / static_cast<double>(CLOCKS_PER_SEC);
}

/// The rate by the time that all cores spent; `bytes_per_second` is by the clock on the wall.
/// @param cpu  seconds of all iterations, together
void setMegabytesPerCore(benchmark::State& state, std::uint64_t bytes, double cpu) {
  constexpr double kMega = 1e6;
  state.counters["mb_per_core_second"] =
      static_cast<double>(bytes) * static_cast<double>(state.iterations()) / kMega / cpu;
}

/// A dense mesh, its scaled Jacobians, and how long its extraction took with so many threads.
struct DenseMesh {
  HexMesh mesh;
  Array<double> quality;
  std::vector<double> extractionSeconds;  ///< by number of threads
};

/// The densest of the maps: a real one if there is one, else generated.
const BenchMap& denseMap() {
  const std::vector<BenchMap>& maps = benchMaps();
  const auto find = [&maps](std::string_view name) {
    return std::find_if(maps.begin(), maps.end(),
                        [name](const BenchMap& map) { return map.name == name; });
  };
  const auto real = find("s17c_sphere_r100_x2");
  return real != maps.end() ? *real : *find("sphere_blocks_high");
}

const DenseMesh& denseMesh() {
  static const DenseMesh dense = [] {
    DenseMesh result;
    result.extractionSeconds.push_back(0);
    ExtractOptions options;
    options.scale = denseMap().scale;
    for (const int threads : {1, 2}) {
      double best = std::numeric_limits<double>::max();
      for (int run = 0; run < 2; ++run) {  // the first one finds its memory cold
        Context context(threads);
        result.mesh = {};
        const auto begin = std::chrono::steady_clock::now();
        result.mesh = extract(load(denseMap()), options, context);
        best = std::min(best, secondsSince(begin));
      }
      result.extractionSeconds.push_back(best);
    }
    Context context;
    result.quality = scaledJacobians(result.mesh, context);
    return result;
  }();
  return dense;
}

/// Seconds for writing as many bytes from memory that is in use already, with one thread.
double secondsOfPlainWrite(std::uint64_t bytes) {
  constexpr std::size_t kSlice = std::size_t{1} << 22;
  static const std::vector<char> slice(kSlice, 'x');
  const std::filesystem::path file = folder() / "plain";
  const auto begin = std::chrono::steady_clock::now();
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  while (bytes > 0) {
    const ssize_t written =
        ::write(descriptor, slice.data(), std::min<std::uint64_t>(bytes, kSlice));
    if (written <= 0) break;
    bytes -= static_cast<std::uint64_t>(written);
  }
  ::close(descriptor);
  const double seconds = secondsSince(begin);
  std::filesystem::remove(file);
  return seconds;
}

/// Of a file, or of all files in a folder: some formats are folders.
std::uint64_t bytesOf(const std::filesystem::path& file) {
  if (!std::filesystem::is_directory(file)) return std::filesystem::file_size(file);
  std::uint64_t bytes = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(file)) {
    if (entry.is_regular_file()) bytes += entry.file_size();
  }
  return bytes;
}

/// Times f(file) for a file that does not exist before.
template <class F>
void timeWriting(benchmark::State& state, const std::string& name, double extractionSeconds,
                 const F& f) {
  const std::filesystem::path file = folder() / name;
  double total = 0;
  double plain = 0;
  double cpu = 0;
  std::uint64_t bytes = 0;
  for (auto _ : state) {
    std::filesystem::remove_all(file);
    const double cpuBegin = cpuSeconds();
    const auto begin = std::chrono::steady_clock::now();
    f(file);
    const double seconds = secondsSince(begin);
    cpu += cpuSeconds() - cpuBegin;
    state.SetIterationTime(seconds);
    total += seconds;
    bytes = bytesOf(file);
    plain += secondsOfPlainWrite(bytes);
  }
  std::filesystem::remove_all(file);
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(bytes));
  state.counters["ratio_to_plain_write"] = total / plain;
  setMegabytesPerCore(state, bytes, cpu);
  if (extractionSeconds == 0) return;
  state.counters["ratio_to_extraction"] =
      total / static_cast<double>(state.iterations()) / extractionSeconds;
}

/// A format and how it is written.
struct Way {
  std::string format;
  bool compress = false;

  [[nodiscard]] std::string name() const { return format + (compress ? "-zlib" : ""); }
  [[nodiscard]] WriteOptions writing() const {
    WriteOptions options;
    options.format = format;
    options.compress = compress;
    return options;
  }
  [[nodiscard]] ReadOptions reading() const {
    ReadOptions options;
    options.format = format;
    return options;
  }
};

void writing(benchmark::State& state, const Way& way, int threads) {
  const DenseMesh& dense = denseMesh();
  timeWriting(state, "mesh", dense.extractionSeconds[static_cast<std::size_t>(threads)],
              [&](const std::filesystem::path& file) {
                Context context(threads);
                WriteOptions options = way.writing();
                options.scaledJacobians = dense.quality;
                writeHexMesh(dense.mesh, file, options, context);
              });
}

/// Through a sink: reads the mesh piece by piece from a file that a benchmark before has written.
void copyingInPieces(benchmark::State& state, const Way& way, int threads) {
  const std::filesystem::path source = folder() / "source.vtu";
  if (!std::filesystem::exists(source)) writeHexMesh(denseMesh().mesh, source);
  timeWriting(state, "copy", 0, [&](const std::filesystem::path& file) {
    Context context(threads);
    readHexMeshTo(*openMeshSink(file, way.writing(), context), source, context);
  });
}

/// Times f(file) for a file that exists.
template <class F>
void timeReading(benchmark::State& state, const std::filesystem::path& file, const F& f) {
  const double begin = cpuSeconds();
  for (auto _ : state) f(file);
  const std::uint64_t bytes = bytesOf(file);
  setMegabytesPerCore(state, bytes, cpuSeconds() - begin);
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(bytes));
}

void readingMap(benchmark::State& state, const Way& way, int threads) {
  const std::filesystem::path file = folder() / ("map-" + way.name());
  Context writing;
  if (!std::filesystem::exists(file)) writeMap(load(middleMap()), file, way.writing(), writing);
  timeReading(state, file, [&](const std::filesystem::path& path) {
    Context context(threads);
    benchmark::DoNotOptimize(readMap(path, way.reading(), context).tets.data());
  });
}

void writingMap(benchmark::State& state, const Way& way, int threads) {
  const TetMap& map = load(middleMap());
  timeWriting(state, "map", 0, [&](const std::filesystem::path& file) {
    Context context(threads);
    writeMap(map, file, way.writing(), context);
  });
}

void readingMesh(benchmark::State& state, const Way& way, int threads) {
  const std::filesystem::path file = folder() / ("source-" + way.name());
  Context writing;
  if (!std::filesystem::exists(file)) {
    writeHexMesh(denseMesh().mesh, file, way.writing(), writing);
  }
  timeReading(state, file, [&](const std::filesystem::path& path) {
    Context context(threads);
    benchmark::DoNotOptimize(readHexMesh(path, way.reading(), context).cells.data());
  });
}

void surveying(benchmark::State& state, int threads) {
  const std::filesystem::path file = folder() / "source.vtu";
  if (!std::filesystem::exists(file)) writeHexMesh(denseMesh().mesh, file);
  timeReading(state, file, [threads](const std::filesystem::path& path) {
    Context context(threads);
    benchmark::DoNotOptimize(surveyFile(path, context).pointChecksum);
  });
}

/// @param manual  the benchmark reports its times itself
template <class F>
void add(const std::string& what, const BenchMap& map, bool manual, const F& f) {
  for (const int threads : {1, 2}) {
    const std::string name = what + "/" + map.name + "/threads:" + std::to_string(threads);
    auto* const registered = benchmark::RegisterBenchmark(
        name.c_str(), [f, threads](benchmark::State& state) { f(state, threads); });
    registered->Unit(benchmark::kMillisecond);
    if (manual) {
      registered->UseManualTime();
    } else {
      registered->UseRealTime();
    }
  }
}

/// The yardsticks: copying bytes in memory, touching fresh memory, and writing bytes to a file.
void copyingInMemory(benchmark::State& state) {
  std::vector<char> from(std::size_t{1} << 28, 'x');
  std::vector<char> to(from.size(), 'y');
  const double begin = cpuSeconds();
  for (auto _ : state) {
    std::copy(from.begin(), from.end(), to.begin());
    benchmark::DoNotOptimize(to.data());
    benchmark::ClobberMemory();
  }
  setMegabytesPerCore(state, from.size(), cpuSeconds() - begin);
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(from.size()));
}

/// What it costs to have memory at all: the system clears each page that is touched first.
void touchingFreshMemory(benchmark::State& state) {
  constexpr std::size_t kBytes = std::size_t{1} << 28;
  constexpr std::size_t kPage = 4096;
  const double begin = cpuSeconds();
  for (auto _ : state) {
    Array<char> memory(kBytes);
    for (std::size_t i = 0; i < kBytes; i += kPage) memory[i] = 1;
    benchmark::DoNotOptimize(memory.data());
  }
  setMegabytesPerCore(state, kBytes, cpuSeconds() - begin);
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(kBytes));
}

void writingPlainly(benchmark::State& state) {
  constexpr std::uint64_t kBytes = std::uint64_t{1} << 28;
  const double begin = cpuSeconds();
  for (auto _ : state) benchmark::DoNotOptimize(secondsOfPlainWrite(kBytes));
  setMegabytesPerCore(state, kBytes, cpuSeconds() - begin);
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(kBytes));
}

void addFormat(const FileFormat& format, const Way& way) {
  const std::string name = way.name();
  if (format.writesHexMeshes) {
    add("write_" + name, denseMap(), true,
        [way](benchmark::State& state, int threads) { writing(state, way, threads); });
  }
  if (format.readsHexMeshes && format.writesHexMeshes) {
    add("read_" + name, denseMap(), false,
        [way](benchmark::State& state, int threads) { readingMesh(state, way, threads); });
  }
  if (format.streams && !way.compress) {
    add("copy_in_pieces_to_" + name, denseMap(), true,
        [way](benchmark::State& state, int threads) { copyingInPieces(state, way, threads); });
  }
  if (format.writesMaps) {
    add("write_map_" + name, middleMap(), true,
        [way](benchmark::State& state, int threads) { writingMap(state, way, threads); });
  }
  if (format.readsMaps && format.writesMaps) {
    add("read_map_" + name, middleMap(), false,
        [way](benchmark::State& state, int threads) { readingMap(state, way, threads); });
  }
}

}  // namespace

void registerFiles() {
  benchmark::RegisterBenchmark("memcpy", copyingInMemory)->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("fresh_memory", touchingFreshMemory)->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("plain_write", writingPlainly)->Unit(benchmark::kMillisecond);
  for (const FileFormat& format : fileFormats()) {
    addFormat(format, {std::string(format.name)});
    if (format.compresses) addFormat(format, {std::string(format.name), true});
  }
  add("survey_vtu", denseMap(), false, surveying);
}

}  // namespace hexhex::bench
