// What each of many processes takes to make its part of a mesh: all parts, one after the other with
// one thread, and the mesh in one piece beside them. (docs/results/scaling.md)
//
//   hexhex_part_times MAP SCALE PARTS...
//
// Prints a line of JSON for each number of parts; for 0, the mesh in one piece. Seconds, and bytes.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include <hexhex/io.hpp>
#include <hexhex/parts.hpp>
#include <hexhex/stream.hpp>

#include "memory.hpp"

using namespace hexhex;

namespace {

/// Of the processor: other programs may run beside this one.
double secondsNow() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

std::uint64_t bytesOf(const auto& array) { return std::span(array).size_bytes(); }

std::uint64_t bytesOf(const MeshPart& part) {
  std::uint64_t bytes = bytesOf(part.mesh.points) + bytesOf(part.mesh.cells) +
                        bytesOf(part.mesh.generatorTet) + bytesOf(part.mesh.generatorCorners) +
                        bytesOf(part.mesh.regions) + bytesOf(part.globalPoints) +
                        bytesOf(part.globalCells) + bytesOf(part.pointOwners) +
                        bytesOf(part.ghostParts) + bytesOf(part.ghostLayers);
  for (const PartNeighbour& neighbour : part.neighbours) {
    bytes += bytesOf(neighbour.vertices) + bytesOf(neighbour.faces);
  }
  return bytes;
}

/// Measures parts, and forgets them.
class Stopwatch final : public PartSink {
 public:
  Stopwatch() { next(); }
  void begin(const PartsInfo& /*info*/) override {
    preparation = secondsNow() - begin_;
    tables = memory_->growth().value_or(0);
    next();
  }
  void part(MeshPart&& part) override {
    const double seconds = secondsNow() - begin_;
    sum += seconds;
    slowest = std::max(slowest, seconds);
    const std::uint64_t growth = memory_->growth().value_or(0);
    if (growth > mostMemory) {
      mostMemory = growth;
      bytes = bytesOf(part);
    }
    mostCells = std::max(mostCells, part.ownCells);
    part = {};
    next();
  }
  void end() override {}

  double preparation = 0;
  std::uint64_t tables = 0;  ///< by which preparation made the process grow
  double sum = 0;
  double slowest = 0;
  std::uint64_t mostMemory = 0;  ///< by which a part made the process grow
  std::uint64_t bytes = 0;       ///< of that part
  std::uint64_t mostCells = 0;

 private:
  void next() {
    memory_.emplace();
    begin_ = secondsNow();
  }
  std::optional<bench::PeakMemory> memory_;
  double begin_ = 0;
};

double secondsOf(const Context& context, std::string_view stage) {
  double seconds = 0;
  for (const StageTime& time : context.stageTimes()) {
    if (time.stage == stage) seconds += time.seconds;
  }
  return seconds;
}

std::uint64_t bytesOf(const TetMap& map) {
  return bytesOf(map.points) + bytesOf(map.tets) + bytesOf(map.parameters);
}

/// What processes tell each other when they share the counting: two numbers for a tet, and one for
/// each of its vertices, edges and faces with hex vertices.
std::uint64_t bytesOfCounts(const TetMap& map, const ExtractStatistics& statistics) {
  const auto& generators = statistics.generators;
  return (2 * map.tets.size() + generators[0] + generators[1] + generators[2]) *
         sizeof(std::uint64_t);
}

void timeParts(const TetMap& map, const ExtractOptions& options, std::uint32_t parts) {
  Context context(1);
  Stopwatch watch;
  ExtractStatistics statistics;
  extractParts(watch, map, options, {parts}, context, &statistics);
  const auto print = [](const char* name, auto value) {
    if constexpr (std::is_floating_point_v<decltype(value)>) {
      std::printf(", \"%s\": %.4f", name, value);
    } else {
      std::printf(", \"%s\": %llu", name, static_cast<unsigned long long>(value));
    }
  };
  std::printf("{\"parts\": %u", parts);
  print("preparation", watch.preparation);
  print("counting", secondsOf(context, "sweep"));
  print("sum", watch.sum);
  print("slowest", watch.slowest);
  print("map", bytesOf(map));
  print("counts", bytesOfCounts(map, statistics));
  print("tables", watch.tables);
  print("memory", watch.mostMemory);
  print("bytes", watch.bytes);
  print("cells", watch.mostCells);
  std::printf("}\n");
}

/// Where a mesh in one piece goes.
class Nowhere final : public MeshSink {
 public:
  void begin(std::uint64_t /*pointCount*/, std::uint64_t cellCount) override { count = cellCount; }
  void points(const PointPiece& /*piece*/) override {}
  void cells(std::uint64_t /*first*/, std::span<const Hex> /*cells*/) override {}
  void cells(std::uint64_t /*first*/, std::span<const Hex64> /*cells*/) override {}
  void end() override {}
  std::uint64_t count = 0;
};

void timeStream(const TetMap& map, const ExtractOptions& options) {
  Context context(1);
  Nowhere nowhere;
  const bench::PeakMemory memory;
  const double begin = secondsNow();
  extractTo(nowhere, map, options, context);
  std::printf("{\"parts\": 0, \"sum\": %.4f, \"memory\": %llu, \"cells\": %llu}\n",
              secondsNow() - begin, static_cast<unsigned long long>(memory.growth().value_or(0)),
              static_cast<unsigned long long>(nowhere.count));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "usage: hexhex_part_times MAP SCALE PARTS...\n");
    return 2;
  }
  const TetMap map = readMap(argv[1]);
  ExtractOptions options;
  options.scale = std::stoi(argv[2]);
  for (int i = 3; i < argc; ++i) {
    const auto parts = static_cast<std::uint32_t>(std::stoul(argv[i]));
    if (parts == 0) {
      timeStream(map, options);
    } else {
      timeParts(map, options, parts);
    }
    std::fflush(stdout);
  }
}
