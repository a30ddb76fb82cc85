#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <string_view>

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
#include <mesh/smooth_patches.hpp>
#include <mesh/vertex_cells.hpp>

namespace hexhex {
namespace {

constexpr std::array<MapFormat, 3> kMapFormats = {{{".hexex", readHexex, writeHexex},
                                                   {".ovm", readOvmMap, writeOvmMap},
                                                   {".ovmb", readOvmbMap, writeOvmbMap}}};

/// Formats over libraries that not every build has.
#if defined(HEXHEX_HAS_HDF5)
constexpr HexMeshFormat kVtkHdf = {"vtkhdf", ".vtkhdf", nullptr, writeVtkHdf};
#else
constexpr HexMeshFormat kVtkHdf = {"vtkhdf", ".vtkhdf",           nullptr, nullptr, nullptr,
                                   nullptr,  "HDF5 (libhdf5-dev)"};
#endif
#if defined(HEXHEX_HAS_CGNS)
constexpr HexMeshFormat kCgns = {"cgns", ".cgns", nullptr, writeCgns};
#else
constexpr HexMeshFormat kCgns = {
    "cgns", ".cgns", nullptr, nullptr, nullptr, nullptr, "CGNS (libcgns-dev)"};
#endif
#if defined(HEXHEX_HAS_EXODUS)
constexpr HexMeshFormat kExodus = {"exodus", ".exo", nullptr, writeExodus};
constexpr HexMeshFormat kExodusE = {"exodus", ".e", nullptr, writeExodus};
#else
constexpr HexMeshFormat kExodus = {
    "exodus", ".exo", nullptr, nullptr, nullptr, nullptr, "Exodus (libexodusii-dev)"};
constexpr HexMeshFormat kExodusE = {
    "exodus", ".e", nullptr, nullptr, nullptr, nullptr, "Exodus (libexodusii-dev)"};
#endif

constexpr std::array<HexMeshFormat, 16> kHexMeshFormats = {
    {{"mesh", ".mesh", readMedit, writeMedit, openMeditSink},
     {"vtu", ".vtu", readVtu, writeVtu, openVtuSink, readVtuTo},
     {"ovm", ".ovm", readOvmHexMesh, writeOvmHexMesh},
     {"ovmb", ".ovmb", readOvmbHexMesh, writeOvmbHexMesh},
     {"meshb", ".meshb", readMeshb, writeMeshb},
     {"vtk", ".vtk", readVtkLegacy, writeVtkLegacy},
     {"msh", ".msh", readGmsh, writeGmsh41Binary},
     {"msh41-ascii", ".msh", readGmsh, writeGmsh41Text},
     {"msh22-ascii", ".msh", readGmsh, writeGmsh22Text},
     {"inp", ".inp", nullptr, writeAbaqus},
     {"mfem", "", nullptr, writeMfem},
     {"openfoam", ".foam", nullptr, writeOpenFoam},
     kVtkHdf,
     kCgns,
     kExodus,
     kExodusE}};

std::string lowerCaseExtension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return extension;
}

/// ".mesh, .vtu": those of the formats that a file name can mean.
template <class Format>
std::string listExtensions(std::span<const Format> formats) {
  std::string list;
  std::string_view last;
  for (const Format& format : formats) {
    if (format.extension.empty() || format.extension == last) continue;
    last = format.extension;
    list += (list.empty() ? "" : ", ") + std::string(last);
  }
  return list;
}

template <class Format>
const Format& findFormat(std::span<const Format> formats, const std::filesystem::path& file,
                         const std::string& what) {
  const std::string extension = lowerCaseExtension(file);
  const auto found = std::find_if(formats.begin(), formats.end(), [&](const Format& format) {
    return !extension.empty() && format.extension == extension;
  });
  if (found != formats.end()) return *found;
  const std::string problem = extension.empty()
                                  ? "the file name has no extension"
                                  : "the extension \"" + extension + "\" is no format of " + what;
  throw Error(ErrorCode::FileUnsupported,
              file.string() + ": " + problem + ". Maps: " + listExtensions<MapFormat>(kMapFormats) +
                  "; hexahedral meshes: " + listExtensions<HexMeshFormat>(kHexMeshFormats) + ".");
}

const HexMeshFormat& findHexMeshFormat(std::string_view name, const std::filesystem::path& file) {
  std::string known;
  for (const HexMeshFormat& format : kHexMeshFormats) {
    if (format.name == name) return format;
    known += (known.empty() ? "" : ", ") + std::string(format.name);
  }
  throw Error(ErrorCode::FileUnsupported,
              file.string() + ": \"" + std::string(name) +
                  "\" is no format of hexahedral meshes. Formats: " + known + ".");
}

/// The format of a file that is to be read.
const HexMeshFormat& readableFormat(const std::filesystem::path& file) {
  const HexMeshFormat& format = hexMeshFormat(file);
  if (format.read != nullptr) return format;
  throw Error(ErrorCode::FileUnsupported, file.string() + ": files of the format \"" +
                                              std::string(format.name) +
                                              "\" are written, but not read.");
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
  const std::size_t cell = firstCellOutOfRange(mesh, stage);
  if (cell < mesh.cells.size()) {
    throw Error(ErrorCode::InvalidArgument,
                "A corner of cell " + std::to_string(cell) + " is not a vertex of the mesh.",
                Place{PlaceKind::Cell, cell});
  }
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

}  // namespace

const MapFormat& mapFormat(const std::filesystem::path& file) {
  return findFormat<MapFormat>(kMapFormats, file, "maps");
}

const HexMeshFormat& hexMeshFormat(const std::filesystem::path& file, std::string_view name) {
  const HexMeshFormat& format =
      name.empty() ? findFormat<HexMeshFormat>(kHexMeshFormats, file, "hexahedral meshes")
                   : findHexMeshFormat(name, file);
  if (format.missing.empty()) return format;
  throw Error(ErrorCode::FileUnsupported, file.string() +
                                              ": this build of hexhex cannot write the format \"" +
                                              std::string(format.name) + "\". Install " +
                                              std::string(format.missing) + " and build it anew.");
}

TetMap readMap(const std::filesystem::path& file, Context& context) {
  return mapFormat(file).read(file, context);
}

TetMap readMap(const std::filesystem::path& file) {
  Context context;
  return readMap(file, context);
}

void writeMap(const TetMap& map, const std::filesystem::path& file, Context& context) {
  mapFormat(file).write(map, file, context);
}

void writeMap(const TetMap& map, const std::filesystem::path& file) {
  Context context;
  writeMap(map, file, context);
}

HexMesh readHexMesh(const std::filesystem::path& file, Context& context) {
  return readableFormat(file).read(file, context);
}

HexMesh readHexMesh(const std::filesystem::path& file) {
  Context context;
  return readHexMesh(file, context);
}

void writeHexMesh(const HexMesh& mesh, const std::filesystem::path& file,
                  const WriteOptions& options, Context& context) {
  const HexMeshFormat& format = hexMeshFormat(file, options.format);
  {
    Stage stage(context, "write mesh");
    withThreads(context.threads(), [&] { requireWritable(mesh, options, stage); });
  }
  format.write(mesh, file, options, context);
}

void writeHexMesh(const HexMesh& mesh, const std::filesystem::path& file, Context& context) {
  writeHexMesh(mesh, file, {}, context);
}

void writeHexMesh(const HexMesh& mesh, const std::filesystem::path& file) {
  Context context;
  writeHexMesh(mesh, file, context);
}

std::unique_ptr<MeshSink> openMeshSink(const std::filesystem::path& file, Context& context) {
  const HexMeshFormat& format = hexMeshFormat(file);
  if (format.openSink != nullptr) return format.openSink(file, context);
  std::string able;
  for (const HexMeshFormat& each : kHexMeshFormats) {
    if (each.openSink == nullptr) continue;
    able += (able.empty() ? "" : ", ") + std::string(each.extension);
  }
  throw Error(ErrorCode::FileUnsupported,
              file.string() +
                  ": a mesh in pieces cannot be written in this format. Formats that can: " + able +
                  ".");
}

void readHexMeshTo(MeshSink& sink, const std::filesystem::path& file, Context& context) {
  const HexMeshFormat& format = readableFormat(file);
  withThreads(context.threads(), [&] {
    if (format.readTo != nullptr) return format.readTo(sink, file, context);
    sendTo(sink, format.read(file, context));
  });
}

void requireHexMeshFormat(const std::filesystem::path& file, std::string_view format) {
  static_cast<void>(hexMeshFormat(file, format));
}

}  // namespace hexhex
