// Files: reading and writing, beside the yardstick of plainly writing as many bytes. All files are
// in the system's cache. Binary formats have a dense mesh, texts and compressed files an eighth of
// it, as they are as large and take ten times as long.
#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include <hexhex/extract.hpp>
#include <hexhex/io.hpp>
#include <hexhex/quality.hpp>
#include <hexhex/summary.hpp>

#include "bench_maps.hpp"
#include "benchmarks.hpp"
#include "memory.hpp"
#include "plain_write.hpp"

namespace hexhex::bench {

namespace {

constexpr std::array<int, 2> kThreads = {1, 2};

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

/// A mesh, its scaled Jacobians, and how long its extraction took with so many threads.
struct BenchMesh {
  BenchMap map;
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

/// The same at scale 1, if that is another one.
const BenchMap& lessDenseMap() {
  static const BenchMap map = [] {
    BenchMap result = denseMap();
    const std::string ending = "_x" + std::to_string(result.scale);
    if (result.scale > 1 && result.name.ends_with(ending)) {
      result.name.replace(result.name.size() - ending.size(), ending.size(), "_x1");
      result.scale = 1;
    }
    return result;
  }();
  return map;
}

BenchMesh makeMesh(const BenchMap& map) {
  BenchMesh result;
  result.map = map;
  result.extractionSeconds.push_back(0);
  ExtractOptions options;
  options.scale = map.scale;
  for (const int threads : kThreads) {
    double best = std::numeric_limits<double>::max();
    for (int run = 0; run < 2; ++run) {  // the first one finds its memory cold
      Context context(threads);
      result.mesh = {};
      const auto begin = std::chrono::steady_clock::now();
      result.mesh = extract(load(map), options, context);
      best = std::min(best, secondsSince(begin));
    }
    result.extractionSeconds.push_back(best);
  }
  Context context;
  result.quality = scaledJacobians(result.mesh, context);
  return result;
}

const BenchMesh& denseMesh() {
  static const BenchMesh mesh = makeMesh(denseMap());
  return mesh;
}

const BenchMesh& lessDenseMesh() {
  static const BenchMesh mesh = makeMesh(lessDenseMap());
  return mesh;
}

/// What one run takes, in bytes.
struct Need {
  std::uint64_t memory = 0;
  std::uint64_t file = 0;
};

/// Runs f(file) once and looks. The last name's is remembered, as repetitions of a benchmark call
/// its function anew.
template <class F>
Need needOf(const std::string& name, const std::filesystem::path& file, const F& f) {
  static std::string knownName;
  static Need known;
  if (knownName != name) {
    const PeakMemory peak;
    f(file);
    known = {peak.growth().value_or(0), bytesOf(file)};
    knownName = name;
  }
  return known;
}

/// Times f(file), which finds as much memory as it and its file need free and warm.
/// @param before  prepares a run; called with the size of the file
/// @return seconds of all runs
template <class Before, class F>
double timeRuns(benchmark::State& state, const std::string& name, const std::filesystem::path& file,
                const Before& before, const F& f) {
  const Need need = needOf(name, file, f);
  double total = 0;
  double cpu = 0;
  for (auto _ : state) {
    before(need.file);
    warmFreeMemory(need.memory + need.file, kThreads.back());
    const double cpuBegin = cpuSeconds();
    const auto begin = std::chrono::steady_clock::now();
    f(file);
    const double seconds = secondsSince(begin);
    cpu += cpuSeconds() - cpuBegin;
    state.SetIterationTime(seconds);
    total += seconds;
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(need.file));
  setMegabytesPerCore(state, need.file, cpu);
  return total;
}

/// A format, compressed or not.
struct FormatVariant {
  std::string format;
  Compression compress = Compression::None;

  /// Whether numbers are spelt or compressed.
  [[nodiscard]] bool isSlow() const {
    constexpr std::array<std::string_view, 8> kTexts = {"mesh",        "vtk", "ovm",  "msh41-ascii",
                                                        "msh22-ascii", "inp", "mfem", "openfoam"};
    return compress != Compression::None ||
           std::find(kTexts.begin(), kTexts.end(), format) != kTexts.end();
  }
  [[nodiscard]] const BenchMap& map() const { return isSlow() ? lessDenseMap() : denseMap(); }
  [[nodiscard]] const BenchMesh& mesh() const { return isSlow() ? lessDenseMesh() : denseMesh(); }

  [[nodiscard]] std::string name() const {
    if (compress == Compression::None) return format;
    return format + (compress == Compression::Zlib ? "-zlib" : "-lz4");
  }
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

/// Times f(file) for a file that does not exist before.
template <class F>
void timeWriting(benchmark::State& state, const std::string& name, double extractionSeconds,
                 const F& f) {
  const std::filesystem::path file = folder() / "written";
  double plain = 0;
  const auto before = [&](std::uint64_t bytes) {
    std::filesystem::remove_all(file);
    plain += secondsOfPlainWrite(bytes);
  };
  const double total = timeRuns(state, "write " + name, file, before, f);
  std::filesystem::remove_all(file);
  state.counters["ratio_to_plain_write"] = total / plain;
  if (extractionSeconds == 0) return;
  state.counters["ratio_to_extraction"] =
      total / static_cast<double>(state.iterations()) / extractionSeconds;
}

/// Times f(file) for a file that exists.
template <class F>
void timeReading(benchmark::State& state, const std::filesystem::path& file, const F& f) {
  timeRuns(
      state, "read " + file.string(), file, [](std::uint64_t /*bytes*/) {}, f);
}

void writing(benchmark::State& state, const FormatVariant& variant, int threads) {
  const BenchMesh& mesh = variant.mesh();
  timeWriting(state, "mesh " + variant.name(),
              mesh.extractionSeconds[static_cast<std::size_t>(threads)],
              [&](const std::filesystem::path& file) {
                Context context(threads);
                WriteOptions options = variant.writing();
                options.scaledJacobians = mesh.quality;
                writeHexMesh(mesh.mesh, file, options, context);
              });
}

/// The mesh as a file that can be read piece by piece.
std::filesystem::path sourceOf(const BenchMesh& mesh) {
  std::filesystem::path file = folder() / (mesh.map.name + ".vtu");
  if (!std::filesystem::exists(file)) writeHexMesh(mesh.mesh, file);
  return file;
}

/// Through a sink: reads the mesh piece by piece from a file that a benchmark before has written.
void copyingInPieces(benchmark::State& state, const FormatVariant& variant, int threads) {
  const std::filesystem::path source = sourceOf(variant.mesh());
  timeWriting(state, "copy " + variant.name(), 0, [&](const std::filesystem::path& file) {
    Context context(threads);
    readHexMeshTo(*openMeshSink(file, variant.writing(), context), source, context);
  });
}

void readingMap(benchmark::State& state, const FormatVariant& variant, int threads) {
  const std::filesystem::path file = folder() / ("map-" + variant.name());
  Context writing;
  if (!std::filesystem::exists(file)) writeMap(load(middleMap()), file, variant.writing(), writing);
  timeReading(state, file, [&](const std::filesystem::path& path) {
    Context context(threads);
    benchmark::DoNotOptimize(readMap(path, variant.reading(), context).tets.data());
  });
}

void writingMap(benchmark::State& state, const FormatVariant& variant, int threads) {
  const TetMap& map = load(middleMap());
  timeWriting(state, "map " + variant.name(), 0, [&](const std::filesystem::path& file) {
    Context context(threads);
    writeMap(map, file, variant.writing(), context);
  });
}

void readingMesh(benchmark::State& state, const FormatVariant& variant, int threads) {
  const std::filesystem::path file = folder() / ("source-" + variant.name());
  Context writing;
  if (!std::filesystem::exists(file)) {
    writeHexMesh(variant.mesh().mesh, file, variant.writing(), writing);
  }
  timeReading(state, file, [&](const std::filesystem::path& path) {
    Context context(threads);
    benchmark::DoNotOptimize(readHexMesh(path, variant.reading(), context).cells.data());
  });
}

void summarizing(benchmark::State& state, int threads) {
  const std::filesystem::path file = sourceOf(denseMesh());
  timeReading(state, file, [threads](const std::filesystem::path& path) {
    Context context(threads);
    benchmark::DoNotOptimize(summarizeFile(path, context).pointChecksum);
  });
}

template <class F>
void add(const std::string& what, const BenchMap& map, const F& f) {
  for (const int threads : kThreads) {
    const std::string name = what + "/" + map.name + "/threads:" + std::to_string(threads);
    auto* const registered = benchmark::RegisterBenchmark(
        name.c_str(), [f, threads](benchmark::State& state) { f(state, threads); });
    registered->Unit(benchmark::kMillisecond)->UseManualTime();
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

void addFormat(const FileFormat& format, const FormatVariant& variant) {
  const std::string name = variant.name();
  if (format.writesHexMeshes) {
    add("write_" + name, variant.map(),
        [variant](benchmark::State& state, int threads) { writing(state, variant, threads); });
  }
  if (format.readsHexMeshes && format.writesHexMeshes) {
    add("read_" + name, variant.map(),
        [variant](benchmark::State& state, int threads) { readingMesh(state, variant, threads); });
  }
  if (format.streams && variant.compress == Compression::None) {
    add("copy_in_pieces_to_" + name, variant.map(),
        [variant](benchmark::State& state, int threads) {
          copyingInPieces(state, variant, threads);
        });
  }
  if (format.writesMaps) {
    add("write_map_" + name, middleMap(),
        [variant](benchmark::State& state, int threads) { writingMap(state, variant, threads); });
  }
  if (format.readsMaps && format.writesMaps) {
    add("read_map_" + name, middleMap(),
        [variant](benchmark::State& state, int threads) { readingMap(state, variant, threads); });
  }
}

}  // namespace

void registerFiles() {
  benchmark::RegisterBenchmark("memcpy", copyingInMemory)->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("fresh_memory", touchingFreshMemory)->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("plain_write", writingPlainly)->Unit(benchmark::kMillisecond);
  for (const FileFormat& format : fileFormats()) {
    addFormat(format, {std::string(format.name)});
    if (!format.compresses) continue;
    for (const Compression how : {Compression::Zlib, Compression::Lz4}) {
      addFormat(format, {std::string(format.name), how});
    }
  }
  add("summarize_vtu", denseMap(), summarizing);
}

}  // namespace hexhex::bench
