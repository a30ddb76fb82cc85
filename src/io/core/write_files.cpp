// Writes files of any format, after a look at whether they can be written as they are wanted.
#include <memory>
#include <string>
#include <string_view>

#include <adjacency/hex_topology.hpp>

#include <hexhex/error.hpp>
#include <hexhex/io.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/registry.hpp>
#include <io/core/writable.hpp>
#include <io/core/zlib_blocks.hpp>
#include <mesh/smooth_patches.hpp>

namespace hexhex {
namespace {

/// Refuses an optional array that is there but has another size than what it describes.
void requireSize(std::size_t size, std::size_t expected, const char* elements, const char* values) {
  if (size == 0 || size == expected) return;
  throw Error(ErrorCode::InvalidArgument, "The mesh has " + std::to_string(expected) + " " +
                                              elements + " but " + std::to_string(size) + " " +
                                              values + ".");
}

/// Refuses meshes that would crash a writer or could not be read back.
void requireWritable(const HexMesh& mesh, const WriteOptions& options, Stage& stage) {
  requireCornersInRange(mesh, stage);
  requireSize(mesh.generatorCorners.size(), mesh.points.size(), "vertices", "generators");
  requireSize(mesh.generatorTet.size(), mesh.points.size(), "vertices", "generators");
  requireSize(mesh.regions.size(), mesh.cells.size(), "cells", "regions");
  requirePatchAngle(options.patchAngle);
  requireSize(options.scaledJacobians.size(), mesh.cells.size(), "cells", "scaled Jacobians");
  const std::size_t vertex = firstNotFinite(mesh.points, stage);
  if (vertex == mesh.points.size()) return;
  throw Error(ErrorCode::NotFinite,
              "A coordinate of vertex " + std::to_string(vertex) + " is not finite.",
              Place{PlaceKind::Vertex, vertex});
}

void requireOptions(const Format& format, const std::filesystem::path& file,
                    const WriteOptions& options) {
  if (!options.compress) return;
  if (!format.compresses) {
    throw Error(ErrorCode::FileUnsupported, file.string() + ": the format \"" +
                                                std::string(format.name) +
                                                "\" knows no compression; only .vtu does.");
  }
  if (hasZlib()) return;
  throw Error(ErrorCode::FileUnsupported,
              file.string() +
                  ": this program was built without zlib and cannot compress files. Write the file "
                  "without compression.");
}

}  // namespace

void writeMap(const TetMap& map, const std::filesystem::path& file, const WriteOptions& options,
              Context& context) {
  const Format& format = mapFormat(file, options.format);
  requireOptions(format, file, options);
  format.writeMap(map, file, options, context);
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
  const Format& format = hexMeshFormat(file, options.format);
  requireOptions(format, file, options);
  {
    Stage stage(context, "write mesh");
    withThreads(context.threads(), [&] { requireWritable(mesh, options, stage); });
  }
  format.writeMesh(mesh, file, options, context);
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
  const Format& format = hexMeshFormat(file, options.format);
  if (options.compress) {
    throw Error(ErrorCode::FileUnsupported,
                file.string() + ": a mesh in pieces cannot be written with compression.");
  }
  if (format.openSink != nullptr) return format.openSink(file, context);
  const auto able = [](const Format& each) { return each.openSink != nullptr; };
  throw Error(ErrorCode::FileUnsupported,
              file.string() +
                  ": a mesh in pieces cannot be written in this format. Formats that can: " +
                  listFormatNames(able) + ".");
}

std::unique_ptr<MeshSink> openMeshSink(const std::filesystem::path& file, Context& context) {
  return openMeshSink(file, {}, context);
}

void requireHexMeshFormat(const std::filesystem::path& file, const WriteOptions& options) {
  const Format& format = hexMeshFormat(file, options.format);
  requireOptions(format, file, options);
}

void requireHexMeshFormat(const std::filesystem::path& file, std::string_view format) {
  WriteOptions options;
  options.format = format;
  requireHexMeshFormat(file, options);
}

void requireMapFormat(const std::filesystem::path& file, const WriteOptions& options) {
  const Format& format = mapFormat(file, options.format);
  requireOptions(format, file, options);
}

}  // namespace hexhex
