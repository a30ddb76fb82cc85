#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <hexhex/error.hpp>
#include <hexhex/io.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/abaqus.hpp>
#include <io/cgns.hpp>
#include <io/exodus.hpp>
#include <io/finite_points.hpp>
#include <io/gmsh.hpp>
#include <io/hexex.hpp>
#include <io/medit.hpp>
#include <io/mesh_pieces.hpp>
#include <io/mesh_sink.hpp>
#include <io/meshb.hpp>
#include <io/mfem.hpp>
#include <io/openfoam.hpp>
#include <io/ovm.hpp>
#include <io/registry.hpp>
#include <io/vtk_legacy.hpp>
#include <io/vtkhdf.hpp>
#include <io/vtu.hpp>
#include <io/zlib_blocks.hpp>
#include <mesh/smooth_patches.hpp>
#include <mesh/vertex_cells.hpp>

namespace hexhex {
namespace {

// Of formats whose maps need no options.
template <auto read>
TetMap readPlain(const std::filesystem::path& file, const ReadOptions& /*options*/,
                 Context& context) {
  return read(file, context);
}
template <auto write>
void writePlain(const TetMap& map, const std::filesystem::path& file,
                const WriteOptions& /*options*/, Context& context) {
  write(map, file, context);
}

// Overloads of writers with a map have to be told apart.
constexpr auto kWriteOvm = static_cast<void (*)(const HexMesh&, const std::filesystem::path&,
                                                const WriteOptions&, Context&)>(writeOvmHexMesh);
constexpr auto kWriteOvmb = static_cast<void (*)(const HexMesh&, const std::filesystem::path&,
                                                 const WriteOptions&, Context&)>(writeOvmbHexMesh);

TetCells readHexexTets(const std::filesystem::path& file, Context& context) {
  const TetMap map = readHexex(file, context);
  TetCells tets;
  tets.points.assign(map.points.begin(), map.points.end());
  tets.cells.assign(map.tets.begin(), map.tets.end());
  return tets;
}

/// Formats over libraries that not every build has.
using WriteMesh = void (*)(const HexMesh& mesh, const std::filesystem::path& file,
                           const WriteOptions& options, Context& context);
#if defined(HEXHEX_HAS_HDF5)
constexpr WriteMesh kWriteVtkHdf = writeVtkHdf;
constexpr bool kHasHdf5 = true;
#else
constexpr WriteMesh kWriteVtkHdf = nullptr;
constexpr bool kHasHdf5 = false;
#endif
#if defined(HEXHEX_HAS_CGNS)
constexpr WriteMesh kWriteCgns = writeCgns;
constexpr bool kHasCgns = true;
#else
constexpr WriteMesh kWriteCgns = nullptr;
constexpr bool kHasCgns = false;
#endif
#if defined(HEXHEX_HAS_EXODUS)
constexpr WriteMesh kWriteExodus = writeExodus;
constexpr bool kHasExodus = true;
#else
constexpr WriteMesh kWriteExodus = nullptr;
constexpr bool kHasExodus = false;
#endif

/// A writer that may be missing. (That a function is not null is no constant expression to GCC's
/// sanitizers.)
struct OptionalWriter {
  WriteMesh write;
  bool isThere;
};

/// @param library  what has to be installed if there is no writer
constexpr Format optionalFormat(std::string_view name, std::string_view extension,
                                std::string_view description, OptionalWriter writer,
                                std::string_view library) {
  return {.name = name,
          .extension = extension,
          .description = description,
          .writeMesh = writer.write,
          .missing = writer.isThere ? std::string_view() : library};
}

constexpr std::array kFormats = {
    Format{.name = "hexex",
           .extension = ".hexex",
           .description = "text of parametrized tets",
           .readMap = readPlain<readHexex>,
           .writeMap = writePlain<writeHexex>,
           .readTets = readHexexTets},
    Format{.name = "mesh",
           .extension = ".mesh",
           .description = "MEDIT (Gamma Mesh Format), text",
           .readTets = readMeditTets,
           .readMesh = readMedit,
           .writeMesh = writeMedit,
           .openSink = openMeditSink},
    Format{.name = "meshb",
           .extension = ".meshb",
           .description = "MEDIT (Gamma Mesh Format), binary",
           .readTets = readMeshbTets,
           .readMesh = readMeshb,
           .writeMesh = writeMeshb,
           .openSink = openMeshbSink},
    Format{.name = "vtu",
           .extension = ".vtu",
           .description = "VTK XML unstructured grid, binary",
           .readMap = readVtuMap,
           .writeMap = writeVtuMap,
           .readTets = readVtuTets,
           .readMesh = readVtu,
           .writeMesh = writeVtu,
           .openSink = openVtuSink,
           .readMeshTo = readVtuTo,
           .compresses = true},
    Format{.name = "vtk",
           .extension = ".vtk",
           .description = "legacy VTK 2.0, text",
           .readMap = readVtkLegacyMap,
           .writeMap = writeVtkLegacyMap,
           .readTets = readVtkLegacyTets,
           .readMesh = readVtkLegacy,
           .writeMesh = writeVtkLegacy,
           .openSink = openVtkLegacySink},
    Format{.name = "vtk-binary",
           .extension = ".vtk",
           .description = "legacy VTK 2.0, binary",
           .readMap = readVtkLegacyMap,
           .writeMap = writeVtkLegacyMapBinary,
           .readTets = readVtkLegacyTets,
           .readMesh = readVtkLegacy,
           .writeMesh = writeVtkLegacyBinary,
           .openSink = openVtkLegacyBinarySink},
    Format{.name = "ovm",
           .extension = ".ovm",
           .description = "OpenVolumeMesh, text",
           .readMap = readPlain<readOvmMap>,
           .writeMap = writePlain<writeOvmMap>,
           .readTets = readOvmTets,
           .readMesh = readOvmHexMesh,
           .writeMesh = kWriteOvm},
    Format{.name = "ovmb",
           .extension = ".ovmb",
           .description = "OpenVolumeMesh, binary",
           .readMap = readPlain<readOvmbMap>,
           .writeMap = writePlain<writeOvmbMap>,
           .readTets = readOvmbTets,
           .readMesh = readOvmbHexMesh,
           .writeMesh = kWriteOvmb},
    Format{.name = "msh",
           .extension = ".msh",
           .description = "Gmsh 4.1, binary",
           .readTets = readGmshTets,
           .readMesh = readGmsh,
           .writeMesh = writeGmsh41Binary,
           .openSink = openGmsh41BinarySink},
    Format{.name = "msh41-ascii",
           .extension = ".msh",
           .description = "Gmsh 4.1, text",
           .readTets = readGmshTets,
           .readMesh = readGmsh,
           .writeMesh = writeGmsh41Text},
    Format{.name = "msh22-ascii",
           .extension = ".msh",
           .description = "Gmsh 2.2, text",
           .readTets = readGmshTets,
           .readMesh = readGmsh,
           .writeMesh = writeGmsh22Text},
    Format{.name = "inp",
           .extension = ".inp",
           .description = "Abaqus and CalculiX, text",
           .writeMesh = writeAbaqus},
    Format{.name = "mfem",
           .extension = "",
           .description = "MFEM mesh v1.0, text",
           .writeMesh = writeMfem},
    Format{.name = "openfoam",
           .extension = ".foam",
           .description = "OpenFOAM polyMesh, a folder",
           .writeMesh = writeOpenFoam},
    optionalFormat("vtkhdf", ".vtkhdf", "VTKHDF", {kWriteVtkHdf, kHasHdf5}, "HDF5 (libhdf5-dev)"),
    optionalFormat("cgns", ".cgns", "CGNS", {kWriteCgns, kHasCgns}, "CGNS (libcgns-dev)"),
    optionalFormat("exodus", ".exo", "Exodus II", {kWriteExodus, kHasExodus},
                   "Exodus (libexodusii-dev)"),
    optionalFormat("exodus-e", ".e", "Exodus II", {kWriteExodus, kHasExodus},
                   "Exodus (libexodusii-dev)"),
};

/// Other names for formats.
constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kOtherNames = {
    {{"gmsh", "msh"},
     {"gmsh41", "msh"},
     {"gmsh41-ascii", "msh41-ascii"},
     {"gmsh22", "msh22-ascii"},
     {"medit", "mesh"}}};

bool holdsMaps(const Format& format) {
  return format.readMap != nullptr || format.writeMap != nullptr;
}
bool holdsMeshes(const Format& format) {
  return format.readMesh != nullptr || format.writeMesh != nullptr || !format.missing.empty();
}

/// What a format is looked for.
struct Purpose {
  bool (*fits)(const Format& format);
  const char* what;
};
constexpr Purpose kForMaps = {holdsMaps, "maps"};
constexpr Purpose kForMeshes = {holdsMeshes, "hexahedral meshes"};

std::string lowerCaseExtension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return extension;
}

/// ".mesh, .vtu": what file names can mean.
std::string listExtensions(bool (*fits)(const Format&)) {
  std::string list;
  std::string_view last;
  for (const Format& format : kFormats) {
    if (!fits(format) || format.extension.empty() || format.extension == last) continue;
    last = format.extension;
    list += (list.empty() ? "" : ", ") + std::string(last);
  }
  return list;
}

std::string listNames(bool (*fits)(const Format&)) {
  std::string list;
  for (const Format& format : kFormats) {
    if (fits(format)) list += (list.empty() ? "" : ", ") + std::string(format.name);
  }
  return list;
}

const Format& formatNamed(std::string_view name, const std::filesystem::path& file,
                          const Purpose& purpose) {
  for (const auto& [other, usual] : kOtherNames) {
    if (name == other) name = usual;
  }
  for (const Format& format : kFormats) {
    if (format.name == name && purpose.fits(format)) return format;
  }
  throw Error(ErrorCode::FileUnsupported, file.string() + ": \"" + std::string(name) +
                                              "\" is no format of " + purpose.what +
                                              ". Formats: " + listNames(purpose.fits) + ".");
}

const Format& findFormat(const std::filesystem::path& file, std::string_view name,
                         const Purpose& purpose) {
  if (!name.empty()) return formatNamed(name, file, purpose);
  const std::string extension = lowerCaseExtension(file);
  for (const Format& format : kFormats) {
    if (!extension.empty() && format.extension == extension && purpose.fits(format)) return format;
  }
  const std::string problem =
      extension.empty() ? "the file name has no extension"
                        : "the extension \"" + extension + "\" is no format of " + purpose.what;
  const bool tetsOnly = std::any_of(kFormats.begin(), kFormats.end(), [&](const Format& format) {
    return purpose.fits == holdsMaps && !extension.empty() && format.extension == extension &&
           format.readTets != nullptr;
  });
  throw Error(ErrorCode::FileUnsupported,
              file.string() + ": " + problem + ". Maps: " + listExtensions(holdsMaps) +
                  "; hexahedral meshes: " + listExtensions(holdsMeshes) + "." +
                  (tetsOnly ? " Tets without a map need a second mesh with their parameters "
                              "(--tets, --polycube)."
                            : ""));
}

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

const Format& mapFormat(const std::filesystem::path& file, std::string_view name) {
  return findFormat(file, name, kForMaps);
}

const Format& hexMeshFormat(const std::filesystem::path& file, std::string_view name) {
  const Format& format = findFormat(file, name, kForMeshes);
  if (format.missing.empty()) return format;
  throw Error(ErrorCode::FileUnsupported, file.string() +
                                              ": this build of hexhex cannot write the format \"" +
                                              std::string(format.name) + "\". Install " +
                                              std::string(format.missing) + " and build it anew.");
}

std::span<const FileFormat> fileFormats() {
  static const std::vector<FileFormat> list = [] {
    std::vector<FileFormat> result;
    result.reserve(kFormats.size());
    for (const Format& format : kFormats) {
      if (!format.missing.empty()) continue;
      result.push_back({format.name, format.extension, format.description,
                        format.readMap != nullptr, format.writeMap != nullptr,
                        format.readTets != nullptr, format.readMesh != nullptr,
                        format.writeMesh != nullptr, format.openSink != nullptr,
                        format.compresses && hasZlib()});
    }
    return result;
  }();
  return list;
}

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

TetMesh readTetMesh(const std::filesystem::path& file, const ReadOptions& options,
                    Context& context) {
  constexpr Purpose kForTets = {[](const Format& format) { return format.readTets != nullptr; },
                                "tetrahedral meshes"};
  const Format& format = findFormat(file, options.format, kForTets);
  TetCells tets = format.readTets(file, context);
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
  constexpr Purpose kForBoth = {
      [](const Format& format) { return holdsMaps(format) || holdsMeshes(format); },
      "maps or hexahedral meshes"};
  const Format& format = findFormat(file, options.format, kForBoth);
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
                  listNames(able) + ".");
}

std::unique_ptr<MeshSink> openMeshSink(const std::filesystem::path& file, Context& context) {
  return openMeshSink(file, {}, context);
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
