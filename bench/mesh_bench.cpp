// What the command does beside an extraction: verification, quality with certificates, and all of
// it, from a file to a file.
#include <algorithm>
#include <chrono>
#include <fstream>
#include <iterator>
#include <optional>
#include <spawn.h>
#include <string>
#include <sys/wait.h>
#include <thread>
#include <vector>

#include <benchmark/benchmark.h>

#include <hexhex/extract.hpp>
#include <hexhex/extractor.hpp>
#include <hexhex/io.hpp>
#include <hexhex/quality.hpp>

#include "bench_maps.hpp"
#include "benchmarks.hpp"
#include "memory.hpp"
#include "plain_write.hpp"

extern char** environ;  // NOLINT(readability-redundant-declaration): not in all systems' headers

namespace hexhex::bench {

namespace {

/// Adds the time of f() to `sum`.
template <class F>
void measure(double& sum, const F& f) {
  const auto begin = std::chrono::steady_clock::now();
  f();
  sum += secondsSince(begin);
}

/// Adds a benchmark that says itself how long each run took.
template <class F>
void enter(const std::string& name, const F& f) {
  benchmark::RegisterBenchmark(name.c_str(), f)->UseManualTime()->Unit(benchmark::kMillisecond);
}

/// Seconds of the three, or of several runs together.
struct Seconds {
  double extraction = 0;
  double verification = 0;
  double quality = 0;
};

/// @return the number of cells, or 0 if the mesh failed its verification
std::size_t checkOnce(const TetMap& map, int scale, int threads, Seconds& seconds) {
  Context context(threads);
  ExtractOptions extracting;
  extracting.scale = scale;
  VerifyOptions verifying;
  verifying.scale = scale;
  // As the command: what prepares the map serves both, and counts as extraction.
  std::optional<Extractor> extractor;
  HexMesh mesh;
  bool passed = false;
  measure(seconds.extraction, [&] {
    extractor.emplace(map, ExtractorOptions{.maxScale = scale}, context);
    mesh = extractor->extract(extracting, context);
  });
  measure(seconds.verification,
          [&] { passed = extractor->verify(mesh, verifying, context).passed(); });
  measure(seconds.quality, [&] { benchmark::DoNotOptimize(certify(mesh, context)); });
  return passed ? mesh.cells.size() : 0;
}

void checking(benchmark::State& state, const BenchMap& which, int threads) {
  const TetMap& map = load(which);
  const std::uint64_t bytes = peakOf("check " + which.name + std::to_string(threads), [&] {
    Seconds ignored;
    checkOnce(map, which.scale, threads, ignored);
  });
  Seconds seconds;
  std::size_t hexes = 0;
  for (auto _ : state) {
    releaseFreeMemory();
    warmFreeMemory(bytes, threads);
    Seconds once;
    hexes = checkOnce(map, which.scale, threads, once);
    if (hexes == 0) {
      state.SkipWithError("the mesh failed its verification");
      return;
    }
    state.SetIterationTime(once.verification + once.quality);
    seconds.extraction += once.extraction;
    seconds.verification += once.verification;
    seconds.quality += once.quality;
  }
  const auto runs = static_cast<double>(state.iterations());
  state.counters["tets"] = static_cast<double>(map.tets.size());
  state.counters["hexes"] = static_cast<double>(hexes);
  state.counters["extraction_seconds"] = seconds.extraction / runs;
  state.counters["verification_seconds"] = seconds.verification / runs;
  state.counters["quality_seconds"] = seconds.quality / runs;
}

#ifdef HEXHEX_COMMAND
/// What a run of the command took.
struct Run {
  double seconds = 0;
  double writingSeconds = 0;  ///< 0 if it wrote while it extracted
  double peakBytes = 0;
  bool succeeded = false;
};

/// The number behind a key of a report, if it is there.
std::optional<double> numberOf(const std::string& report, const std::string& key) {
  const std::string quoted = "\"" + key + "\":";
  const std::size_t place = report.find(quoted);
  if (place == std::string::npos) return std::nullopt;
  return std::stod(report.substr(place + quoted.size()));
}

/// @param report  where the command writes its report
Run runCommand(std::vector<std::string> words, const std::filesystem::path& report) {
  words.insert(words.end(), {"--report", report.string()});
  // As a child of a shell: that of this process would count its memory as its own.
  words.insert(words.begin(), {"/bin/sh", "-c", "\"$@\"; exit $?", "sh"});
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  Run run;
  measure(run.seconds, [&] {
    pid_t child = 0;
    int status = 1;
    if (posix_spawn(&child, arguments[0], nullptr, nullptr, arguments.data(), environ) != 0) return;
    run.succeeded = waitpid(child, &status, 0) == child && status == 0;
  });
  std::ifstream file(report);
  const std::string text(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>{});
  const std::optional<double> peak = numberOf(text, "peak_memory_bytes");
  run.succeeded = run.succeeded && peak.has_value();
  run.peakBytes = peak.value_or(0);
  run.writingSeconds = numberOf(text, "writing").value_or(0);
  return run;
}

/// `hexhex extract` with its defaults, into a .vtu file.
void commanding(benchmark::State& state, const BenchMap& which, int threads) {
  const TetMap& map = load(which);
  const std::filesystem::path input = folder() / "map.hexex";
  const std::filesystem::path output = folder() / "mesh.vtu";
  writeMap(map, input);
  const std::string scale = std::to_string(which.scale);
  double total = 0;
  double extraction = 0;
  double write = 0;
  double memory = 0;
  double known = 0;
  for (auto _ : state) {
    std::filesystem::remove(output);
    const Run run = runCommand({HEXHEX_COMMAND, "extract", input.string(), "-o", output.string(),
                                "--quiet", "--scale", scale, "--threads", std::to_string(threads)},
                               folder() / "report.json");
    if (!run.succeeded) {
      state.SkipWithError("the command failed");
      return;
    }
    state.SetIterationTime(run.seconds);
    total += run.seconds;
    memory += run.peakBytes;
    write += secondsOfPlainWrite(std::filesystem::file_size(output));
    Context context(threads);
    ExtractOptions options;
    options.scale = which.scale;
    releaseFreeMemory();
    HexMesh mesh;
    measure(extraction, [&] { mesh = extract(map, options, context); });
    known = static_cast<double>((mesh.points.size() + map.points.size()) * sizeof(Vec3) +
                                mesh.cells.size() * sizeof(Hex) +
                                map.tets.size() * (sizeof(Tet) + 4 * sizeof(Vec3)));
  }
  std::filesystem::remove(output);
  std::filesystem::remove(input);
  const auto runs = static_cast<double>(state.iterations());
  state.counters["extraction_seconds"] = extraction / runs;
  state.counters["plain_write_seconds"] = write / runs;
  state.counters["ratio_to_both"] = total / (extraction + write);
  state.counters["peak_bytes"] = memory / runs;
  state.counters["bytes_of_mesh_and_map"] = known;
}

/// How the command writes a mesh.
struct Way {
  const char* name;
  std::vector<std::string> options;
  const char* file;
};

/// `hexhex extract` into a file of a mesh in memory, piece by piece, or into files of parts.
void writing(benchmark::State& state, const Way& way, int threads) {
  const BenchMap& which = writtenMap();
  const std::filesystem::path input = folder() / "map.hexex";
  const std::filesystem::path output = folder() / "written";
  writeMap(load(which), input);
  std::vector<std::string> words = {HEXHEX_COMMAND, "extract", input.string(), "--quiet"};
  words.insert(words.end(), {"-o", (output / way.file).string()});
  words.insert(words.end(), {"--scale", std::to_string(which.scale)});
  words.insert(words.end(), {"--threads", std::to_string(threads)});
  words.insert(words.end(), way.options.begin(), way.options.end());
  Run sum;
  double plain = 0;
  for (auto _ : state) {
    std::filesystem::remove_all(output);
    std::filesystem::create_directory(output);
    const Run run = runCommand(words, folder() / "report.json");
    if (!run.succeeded) {
      state.SkipWithError("the command failed");
      return;
    }
    state.SetIterationTime(run.seconds);
    sum.writingSeconds += run.writingSeconds;
    sum.peakBytes += run.peakBytes;
    const std::uint64_t bytes = bytesOf(output);
    std::filesystem::remove_all(output);  // room for as many bytes
    plain += secondsOfPlainWrite(bytes, threads);
  }
  std::filesystem::remove(input);
  const auto runs = static_cast<double>(state.iterations());
  state.counters["writing_seconds"] = sum.writingSeconds / runs;
  state.counters["plain_write_seconds"] = plain / runs;
  state.counters["peak_bytes"] = sum.peakBytes / runs;
}

/// With 1, 2, 4, ... threads, up to as many as there are.
void addWays() {
  const std::vector<Way> ways = {{"memory", {}, "mesh.vtu"},
                                 {"stream", {"--stream"}, "mesh.vtu"},
                                 {"parts64", {"--parts", "64"}, "mesh.pvtu"}};
  const int all = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  for (int threads = 1; threads <= all; threads *= 2) {
    for (const Way& way : ways) {
      const std::string name =
          "ways/" + writtenMap().name + "/way:" + way.name + "/threads:" + std::to_string(threads);
      enter(name, [way, threads](benchmark::State& state) { writing(state, way, threads); });
    }
  }
}

#endif

template <class F>
void add(const std::string& family, const BenchMap& map, const F& f) {
  for (const int threads : {1, 2}) {
    const std::string name = family + "/" + map.name + "/threads:" + std::to_string(threads);
    enter(name, [f, map, threads](benchmark::State& state) { f(state, map, threads); });
  }
}

}  // namespace

void registerMesh() {
  for (const BenchMap& map : checkedMaps()) add("check", map, checking);
#ifdef HEXHEX_COMMAND
  for (const BenchMap& map : checkedMaps()) add("command", map, commanding);
  addWays();
#endif
}

}  // namespace hexhex::bench
