// Entry points that read and write files of any format: checks that the format supports the
// request, then dispatches. Implements <hexhex/io.hpp> and the file functions of other headers.
#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <variant>

#include <hexhex/curved.hpp>
#include <hexhex/error.hpp>
#include <hexhex/fill.hpp>
#include <hexhex/io.hpp>
#include <hexhex/parts.hpp>
#include <hexhex/quality.hpp>
#include <hexhex/team.hpp>

#include <base/concat.hpp>
#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/checked_sink.hpp>
#include <io/core/compressed_blocks.hpp>
#include <io/core/hdf_reader.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/core/output_folder.hpp>
#include <io/core/registry.hpp>
#include <mesh/lagrange_check.hpp>

namespace hexhex::io {
namespace {

constexpr std::array<WorkStep, 1> kReadMap = {{{"read map", 1}}};
constexpr std::array<WorkStep, 1> kReadTets = {{{"read tets", 1}}};
constexpr std::array<WorkStep, 1> kReadTriangles = {{{"read triangles", 1}}};
constexpr std::array<WorkStep, 1> kReadMesh = {{{"read mesh", 1}}};
constexpr std::array<WorkStep, 2> kReadAny = {{{"read mesh", 1}, {"read map", 1}}};
constexpr std::array<WorkStep, 1> kWriteMap = {{{"write map", 1}}};
/// The first step checks the indices.
constexpr std::array<WorkStep, 2> kWriteMesh = {{{"write mesh", 0.02}, {"write mesh", 1}}};
constexpr std::array<WorkStep, 1> kWriteCurved = {{{"write mesh", 1}}};
constexpr std::array<WorkStep, 1> kWriteArcs = {{{"write arcs", 1}}};
constexpr std::array<WorkStep, 1> kWritePatches = {{{"write patches", 1}}};

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& sentence) {
  throw Error(ErrorCode::FileUnsupported, file.string() + ": " + sentence);
}

[[noreturn]] void failToRead(const std::filesystem::path& file, const Format& format) {
  if (format.overHdf5) requireHdf5(file);
  refuse(file,
         concat("files of the format \"", format.label.name, "\" are written, but not read."));
}

/// The format of a hex mesh to read.
const Format& readableFormat(const std::filesystem::path& file, std::string_view name) {
  const Format& format = findFormat(file, name, FileContent::HexMesh);
  if (format.meshes.read == nullptr) failToRead(file, format);
  return format;
}

void refuseGzip(const std::filesystem::path& file) {
  if (!isGzip(file)) return;
  refuse(file,
         "files compressed with gzip are read, but not written. Write the file without "
         "\".gz\", and compress it then.");
}

constexpr std::array<std::string_view, 3> kElementTypes = {"C3D8", "C3D8R", "C3D8I"};

void requireElementType(const std::filesystem::path& file, const Format& format,
                        const WriteOptions& options) {
  const std::string_view type = options.elementType;
  if (type.empty()) return;
  if (format.label.name == "inp" &&
      std::find(kElementTypes.begin(), kElementTypes.end(), type) != kElementTypes.end()) {
    return;
  }
  refuse(file, concat("elements of the type \"", type, "\" cannot be written: straight cells ",
                      "in .inp files are of the type C3D8, C3D8R or C3D8I, others have none."));
}

/// Refuses cells that are no hexahedra if the format is not written with them.
void requireOthers(const std::filesystem::path& file, const Format& format,
                   const OtherCells& others) {
  if (others.count() == 0 || format.others) return;
  CellCounts counts;
  for (const OtherCellList& kind : others.kinds) counts.add(typeWith(kind.corners), kind.count());
  refuse(file, concat("the format \"", format.label.name, "\" is written with hexahedra only, but ",
                      "the mesh has others, too: ", counts.text(), ". Formats that hold them: ",
                      formatsOfOthers(), ". --hexes-only leaves them out."));
}

/// The format of a file to write with these options.
const Format& writableFormat(const std::filesystem::path& file, const WriteOptions& options,
                             FileContent content) {
  refuseGzip(file);
  const Format& format = findFormat(file, options.format, content);
  const bool writes = format.meshes.write != nullptr || format.meshes.writeFolder != nullptr;
  if (content == FileContent::HexMesh && !writes && !format.overHdf5) {
    refuse(file,
           concat("files of the format \"", format.label.name,
                  (format.parts.open == nullptr
                       ? "\" are read, but not written."
                       : "\" are read; they are written by `hexhex extract --parts` alone.")));
  }
  if (content == FileContent::HexMesh) requireOthers(file, format, othersOf(options));
  if (options.compress != Compression::None && !format.compresses) {
    refuse(file,
           concat("the format \"", format.label.name, "\" knows no compression; only .vtu does."));
  }
  if (options.compress == Compression::Zlib) {
    requireZlib(file, "compress files by zlib", "write the file without compression");
  }
  if (options.compress == Compression::Lz4) requireLz4(file);
  requireElementType(file, format, options);
  if (format.overHdf5) requireHdf5(file);
  return format;
}

constexpr const char* kCarried =
    " Others are carried if they are tetrahedra, pyramids and prisms with straight edges, from all "
    "formats but .pvtu, .foam, .ovm and .ovmb.";

/// Reports the volume cells that a reader counted, and refuses files with cells it skipped.
/// @param allowed  whether cells of other kinds may be skipped
void settleCells(const Input& input, const CellKind& wanted, const ReadOptions& options,
                 bool allowed) {
  if (options.cellCounts != nullptr) *options.cellCounts = input.counts()->list();
  if (allowed) return;
  input.counts()->requireOnly(
      wanted, input.name(),
      wanted.corners == 8
          ? concat("Hexahedra alone would have holes; to read them all the same, add --hexes-only ",
                   "(ReadOptions::hexesOnly).", (input.others() == nullptr ? "" : kCarried))
          : "Tetrahedra alone would have holes; split the others into tetrahedra.",
      input.others() == nullptr ? noOthers() : *input.others());
}

TetMap readMapOf(const Input& input, const Format& format, const ReadOptions& options,
                 Context& context) {
  TetMap map = inStage(context, "read map",
                       [&](Stage& stage) { return format.maps.read(input, options, stage); });
  settleCells(input, kCellKind<4>, options, false);
  return map;
}

HexMesh readMeshOf(Input input, const Format& format, const ReadOptions& options,
                   Context& context) {
  input.setOthers(options.hexesOnly ? nullptr : options.others);
  HexMesh mesh =
      inStage(context, "read mesh", [&](Stage& stage) { return format.meshes.read(input, stage); });
  settleCells(input, kCellKind<8>, options, options.hexesOnly);
  return mesh;
}

/// Passes a mesh on; begin() first checks the cells that the reader has counted by then.
class SettledSink final : public MeshSink {
 public:
  SettledSink(MeshSink& sink, const Input& input, const ReadOptions& options)
      : sink_(sink), input_(input), options_(options) {}
  void begin(std::uint64_t pointCount, std::uint64_t cellCount) override {
    settleCells(input_, kCellKind<8>, options_, options_.hexesOnly);
    sink_.begin(pointCount, cellCount);
  }
  void points(const PointPiece& piece) override { sink_.points(piece); }
  void cells(std::uint64_t first, std::span<const Hex> cells) override {
    sink_.cells(first, cells);
  }
  void cells(std::uint64_t first, std::span<const Hex64> cells) override {
    sink_.cells(first, cells);
  }
  void end() override { sink_.end(); }

 private:
  MeshSink& sink_;
  const Input& input_;
  const ReadOptions& options_;
};

/// The format of a file that may hold cells of higher order; null if it cannot.
const Format* curvedFormat(const std::filesystem::path& file) {
  try {
    const Format& format = findFormat(file, {}, FileContent::HexMesh);
    return format.curved.read == nullptr ? nullptr : &format;
  } catch (const Error&) {  // not a mesh format
    return nullptr;
  }
}

/// The format in which to write cells of higher order.
/// @param order  0: not known yet
const Format& curvedFormatToWrite(const std::filesystem::path& file, std::string_view name,
                                  int order) {
  const Format& format = findFormat(file, name, FileContent::CurvedCells);
  const int only = format.curved.onlyOrder;
  if (order != 0 && only != 0 && order != only) {
    refuse(file, concat("the format \"", format.label.name, "\" holds cells of order ", only,
                        " and straight ones, but these are of order ", order, "."));
  }
  return format;
}

/// The kind of target that a format can write to.
OutputFile::Target targetOf(const Format& format) {
  return format.overHdf5 ? OutputFile::Target::Regular : OutputFile::Target::Any;
}

/// Writes a file within a stage and commits it. Opens the file first, so that an unwritable folder
/// is reported at once.
template <class Write>
void writeFile(const std::filesystem::path& file, const Format& format, std::string_view stageName,
               Context& context, const Write& write) {
  OutputFile output(file, targetOf(format));
  Stage stage(context, stageName);
  write(output, stage);
  output.commit();
}

/// The same for cells, with their scaled Jacobians if the format stores them.
/// @param write  WriteMesh or WriteCurved
template <class Mesh, class Write>
void writeMeasured(const Mesh& mesh, const std::filesystem::path& file, const Format& format,
                   WriteOptions options, Context& context, Write* write) {
  OutputFile output(file, targetOf(format));
  Array<double> measures;
  if (format.measures && options.scaledJacobians.empty()) {
    measures = scaledJacobians(mesh, context);
    options.scaledJacobians = measures;
  }
  Stage stage(context, "write mesh");
  write(mesh, output, options, stage);
  output.commit();
}

/// @param map      null: not available
/// @param content  Arcs or Patches
void writePiecewise(const PiecewiseLinearMesh& mesh, const TetMapView* map,
                    const std::filesystem::path& file, FileContent content, Context& context) {
  const Format& format = findFormat(file, {}, content);
  const bool arcs = content == FileContent::Arcs;
  inSteps(context, arcs ? "writeArcs" : "writePatches", arcs ? kWriteArcs : kWritePatches, [&] {
    writeFile(file, format, arcs ? "write arcs" : "write patches", context,
              [&](OutputFile& output, Stage& stage) {
                (arcs ? format.writeArcs : format.writePatches)(mesh, map, output, stage);
              });
  });
}

void requireForTeams(const std::filesystem::path& file, const Format& format) {
  if (format.parts.byTeams) return;
  refuse(file, concat("several processes cannot write \"", format.label.name,
                      "\" together. They can write: ", teamFormats(), '.'));
}

/// Processes that disagree on names or formats would write an unreadable set of files.
void requireSameOutput(ProcessTeam& team, const std::filesystem::path& file,
                       const WriteOptions& options) {
  team.requireSame(file.string(), "name of the file to write");
  team.requireSame(std::string(options.format), "format to write");
  team.requireSame(std::to_string(options.patchAngle), "patch angle");
}

}  // namespace

}  // namespace hexhex::io

namespace hexhex {

TetMap readMap(const std::filesystem::path& file, const ReadOptions& options, Context& context) {
  const io::Format& format = io::findFormat(file, options.format, io::FileContent::Map);
  if (format.maps.read == nullptr) io::failToRead(file, format);
  return inSteps(context, "readMap", io::kReadMap, [&] {
    return io::readMapOf(io::openInput(file, context), format, options, context);
  });
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
  const io::Format& format = io::findFormat(file, options.format, io::FileContent::Tets);
  return inSteps(context, "readTetMesh", io::kReadTets, [&] {
    const io::Input input = io::openInput(file, context);
    io::TetCells tets = io::inStage(context, "read tets",
                                    [&](Stage& stage) { return format.readTets(input, stage); });
    io::settleCells(input, io::kCellKind<4>, options, false);
    TetMesh mesh;
    mesh.points.assign(tets.points.begin(), tets.points.end());
    mesh.tets.assign(tets.cells.begin(), tets.cells.end());
    mesh.regions.assign(tets.regions.begin(), tets.regions.end());
    mesh.features = std::move(tets.features);
    io::removeRepeated(mesh.features.vertices);
    io::removeRepeated(mesh.features.edges);
    io::removeRepeated(mesh.features.faces);
    return mesh;
  });
}

TriangleMesh readTriangleMesh(const std::filesystem::path& file, Context& context) {
  const io::Format& format = io::findFormat(file, {}, io::FileContent::Triangles);
  return inSteps(context, "readTriangleMesh", io::kReadTriangles, [&] {
    const io::Input input = io::openInput(file, context);
    return io::inStage(context, "read triangles", [&](Stage& stage) {
      return io::welded(format.triangles.read(input, stage));
    });
  });
}

HexMesh readHexMesh(const std::filesystem::path& file, const ReadOptions& options,
                    Context& context) {
  const io::Format& format = io::readableFormat(file, options.format);
  return inSteps(context, "readHexMesh", io::kReadMesh, [&] {
    return io::readMeshOf(io::openInput(file, context), format, options, context);
  });
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
  const io::Format& format = io::findFormat(file, options.format, io::FileContent::MapOrHexMesh);
  if (format.meshes.read == nullptr && format.maps.read == nullptr) io::failToRead(file, format);
  using Content = std::variant<TetMap, HexMesh>;
  return inSteps(context, "readMapOrHexMesh", io::kReadAny, [&]() -> Content {
    const io::Input input = io::openInput(file, context);
    if (format.meshes.read == nullptr) return io::readMapOf(input, format, options, context);
    if (format.maps.read == nullptr) return io::readMeshOf(input, format, options, context);
    try {
      return io::readMeshOf(input, format, options, context);
    } catch (const Error& error) {
      // Only a file without hexahedra is tried as a map; the map reader reports any other error
      // itself.
      const io::CellCounts& counts = *input.counts();
      const bool hasOthers = !counts.list().empty();
      if (error.code() != ErrorCode::FileUnsupported || counts.of(io::kCellKind<8>) > 0 ||
          (hasOthers && counts.of(io::kCellKind<4>) == 0)) {
        throw;
      }
      return io::readMapOf(input, format, options, context);
    }
  });
}

void readHexMeshTo(MeshSink& sink, const std::filesystem::path& file, const ReadOptions& options,
                   Context& context) {
  const io::Format& format = io::readableFormat(file, options.format);
  inSteps(context, "readHexMeshTo", io::kReadMesh, [&] {
    withThreads(context.threads(), [&] {
      const io::Input input = io::openInput(file, context);
      io::SettledSink settled(sink, input, options);
      if (format.pieces.read != nullptr) return format.pieces.read(settled, input, context);
      io::sendTo(settled, io::inStage(context, "read mesh", [&](Stage& stage) {
                   return format.meshes.read(input, stage);
                 }));
    });
  });
}

void readHexMeshTo(MeshSink& sink, const std::filesystem::path& file, Context& context) {
  readHexMeshTo(sink, file, {}, context);
}

void writeMap(const TetMap& map, const std::filesystem::path& file, const WriteOptions& options,
              Context& context) {
  const io::Format& format = io::writableFormat(file, options, io::FileContent::Map);
  inSteps(context, "writeMap", io::kWriteMap, [&] {
    io::writeFile(file, format, "write map", context, [&](io::OutputFile& output, Stage& stage) {
      format.maps.write(map, output, options, stage);
    });
  });
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
  const io::Format& format = io::writableFormat(file, options, io::FileContent::HexMesh);
  inSteps(context, "writeHexMesh", io::kWriteMesh, [&] {
    {
      Stage stage(context, "write mesh");
      withThreads(context.threads(), [&] { io::requireWritable(mesh, options, stage); });
    }
    if (format.meshes.writeFolder != nullptr) {
      return format.meshes.writeFolder(mesh, file, options, context);
    }
    io::writeMeasured(mesh, file, format, options, context, format.meshes.write);
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
  io::refuseGzip(file);
  const io::Format& format = io::findFormat(file, options.format, io::FileContent::HexMesh);
  if (options.compress != Compression::None)
    io::refuse(file, "a mesh in pieces cannot be written with compression.");
  io::requireElementType(file, format, options);
  if (format.pieces.openSink == nullptr) {
    io::refuse(file, "a mesh in pieces cannot be written in this format. Formats that can: " +
                         io::streamingFormats() + ".");
  }
  return format.pieces.openSink(file, context);
}

std::unique_ptr<MeshSink> openMeshSink(const std::filesystem::path& file, Context& context) {
  return openMeshSink(file, {}, context);
}

void requireHexMeshFormat(const std::filesystem::path& file, const WriteOptions& options) {
  static_cast<void>(io::writableFormat(file, options, io::FileContent::HexMesh));
}

void requireHexMeshFormat(const std::filesystem::path& file, std::string_view format) {
  requireHexMeshFormat(file, WriteOptions{.format = format});
}

bool writesPatches(const std::filesystem::path& file, const WriteOptions& options) {
  return io::writableFormat(file, options, io::FileContent::HexMesh).groups;
}

void requireMapFormat(const std::filesystem::path& file, const WriteOptions& options) {
  static_cast<void>(io::writableFormat(file, options, io::FileContent::Map));
}

void writeArcs(const PiecewiseLinearMesh& mesh, const std::filesystem::path& file,
               Context& context) {
  io::writePiecewise(mesh, nullptr, file, io::FileContent::Arcs, context);
}

void writeArcs(const PiecewiseLinearMesh& mesh, const TetMapView& map,
               const std::filesystem::path& file, Context& context) {
  io::writePiecewise(mesh, &map, file, io::FileContent::Arcs, context);
}

void writePatches(const PiecewiseLinearMesh& mesh, const std::filesystem::path& file,
                  Context& context) {
  io::writePiecewise(mesh, nullptr, file, io::FileContent::Patches, context);
}

void writePatches(const PiecewiseLinearMesh& mesh, const TetMapView& map,
                  const std::filesystem::path& file, Context& context) {
  io::writePiecewise(mesh, &map, file, io::FileContent::Patches, context);
}

void writeLagrangeMesh(const LagrangeMesh& mesh, const std::filesystem::path& file,
                       const WriteOptions& options, Context& context) {
  const io::Format& format = io::curvedFormatToWrite(file, options.format, mesh.order);
  if (!options.elementType.empty() || io::othersOf(options).count() > 0) {
    io::refuse(file,
               "only straight cells can be given a type of elements, or have others beside them.");
  }
  mesh::requireConsistent(mesh);
  if (!options.scaledJacobians.empty() && options.scaledJacobians.size() != mesh.cellCount()) {
    throw Error(ErrorCode::InvalidArgument,
                concat("There are ", options.scaledJacobians.size(), " scaled Jacobians of ",
                       mesh.cellCount(), " cells. Give one for each, or none."));
  }
  inSteps(context, "writeLagrangeMesh", io::kWriteCurved,
          [&] { io::writeMeasured(mesh, file, format, options, context, format.curved.write); });
}

bool holdsLagrangeCells(const std::filesystem::path& file, Context& context) {
  const io::Format* const format = io::curvedFormat(file);
  if (format == nullptr) return false;
  const io::Input input = io::openInput(file, context);
  return io::inStage(context, "read mesh",
                     [&](Stage& stage) { return format->curved.isIn(input, stage); });
}

LagrangeMesh readLagrangeMesh(const std::filesystem::path& file, Context& context) {
  const io::Format* const format = io::curvedFormat(file);
  if (format == nullptr) {
    io::refuse(file,
               "cells of higher order are read from .vtu, .vtk, .msh, .mesh, .meshb, .inp, .unv, "
               ".cgns, .vtkhdf, .exo and .e files only.");
  }
  return inSteps(context, "readLagrangeMesh", io::kReadMesh, [&] {
    const io::Input input = io::openInput(file, context);
    return io::inStage(context, "read mesh",
                       [&](Stage& stage) { return format->curved.read(input, stage); });
  });
}

void requireArcFormat(const std::filesystem::path& file) {
  static_cast<void>(io::findFormat(file, {}, io::FileContent::Arcs));
}

void requirePatchFormat(const std::filesystem::path& file) {
  static_cast<void>(io::findFormat(file, {}, io::FileContent::Patches));
}

void requireLagrangeFormat(const std::filesystem::path& file, std::string_view format, int order) {
  static_cast<void>(io::curvedFormatToWrite(file, format, order));
}

std::unique_ptr<PartSink> openPartSink(const std::filesystem::path& file,
                                       const WriteOptions& options, Context& context,
                                       ProcessTeam* team) {
  const io::Format& format = io::findFormat(file, options.format, io::FileContent::Parts);
  if (team != nullptr) {
    io::requireForTeams(file, format);
    io::requireSameOutput(*team, file, options);
  }
  if (format.overHdf5 && io::isFirst(team)) io::requireHdf5(file);
  return format.parts.open(file, context, team);
}

void requirePartFormat(const std::filesystem::path& file, const WriteOptions& options,
                       bool byTeam) {
  const io::Format& format = io::findFormat(file, options.format, io::FileContent::Parts);
  io::requireElementType(file, format, options);
  if (byTeam) io::requireForTeams(file, format);
}

}  // namespace hexhex
