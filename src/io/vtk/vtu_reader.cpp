// The reading half of vtu.hpp: a whole file at once, or piece by piece.
#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <vector>

#include <hexhex/stream.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/checked_sink.hpp>
#include <io/core/grid_map.hpp>
#include <io/core/input_file.hpp>
#include <io/vtk/read_vtu_with.hpp>
#include <io/vtk/vtu.hpp>
#include <io/vtk/vtu_elements.hpp>
#include <io/vtk/vtu_file.hpp>
#include <io/vtk/vtu_tags.hpp>

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

void readPoints(const VtuFile& file, Array<Vec3>& points, Stage& stage) {
  points.resize(file.pointCount());
  FirstError error;
  parallelBlocks(stage, points.size(), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   error.guard(block, [&] {
                     readVtuPoints(file, begin, std::span(points).subspan(begin, end - begin));
                   });
                 });
  error.rethrow();
}

/// @param[out] numbers  if not null: which cells of the file they are
template <std::size_t corners>
void readCells(const VtuFile& file, Array<std::array<Index, corners>>& result,
               Array<std::size_t>* numbers, Stage& stage) {
  const CellKind& kind = kCellKind<corners>;
  const std::size_t cells = file.cellCount();
  std::vector<std::size_t> begins(blockCount(cells, kGrain) + 1, 0);
  parallelBlocks(stage, cells, kGrain, [&](std::size_t begin, std::size_t end, std::size_t block) {
    begins[block] = countVtuCells(file, kind, begin, end - begin);
  });
  const std::size_t count = exclusiveScan(std::span(begins));
  if (cells > 0 && count == 0) failWithoutCells(file, kind);
  result.resize(count);
  if (numbers != nullptr) numbers->resize(count);
  FirstError error;
  parallelBlocks(stage, cells, kGrain, [&](std::size_t begin, std::size_t end, std::size_t block) {
    error.guard(block, [&] {
      readVtuCells(file, begin, end - begin, result.data() + begins[block],
                   numbers != nullptr ? numbers->data() + begins[block] : nullptr);
    });
  });
  error.rethrow();
}

/// Reads points and cells of one kind, from memory or, where arrays are plain bytes, from the disk
/// straight to where they belong.
template <std::size_t corners>
class VtuMeshReader {
 public:
  VtuMeshReader(std::string_view text, const std::string& fileName, Stage& stage)
      : file_(text, fileName, stage), stage_(stage) {}
  VtuMeshReader(const InputFile& input, const std::string& fileName, Stage& stage)
      : file_(input, fileName), stage_(stage) {}

  CellMesh<corners> read(Array<std::size_t>* cellNumbers = nullptr) {
    file_.requireIndexable();
    CellMesh<corners> mesh;
    readPoints(file_, mesh.points, stage_);
    readCells(file_, mesh.cells, cellNumbers, stage_);
    return mesh;
  }
  [[nodiscard]] const VtuFile& file() const noexcept { return file_; }

 private:
  VtuFile file_;
  Stage& stage_;
};

/// Reads a hex mesh; generators, tags and regions as writeVtu() writes them.
class VtuHexReader {
 public:
  template <class Source>
  VtuHexReader(const Source& source, const std::string& fileName, Stage& stage)
      : reader_(source, fileName, stage) {}

  HexMesh read() {
    const VtuFile& file = reader_.file();
    const bool hasRegions = file.findIntegers(kVtkRegions, VtuSection::Cells, 1).has_value();
    Array<std::size_t> cellNumbers;
    HexMesh mesh = toHexMesh(reader_.read(hasRegions ? &cellNumbers : nullptr));
    if (hasRegions) mesh.regions = readVtuRegions(file, cellNumbers);
    mesh.features = {readVtuVertexTags(file), readVtuFeatures<FeatureEdge>(file, kVtkEdgeTags),
                     readVtuFeatures<FeatureQuad>(file, kVtkQuadTags)};
    readGenerators(file, mesh);
    return mesh;
  }

 private:
  static void readGenerators(const VtuFile& file, HexMesh& mesh) {
    if (!file.generatorTets() || !file.generatorCorners()) return;
    mesh.generatorTet.resize(mesh.points.size());
    mesh.generatorCorners.resize(mesh.points.size());
    file.copy(*file.generatorTets(), 0, mesh.points.size(), mesh.generatorTet.data());
    file.copy(*file.generatorCorners(), 0, mesh.points.size(), mesh.generatorCorners.data());
    const auto isSimplex = [](CornerSet corners) { return corners >= 1 && corners <= 15; };
    if (!std::all_of(mesh.generatorCorners.begin(), mesh.generatorCorners.end(), isSimplex)) {
      mesh.generatorTet.clear();  // arrays of the same names, but something else
      mesh.generatorCorners.clear();
    }
  }

  VtuMeshReader<8> reader_;
};

/// Reads the tets of a file and its map; tags and regions as writeVtuMap() writes them.
class VtuMapReader {
 public:
  template <class Source>
  VtuMapReader(const Source& source, const std::string& fileName, Stage& stage,
               std::string_view mapArray)
      : reader_(source, fileName, stage), fileName_(fileName), stage_(stage), mapArray_(mapArray) {}

  TetMap read() {
    TetGrid grid;
    grid.mesh = reader_.read(&grid.cellInFile);
    const VtuFile& file = reader_.file();
    grid.arrays = file.describeArrays();
    for (const bool ofCells : {true, false}) {
      const std::size_t components = ofCells ? kCellMapComponents : kPointMapComponents;
      const std::optional<VtuColumn> column = file.findReals(mapArray_, ofCells, components);
      if (!column) continue;
      grid.map = GridMap{ofCells, Array<double>(column->count)};
      copyAll(*column, grid.map->values);
      break;
    }
    Array<std::int32_t> regions = readVtuRegions(file, grid.cellInFile);
    TetMap map = toTetMap(std::move(grid), mapArray_, fileName_, stage_);
    map.regions.assign(regions.begin(), regions.end());
    map.features = {readVtuVertexTags(file), readVtuFeatures<FeatureEdge>(file, kVtkEdgeTags),
                    readVtuFeatures<FeatureFace>(file, kVtkTriangleTags)};
    return map;
  }

 private:
  void copyAll(const VtuColumn& column, Array<double>& values) {
    constexpr std::size_t kNumbers = std::size_t{1} << 16;
    parallelBlocks(stage_, values.size(), kNumbers,
                   [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                     reader_.file().copy(column, begin, end - begin, values.data() + begin);
                   });
  }

  VtuMeshReader<4> reader_;
  const std::string& fileName_;
  Stage& stage_;
  std::string_view mapArray_;
};

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
    cells.resize(countVtuCells(file, kCellKind<8>, first, count));
    readVtuCells(file, first, count, cells.data());
    if (!cells.empty()) sink.cells(sent, std::span<const Cell>(cells));
    sent += cells.size();
  });
}

}  // namespace

HexMesh parseVtu(std::string_view text, const std::string& fileName, Context& context) {
  return parseWith<VtuHexReader>(text, fileName, "read mesh", context);
}

HexMesh readVtu(const std::filesystem::path& file, Context& context) {
  return readVtuWith<VtuHexReader>(file, "read mesh", context);
}

TetCells parseVtuTets(std::string_view text, const std::string& fileName, Context& context) {
  return parseWith<VtuMeshReader<4>>(text, fileName, "read tets", context);
}

TetCells readVtuTets(const std::filesystem::path& file, Context& context) {
  return readVtuWith<VtuMeshReader<4>>(file, "read tets", context);
}

TetMap parseVtuMap(std::string_view text, const std::string& fileName, const ReadOptions& options,
                   Context& context) {
  return parseWith<VtuMapReader>(text, fileName, "read map", context, options.mapArray);
}

TetMap readVtuMap(const std::filesystem::path& file, const ReadOptions& options, Context& context) {
  return readVtuWith<VtuMapReader>(file, "read map", context, options.mapArray);
}

void readVtuTo(MeshSink& sink, const std::filesystem::path& path, Context& context) {
  const InputFile input(path);
  if (!input.isRegular() || !VtuFile::hasPlainAppendedData(input)) {
    return sendTo(sink, readVtu(path, context));
  }
  Stage stage(context, "read mesh");
  const VtuFile file(input, path.string());
  std::uint64_t hexahedra = 0;
  forEachPiece(stage, file.cellCount(), [&](std::uint64_t first, std::size_t count) {
    hexahedra += countVtuCells(file, kCellKind<8>, first, count);
  });
  if (file.cellCount() > 0 && hexahedra == 0) failWithoutCells(file, kCellKind<8>);
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
