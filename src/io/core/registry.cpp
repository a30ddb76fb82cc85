#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <hexhex/error.hpp>
#include <hexhex/io.hpp>

#include <io/core/registry.hpp>
#include <io/core/text_scanner.hpp>
#include <io/core/zlib_blocks.hpp>
#include <io/curved/lagrange_files.hpp>
#include <io/gmsh/gmsh.hpp>
#include <io/hexex/hexex.hpp>
#include <io/medit/medit.hpp>
#include <io/ovm/ovm.hpp>
#include <io/parts/parts.hpp>
#include <io/solvers/solvers.hpp>
#include <io/surface/surface.hpp>
#include <io/vtk/vtk.hpp>

namespace hexhex::io {
namespace {

// Of formats whose maps need no options.
template <auto read>
TetMap readPlain(const Input& input, const ReadOptions& /*options*/, Context& context) {
  return read(input, context);
}
template <auto write>
void writePlain(const TetMap& map, const std::filesystem::path& file,
                const WriteOptions& /*options*/, Context& context) {
  write(map, file, context);
}

TetCells readHexexTets(const Input& input, Context& context) {
  const TetMap map = readHexex(input, {}, context);
  TetCells tets;
  tets.points.assign(map.points.begin(), map.points.end());
  tets.cells.assign(map.tets.begin(), map.tets.end());
  return tets;
}

// Formats over HDF5, which not every build has.
#if defined(HEXHEX_HAS_HDF5)
constexpr auto kWriteVtkHdf = writeVtkHdf;
constexpr auto kWriteCgns = writeCgns;
#else
constexpr decltype(&writeVtkHdf) kWriteVtkHdf = nullptr;
constexpr decltype(&writeCgns) kWriteCgns = nullptr;
#endif

void writeExodusFile(const HexMesh& mesh, const std::filesystem::path& file,
                     const WriteOptions& options, Context& context) {
  writeExodus(mesh, file, options, context);
}

constexpr Format exodusFormat(std::string_view name, std::string_view extension) {
  return {.label = {name, extension, "Exodus II"},
          .readTets = ExodusFormat::readTets,
          .meshes = {ExodusFormat::readMesh, writeExodusFile},
          .curved = {ExodusFormat::holdsCurved, ExodusFormat::readCurved}};
}

constexpr std::array kFormatTable = {
    Format{.label = {"hexex", ".hexex", "text of parametrized tets"},
           .maps = {readHexex, writePlain<writeHexex>},
           .readTets = readHexexTets},
    Format{.label = {"mesh", ".mesh", "MEDIT (Gamma Mesh Format), text"},
           .readTets = readMeditTets,
           .meshes = {readMedit, writeMedit},
           .pieces = {openMeditSink, readMeditTo}},
    Format{.label = {"meshb", ".meshb", "MEDIT (Gamma Mesh Format), binary"},
           .readTets = readMeshbTets,
           .meshes = {readMeshb, writeMeshb},
           .pieces = {openMeshbSink, readMeshbTo}},
    Format{.label = {"vtu", ".vtu", "VTK XML unstructured grid, binary"},
           .maps = {readVtuMap, writeVtuMap},
           .readTets = readVtuTets,
           .meshes = {readVtu, writeVtu},
           .curved = {holdsLagrangeVtu, readLagrangeVtu},
           .pieces = {openVtuSink, readVtuTo},
           .compresses = true},
    Format{.label = {"pvtu", ".pvtu", "VTK XML in pieces (extract --parts)"},
           .meshes = {.read = readPvtu}},
    Format{.label = {"vtk", ".vtk", "legacy VTK 2.0, text"},
           .maps = {readVtkLegacyMap, writeVtkLegacyMap},
           .readTets = readVtkLegacyTets,
           .meshes = {readVtkLegacy, writeVtkLegacy},
           .curved = {holdsCurvedVtkLegacy, readCurvedVtkLegacy},
           .pieces = {openVtkLegacySink, readVtkLegacyTo}},
    Format{.label = {"vtk-binary", ".vtk", "legacy VTK 2.0, binary"},
           .maps = {readVtkLegacyMap, writeVtkLegacyMapBinary},
           .readTets = readVtkLegacyTets,
           .meshes = {readVtkLegacy, writeVtkLegacyBinary},
           .curved = {holdsCurvedVtkLegacy, readCurvedVtkLegacy},
           .pieces = {openVtkLegacyBinarySink, readVtkLegacyTo}},
    Format{.label = {"ovm", ".ovm", "OpenVolumeMesh, text"},
           .maps = {readPlain<readOvmMap>, writePlain<writeOvmMap>},
           .readTets = readOvmTets,
           .meshes = {readOvmHexMesh, writeOvmHexMesh}},
    Format{.label = {"ovmb", ".ovmb", "OpenVolumeMesh, binary"},
           .maps = {readPlain<readOvmbMap>, writePlain<writeOvmbMap>},
           .readTets = readOvmbTets,
           .meshes = {readOvmbHexMesh, writeOvmbHexMesh}},
    Format{.label = {"msh", ".msh", "Gmsh 4.1, binary"},
           .readTets = readGmshTets,
           .meshes = {readGmsh, writeGmsh41Binary},
           .pieces = {openGmsh41BinarySink, readGmshTo}},
    Format{.label = {"msh41-ascii", ".msh", "Gmsh 4.1, text"},
           .readTets = readGmshTets,
           .meshes = {readGmsh, writeGmsh41Text}},
    Format{.label = {"msh22-ascii", ".msh", "Gmsh 2.2, text"},
           .readTets = readGmshTets,
           .meshes = {readGmsh, writeGmsh22Text}},
    Format{.label = {"inp", ".inp", "Abaqus and CalculiX, text"},
           .readTets = AbaqusFormat::readTets,
           .meshes = {AbaqusFormat::readMesh, writeAbaqus},
           .curved = {AbaqusFormat::holdsCurved, AbaqusFormat::readCurved}},
    Format{.label = {"mfem", "", "MFEM mesh v1.0, text"}, .meshes = {.write = writeMfem}},
    Format{.label = {"openfoam", ".foam", "OpenFOAM polyMesh, a folder"},
           .meshes = {.write = writeOpenFoam}},
    Format{.label = {"vtkhdf", ".vtkhdf", "VTKHDF"},
           .meshes = {.write = kWriteVtkHdf},
           .overHdf5 = true},
    Format{.label = {"cgns", ".cgns", "CGNS"}, .meshes = {.write = kWriteCgns}, .overHdf5 = true},
    exodusFormat("exodus", ".exo"),
    exodusFormat("exodus-e", ".e"),
    Format{.label = {"stl", ".stl", "surface of triangles, text or binary"},
           .readTriangles = readStl},
    Format{.label = {"obj", ".obj", "Wavefront surface"}, .readTriangles = readObj},
    Format{.label = {"off", ".off", "surface of polygons, text"}, .readTriangles = readOff},
    Format{.label = {"ply", ".ply", "surface of polygons"}, .readTriangles = readPly},
};

/// Other names for formats.
constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kOtherFormatNames = {
    {{"gmsh", "msh"},
     {"gmsh41", "msh"},
     {"gmsh41-ascii", "msh41-ascii"},
     {"gmsh22", "msh22-ascii"},
     {"medit", "mesh"}}};

/// The name in the table of what may be called by another name.
std::string_view usualName(std::string_view name) {
  for (const auto& [other, usual] : kOtherFormatNames) {
    if (name == other) return usual;
  }
  return name;
}

bool holdsMaps(const Format& format) {
  return format.maps.read != nullptr || format.maps.write != nullptr;
}
bool holdsMeshes(const Format& format) {
  return format.meshes.read != nullptr || format.meshes.write != nullptr || format.overHdf5;
}

/// What a format is looked for.
struct Purpose {
  bool (*fits)(const Format& format);
  const char* what;
};

constexpr Purpose purposeOf(FileContent content) {
  switch (content) {
    case FileContent::Map:
      return {holdsMaps, "maps"};
    case FileContent::HexMesh:
      return {holdsMeshes, "hexahedral meshes"};
    case FileContent::MapOrHexMesh:
      return {[](const Format& format) { return holdsMaps(format) || holdsMeshes(format); },
              "maps or hexahedral meshes"};
    case FileContent::Triangles:
      return {[](const Format& format) { return format.readTriangles != nullptr; }, "surfaces"};
    case FileContent::Tets:
      break;
  }
  return {[](const Format& format) { return format.readTets != nullptr; }, "tetrahedral meshes"};
}

/// ".mesh, .vtu": the names or extensions of the formats that fit.
std::string listed(bool (*fits)(const Format&), std::string_view FormatLabel::*what) {
  std::string list;
  std::string_view last;
  for (const Format& format : kFormatTable) {
    const std::string_view word = format.label.*what;
    if (!fits(format) || word.empty() || word == last) continue;
    last = word;
    list += (list.empty() ? "" : ", ") + std::string(word);
  }
  return list;
}

/// @param key  the format's name or its extension, as `member` says; null if there is no such one
const Format* formatWith(std::string_view key, std::string_view FormatLabel::*member,
                         bool (*fits)(const Format&)) {
  const auto found =
      std::find_if(kFormatTable.begin(), kFormatTable.end(), [&](const Format& format) {
        return !key.empty() && format.label.*member == key && fits(format);
      });
  return found == kFormatTable.end() ? nullptr : &*found;
}

[[noreturn]] void failToName(const std::filesystem::path& file, std::string_view name,
                             const Purpose& purpose) {
  throw Error(ErrorCode::FileUnsupported,
              file.string() + ": \"" + std::string(name) + "\" is no format of " + purpose.what +
                  ". Formats: " + listed(purpose.fits, &FormatLabel::name) + ".");
}

[[noreturn]] void failToExtend(const std::filesystem::path& file, const std::string& extension,
                               FileContent content) {
  std::error_code unknown;
  const std::string problem =
      extension.empty()
          ? (std::filesystem::is_directory(file, unknown) ? "it is a folder"
                                                          : "the file name has no extension")
          : "the extension \"" + extension + "\" is no format of " + purposeOf(content).what;
  const bool tetsOnly =
      content == FileContent::Map &&
      formatWith(extension, &FormatLabel::extension, purposeOf(FileContent::Tets).fits) != nullptr;
  throw Error(ErrorCode::FileUnsupported,
              file.string() + ": " + problem +
                  ". Maps: " + listed(holdsMaps, &FormatLabel::extension) +
                  "; hexahedral meshes: " + listed(holdsMeshes, &FormatLabel::extension) + "." +
                  (tetsOnly ? " Tets without a map need a second mesh with their parameters "
                              "(--tets, --polycube)."
                            : ""));
}

}  // namespace

const Format& findFormat(const std::filesystem::path& file, std::string_view name,
                         FileContent content) {
  const Purpose purpose = purposeOf(content);
  const std::string_view usual = usualName(name);
  const std::string extension = lowerCaseExtension(isGzip(file) ? file.stem() : file);
  const Format* const format = usual.empty()
                                   ? formatWith(extension, &FormatLabel::extension, purpose.fits)
                                   : formatWith(usual, &FormatLabel::name, purpose.fits);
  if (format == nullptr && !usual.empty()) failToName(file, usual, purpose);
  if (format == nullptr) failToExtend(file, extension, content);
  return *format;
}

std::string streamingFormats() {
  return listed([](const Format& format) { return format.pieces.openSink != nullptr; },
                &FormatLabel::name);
}

}  // namespace hexhex::io

namespace hexhex {

std::span<const FileFormat> fileFormats() {
  static const std::vector<FileFormat> list = [] {
    std::vector<FileFormat> result;
    for (const io::Format& format : io::kFormatTable) {
      if (format.overHdf5 && format.meshes.write == nullptr) continue;  // not in this build
      result.push_back({format.label.name, format.label.extension, format.label.description,
                        format.maps.read != nullptr, format.maps.write != nullptr,
                        format.readTets != nullptr, format.meshes.read != nullptr,
                        format.meshes.write != nullptr, format.pieces.openSink != nullptr,
                        format.compresses && io::hasZlib(), format.readTriangles != nullptr});
    }
    return result;
  }();
  return list;
}

}  // namespace hexhex
