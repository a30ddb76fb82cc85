// Reads and writes files of any format, after a look at whether the format can do what is wanted.
#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <variant>

#include <hexhex/error.hpp>
#include <hexhex/io.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/checked_sink.hpp>
#include <io/core/hdf5_library.hpp>
#include <io/core/registry.hpp>
#include <io/core/zlib_blocks.hpp>

namespace hexhex {
namespace {

constexpr std::array<WorkStep, 1> kReadMap = {{{"read map", 1}}};
constexpr std::array<WorkStep, 1> kReadTets = {{{"read tets", 1}}};
constexpr std::array<WorkStep, 1> kReadMesh = {{{"read mesh", 1}}};
constexpr std::array<WorkStep, 2> kReadAny = {{{"read mesh", 1}, {"read map", 1}}};
constexpr std::array<WorkStep, 1> kWriteMap = {{{"write map", 1}}};
/// Its indices are looked at first.
constexpr std::array<WorkStep, 2> kWriteMesh = {{{"write mesh", 0.02}, {"write mesh", 1}}};

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& sentence) {
  throw Error(ErrorCode::FileUnsupported, file.string() + ": " + sentence);
}

[[noreturn]] void failToRead(const std::filesystem::path& file, const Format& format) {
  refuse(file, "files of the format \"" + std::string(format.label.name) +
                   "\" are written, but not read.");
}

/// The format of a hex mesh that is to be read.
const Format& readableFormat(const std::filesystem::path& file, std::string_view name) {
  const Format& format = findFormat(file, name, FileContent::HexMesh);
  if (format.meshes.read == nullptr) failToRead(file, format);
  return format;
}

/// The format of a file that is to be written with these options.
const Format& writableFormat(const std::filesystem::path& file, const WriteOptions& options,
                             FileContent content) {
  const Format& format = findFormat(file, options.format, content);
  if (content == FileContent::HexMesh && format.meshes.write == nullptr && !format.overHdf5) {
    refuse(file, "files of the format \"" + std::string(format.label.name) +
                     "\" are read; they are written by `hexhex extract --parts` alone.");
  }
  if (options.compress && !format.compresses) {
    refuse(file, "the format \"" + std::string(format.label.name) +
                     "\" knows no compression; only .vtu does.");
  }
  if (options.compress && !hasZlib()) {
    refuse(file,
           "this program was built without zlib and cannot compress files. Write the file without "
           "compression.");
  }
  if (format.overHdf5) requireHdf5(file);
  return format;
}

}  // namespace

TetMap readMap(const std::filesystem::path& file, const ReadOptions& options, Context& context) {
  const Format& format = findFormat(file, options.format, FileContent::Map);
  if (format.maps.read == nullptr) failToRead(file, format);
  return inSteps(context, "readMap", kReadMap,
                 [&] { return format.maps.read(file, options, context); });
}

TetMap readMap(const std::filesystem::path& file, Context& context) {
  return readMap(file, {}, context);
}

TetMap readMap(const std::filesystem::path& file) {
  Context context;
  return readMap(file, context);
}

TetMesh readTetMesh(const std::filesystem::path& file, const ReadOptions& options,
                    Context& context) {
  const Format& format = findFormat(file, options.format, FileContent::Tets);
  return inSteps(context, "readTetMesh", kReadTets, [&] {
    const TetCells tets = format.readTets(file, context);
    TetMesh mesh;
    mesh.points.assign(tets.points.begin(), tets.points.end());
    mesh.tets.assign(tets.cells.begin(), tets.cells.end());
    return mesh;
  });
}

HexMesh readHexMesh(const std::filesystem::path& file, const ReadOptions& options,
                    Context& context) {
  const Format& format = readableFormat(file, options.format);
  return inSteps(context, "readHexMesh", kReadMesh,
                 [&] { return format.meshes.read(file, context); });
}

HexMesh readHexMesh(const std::filesystem::path& file, Context& context) {
  return readHexMesh(file, {}, context);
}

HexMesh readHexMesh(const std::filesystem::path& file) {
  Context context;
  return readHexMesh(file, context);
}

std::variant<TetMap, HexMesh> readMapOrHexMesh(const std::filesystem::path& file,
                                               const ReadOptions& options, Context& context) {
  const Format& format = findFormat(file, options.format, FileContent::MapOrHexMesh);
  if (format.meshes.read == nullptr && format.maps.read == nullptr) failToRead(file, format);
  using Content = std::variant<TetMap, HexMesh>;
  return inSteps(context, "readMapOrHexMesh", kReadAny, [&]() -> Content {
    if (format.meshes.read == nullptr) return format.maps.read(file, options, context);
    if (format.maps.read == nullptr) return format.meshes.read(file, context);
    try {
      return format.meshes.read(file, context);
    } catch (const Error& error) {
      // That there are no hexahedra; what else is wrong, the other reader will find, too.
      if (error.code() != ErrorCode::FileUnsupported) throw;
      return format.maps.read(file, options, context);
    }
  });
}

void readHexMeshTo(MeshSink& sink, const std::filesystem::path& file, const ReadOptions& options,
                   Context& context) {
  const Format& format = readableFormat(file, options.format);
  inSteps(context, "readHexMeshTo", kReadMesh, [&] {
    withThreads(context.threads(), [&] {
      if (format.pieces.read != nullptr) return format.pieces.read(sink, file, context);
      sendTo(sink, format.meshes.read(file, context));
    });
  });
}

void readHexMeshTo(MeshSink& sink, const std::filesystem::path& file, Context& context) {
  readHexMeshTo(sink, file, {}, context);
}

void writeMap(const TetMap& map, const std::filesystem::path& file, const WriteOptions& options,
              Context& context) {
  const Format& format = writableFormat(file, options, FileContent::Map);
  inSteps(context, "writeMap", kWriteMap, [&] { format.maps.write(map, file, options, context); });
}

void writeMap(const TetMap& map, const std::filesystem::path& file, Context& context) {
  writeMap(map, file, {}, context);
}

void writeMap(const TetMap& map, const std::filesystem::path& file) {
  Context context;
  writeMap(map, file, context);
}

void writeHexMesh(const HexMesh& mesh, const std::filesystem::path& file,
                  const WriteOptions& options, Context& context) {
  const Format& format = writableFormat(file, options, FileContent::HexMesh);
  inSteps(context, "writeHexMesh", kWriteMesh, [&] {
    {
      Stage stage(context, "write mesh");
      withThreads(context.threads(), [&] { requireWritable(mesh, options, stage); });
    }
    format.meshes.write(mesh, file, options, context);
  });
}

void writeHexMesh(const HexMesh& mesh, const std::filesystem::path& file, Context& context) {
  writeHexMesh(mesh, file, {}, context);
}

void writeHexMesh(const HexMesh& mesh, const std::filesystem::path& file) {
  Context context;
  writeHexMesh(mesh, file, context);
}

std::unique_ptr<MeshSink> openMeshSink(const std::filesystem::path& file,
                                       const WriteOptions& options, Context& context) {
  const Format& format = findFormat(file, options.format, FileContent::HexMesh);
  if (options.compress) refuse(file, "a mesh in pieces cannot be written with compression.");
  if (format.pieces.openSink == nullptr) {
    refuse(file, "a mesh in pieces cannot be written in this format. Formats that can: " +
                     streamingFormats() + ".");
  }
  return format.pieces.openSink(file, context);
}

std::unique_ptr<MeshSink> openMeshSink(const std::filesystem::path& file, Context& context) {
  return openMeshSink(file, {}, context);
}

void requireHexMeshFormat(const std::filesystem::path& file, const WriteOptions& options) {
  static_cast<void>(writableFormat(file, options, FileContent::HexMesh));
}

void requireHexMeshFormat(const std::filesystem::path& file, std::string_view format) {
  requireHexMeshFormat(file, WriteOptions{.format = format});
}

void requireMapFormat(const std::filesystem::path& file, const WriteOptions& options) {
  static_cast<void>(writableFormat(file, options, FileContent::Map));
}

}  // namespace hexhex
