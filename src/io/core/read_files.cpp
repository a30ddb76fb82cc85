// Reads files of any format.
#include <string>
#include <string_view>
#include <variant>

#include <hexhex/error.hpp>
#include <hexhex/io.hpp>

#include <base/parallel.hpp>
#include <io/core/checked_sink.hpp>
#include <io/core/registry.hpp>

namespace hexhex {
namespace {

[[noreturn]] void failToRead(const std::filesystem::path& file, const Format& format) {
  throw Error(ErrorCode::FileUnsupported, file.string() + ": files of the format \"" +
                                              std::string(format.name) +
                                              "\" are written, but not read.");
}

/// The format of a file that is to be read.
const Format& readableFormat(const std::filesystem::path& file, std::string_view name) {
  const Format& format = hexMeshFormat(file, name);
  if (format.readMesh == nullptr) failToRead(file, format);
  return format;
}

}  // namespace

TetMap readMap(const std::filesystem::path& file, const ReadOptions& options, Context& context) {
  const Format& format = mapFormat(file, options.format);
  if (format.readMap == nullptr) failToRead(file, format);
  return format.readMap(file, options, context);
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
  TetCells tets = tetFormat(file, options.format).readTets(file, context);
  TetMesh mesh;
  mesh.points.assign(tets.points.begin(), tets.points.end());
  mesh.tets.assign(tets.cells.begin(), tets.cells.end());
  return mesh;
}

HexMesh readHexMesh(const std::filesystem::path& file, const ReadOptions& options,
                    Context& context) {
  return readableFormat(file, options.format).readMesh(file, context);
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
  const Format& format = mapOrHexMeshFormat(file, options.format);
  if (format.readMesh == nullptr && format.readMap == nullptr) failToRead(file, format);
  if (format.readMesh == nullptr) return format.readMap(file, options, context);
  if (format.readMap == nullptr) return format.readMesh(file, context);
  try {
    return format.readMesh(file, context);
  } catch (const Error& error) {
    // That there are no hexahedra; what else is wrong, the other reader will find, too.
    if (error.code() != ErrorCode::FileUnsupported) throw;
    return format.readMap(file, options, context);
  }
}

void readHexMeshTo(MeshSink& sink, const std::filesystem::path& file, const ReadOptions& options,
                   Context& context) {
  const Format& format = readableFormat(file, options.format);
  withThreads(context.threads(), [&] {
    if (format.readMeshTo != nullptr) return format.readMeshTo(sink, file, context);
    sendTo(sink, format.readMesh(file, context));
  });
}

void readHexMeshTo(MeshSink& sink, const std::filesystem::path& file, Context& context) {
  readHexMeshTo(sink, file, {}, context);
}

}  // namespace hexhex
