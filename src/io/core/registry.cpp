#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <hexhex/error.hpp>
#include <hexhex/io.hpp>

#include <io/core/letter_case.hpp>
#include <io/core/registry.hpp>
#include <io/core/zlib_blocks.hpp>
#include <io/gmsh/gmsh.hpp>
#include <io/hexex/hexex.hpp>
#include <io/medit/medit.hpp>
#include <io/ovm/ovm.hpp>
#include <io/solvers/abaqus.hpp>
#include <io/solvers/cgns.hpp>
#include <io/solvers/exodus.hpp>
#include <io/solvers/mfem.hpp>
#include <io/solvers/openfoam.hpp>
#include <io/vtk/vtk_legacy.hpp>
#include <io/vtk/vtkhdf.hpp>
#include <io/vtk/vtu.hpp>

namespace hexhex {
namespace {

// Of formats whose readers take bytes in memory, too.
template <auto read>
auto readFile(const std::filesystem::path& file, Context& context) {
  return read(file, context);
}

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

constexpr std::array kFormatTable = {
    Format{.name = "hexex",
           .extension = ".hexex",
           .description = "text of parametrized tets",
           .readMap = readPlain<readHexex>,
           .writeMap = writePlain<writeHexex>,
           .readTets = readHexexTets},
    Format{.name = "mesh",
           .extension = ".mesh",
           .description = "MEDIT (Gamma Mesh Format), text",
           .readTets = readFile<readMeditTets>,
           .readMesh = readFile<readMedit>,
           .writeMesh = writeMedit,
           .openSink = openMeditSink},
    Format{.name = "meshb",
           .extension = ".meshb",
           .description = "MEDIT (Gamma Mesh Format), binary",
           .readTets = readFile<readMeshbTets>,
           .readMesh = readFile<readMeshb>,
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
           .writeMesh = writeOvmHexMesh},
    Format{.name = "ovmb",
           .extension = ".ovmb",
           .description = "OpenVolumeMesh, binary",
           .readMap = readPlain<readOvmbMap>,
           .writeMap = writePlain<writeOvmbMap>,
           .readTets = readOvmbTets,
           .readMesh = readOvmbHexMesh,
           .writeMesh = writeOvmbHexMesh},
    Format{.name = "msh",
           .extension = ".msh",
           .description = "Gmsh 4.1, binary",
           .readTets = readFile<readGmshTets>,
           .readMesh = readFile<readGmsh>,
           .writeMesh = writeGmsh41Binary,
           .openSink = openGmsh41BinarySink},
    Format{.name = "msh41-ascii",
           .extension = ".msh",
           .description = "Gmsh 4.1, text",
           .readTets = readFile<readGmshTets>,
           .readMesh = readFile<readGmsh>,
           .writeMesh = writeGmsh41Text},
    Format{.name = "msh22-ascii",
           .extension = ".msh",
           .description = "Gmsh 2.2, text",
           .readTets = readFile<readGmshTets>,
           .readMesh = readFile<readGmsh>,
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
constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kOtherFormatNames = {
    {{"gmsh", "msh"},
     {"gmsh41", "msh"},
     {"gmsh41-ascii", "msh41-ascii"},
     {"gmsh22", "msh22-ascii"},
     {"medit", "mesh"}}};

}  // namespace

std::span<const Format> allFormats() noexcept { return kFormatTable; }

std::string_view usualFormatName(std::string_view name) noexcept {
  for (const auto& [other, usual] : kOtherFormatNames) {
    if (name == other) return usual;
  }
  return name;
}

namespace {

bool holdsMaps(const Format& format) {
  return format.readMap != nullptr || format.writeMap != nullptr;
}
bool holdsMeshes(const Format& format) {
  return format.readMesh != nullptr || format.writeMesh != nullptr || !format.missing.empty();
}

/// What a format is looked for.
struct FormatPurpose {
  bool (*fits)(const Format& format);
  const char* what;
};
constexpr FormatPurpose kForMaps = {holdsMaps, "maps"};
constexpr FormatPurpose kForMeshes = {holdsMeshes, "hexahedral meshes"};
constexpr FormatPurpose kForBoth = {
    [](const Format& format) { return holdsMaps(format) || holdsMeshes(format); },
    "maps or hexahedral meshes"};
constexpr FormatPurpose kForTets = {[](const Format& format) { return format.readTets != nullptr; },
                                    "tetrahedral meshes"};

/// ".mesh, .vtu": what file names can mean.
std::string listExtensions(bool (*fits)(const Format&)) {
  std::string list;
  std::string_view last;
  for (const Format& format : allFormats()) {
    if (!fits(format) || format.extension.empty() || format.extension == last) continue;
    last = format.extension;
    list += (list.empty() ? "" : ", ") + std::string(last);
  }
  return list;
}

const Format& formatNamed(std::string_view name, const std::filesystem::path& file,
                          const FormatPurpose& purpose) {
  name = usualFormatName(name);
  for (const Format& format : allFormats()) {
    if (format.name == name && purpose.fits(format)) return format;
  }
  throw Error(ErrorCode::FileUnsupported, file.string() + ": \"" + std::string(name) +
                                              "\" is no format of " + purpose.what +
                                              ". Formats: " + listFormatNames(purpose.fits) + ".");
}

const Format& findFormat(const std::filesystem::path& file, std::string_view name,
                         const FormatPurpose& purpose) {
  if (!name.empty()) return formatNamed(name, file, purpose);
  const std::string extension = lowerCaseExtension(file);
  for (const Format& format : allFormats()) {
    if (!extension.empty() && format.extension == extension && purpose.fits(format)) return format;
  }
  const std::string problem =
      extension.empty() ? "the file name has no extension"
                        : "the extension \"" + extension + "\" is no format of " + purpose.what;
  const std::span<const Format> formats = allFormats();
  const bool tetsOnly = std::any_of(formats.begin(), formats.end(), [&](const Format& format) {
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

const Format& mapOrHexMeshFormat(const std::filesystem::path& file, std::string_view name) {
  return findFormat(file, name, kForBoth);
}

const Format& tetFormat(const std::filesystem::path& file, std::string_view name) {
  return findFormat(file, name, kForTets);
}

std::string listFormatNames(bool (*fits)(const Format&)) {
  std::string list;
  for (const Format& format : allFormats()) {
    if (fits(format)) list += (list.empty() ? "" : ", ") + std::string(format.name);
  }
  return list;
}

std::span<const FileFormat> fileFormats() {
  static const std::vector<FileFormat> list = [] {
    std::vector<FileFormat> result;
    result.reserve(allFormats().size());
    for (const Format& format : allFormats()) {
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

}  // namespace hexhex
