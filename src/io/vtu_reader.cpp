// The reading half of vtu.hpp: a whole file at once, or piece by piece.
#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <vector>

#include <hexhex/stream.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/input_file.hpp>
#include <io/mesh_pieces.hpp>
#include <io/vtu.hpp>
#include <io/vtu_elements.hpp>
#include <io/vtu_file.hpp>

namespace hexhex {
namespace {

// Points or cells that one thread reads in a go: a fraction of a millisecond's work.
constexpr std::size_t kGrain = std::size_t{1} << 13;

// Points or cells of a piece: a few megabytes.
constexpr std::size_t kPiece = std::size_t{1} << 16;

/// The error of the first block that failed, whatever the order in which blocks run.
class FirstError {
 public:
  /// Calls f(), and keeps what it throws.
  template <class F>
  void guard(std::size_t block, const F& f) {
    if (block > block_.load(std::memory_order_relaxed)) return;
    try {
      f();
    } catch (const Error&) {
      const std::lock_guard lock(mutex_);
      if (block >= block_.load(std::memory_order_relaxed)) return;
      block_ = block;
      error_ = std::current_exception();
    }
  }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  std::mutex mutex_;
  std::atomic<std::size_t> block_{~std::size_t{0}};
  std::exception_ptr error_;
};

void readPoints(const VtuFile& file, HexMesh& mesh, Stage& stage) {
  mesh.points.resize(file.pointCount());
  FirstError error;
  parallelBlocks(stage, mesh.points.size(), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   error.guard(block, [&] {
                     readVtuPoints(file, begin, std::span(mesh.points).subspan(begin, end - begin));
                   });
                 });
  error.rethrow();
}

void readCells(const VtuFile& file, HexMesh& mesh, Stage& stage) {
  const std::size_t cells = file.cellCount();
  std::vector<std::size_t> begins(blockCount(cells, kGrain) + 1, 0);
  parallelBlocks(stage, cells, kGrain, [&](std::size_t begin, std::size_t end, std::size_t block) {
    begins[block] = countVtuHexahedra(file, begin, end - begin);
  });
  const std::size_t hexahedra = exclusiveScan(std::span(begins));
  if (cells > 0 && hexahedra == 0) failWithoutHexahedra(file);
  mesh.cells.resize(hexahedra);
  FirstError error;
  parallelBlocks(stage, cells, kGrain, [&](std::size_t begin, std::size_t end, std::size_t block) {
    error.guard(block, [&] {
      readVtuHexahedra(file, begin, end - begin, mesh.cells.data() + begins[block]);
    });
  });
  error.rethrow();
}

HexMesh readMesh(std::string_view text, const std::string& fileName, Stage& stage) {
  const VtuFile file(text, fileName);
  file.requireIndexable();
  HexMesh mesh;
  readPoints(file, mesh, stage);
  readCells(file, mesh, stage);
  return mesh;
}

/// Calls f(first, count) for consecutive ranges of n elements, and reports progress.
template <class F>
void forEachPiece(Stage& stage, std::uint64_t n, const F& f) {
  LoopProgress progress(stage, n);
  for (std::uint64_t first = 0; first < n; first += kPiece) {
    const std::size_t count = std::min<std::uint64_t>(kPiece, n - first);
    f(first, count);
    progress.advance(count);
  }
}

void sendPoints(const VtuFile& file, MeshSink& sink, Stage& stage) {
  Array<Vec3> points;
  Array<Index> tets;
  Array<CornerSet> corners;
  forEachPiece(stage, file.pointCount(), [&](std::uint64_t first, std::size_t count) {
    points.resize(count);
    readVtuPoints(file, first, points);
    const auto copy = [&](const auto& column, auto& values) {
      if (!column) return;
      values.resize(count);
      file.copy(*column, first, count, values.data());
    };
    copy(file.generatorTets(), tets);
    copy(file.generatorCorners(), corners);
    sink.points({first, points, tets, corners});
  });
}

template <class Cell>
void sendCells(const VtuFile& file, MeshSink& sink, Stage& stage) {
  Array<Cell> cells;
  std::uint64_t sent = 0;
  forEachPiece(stage, file.cellCount(), [&](std::uint64_t first, std::size_t count) {
    cells.resize(countVtuHexahedra(file, first, count));
    readVtuHexahedra(file, first, count, cells.data());
    if (!cells.empty()) sink.cells(sent, std::span<const Cell>(cells));
    sent += cells.size();
  });
}

}  // namespace

HexMesh parseVtu(std::string_view text, const std::string& fileName, Context& context) {
  Stage stage(context, "read mesh");
  HexMesh mesh;
  withThreads(context.threads(), [&] { mesh = readMesh(text, fileName, stage); });
  return mesh;
}

HexMesh readVtu(const std::filesystem::path& file, Context& context) {
  Stage stage(context, "read mesh");
  HexMesh mesh;
  withThreads(context.threads(), [&] {
    const Array<char> bytes = readWholeFile(file, stage);
    mesh = readMesh(asText(bytes), file.string(), stage);
  });
  return mesh;
}

void readVtuTo(MeshSink& sink, const std::filesystem::path& path, Context& context) {
  const InputFile input(path);
  if (!input.isRegular() || !VtuFile::hasAppendedData(input)) {
    return sendTo(sink, readVtu(path, context));
  }
  Stage stage(context, "read mesh");
  const VtuFile file(input, path.string());
  std::uint64_t hexahedra = 0;
  forEachPiece(stage, file.cellCount(), [&](std::uint64_t first, std::size_t count) {
    hexahedra += countVtuHexahedra(file, first, count);
  });
  if (file.cellCount() > 0 && hexahedra == 0) failWithoutHexahedra(file);
  sink.begin(file.pointCount(), hexahedra);
  sendPoints(file, sink, stage);
  if (file.pointCount() < kNone) {
    sendCells<Hex>(file, sink, stage);
  } else {
    sendCells<Hex64>(file, sink, stage);
  }
  sink.end();
}

}  // namespace hexhex
