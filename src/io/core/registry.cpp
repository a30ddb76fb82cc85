#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <utility>
#include <vector>

#include <hexhex/error.hpp>
#include <hexhex/io.hpp>

#include <io/core/compressed_blocks.hpp>
#include <io/core/registry.hpp>
#include <io/core/text_scanner.hpp>

namespace hexhex::io {
namespace {

TetCells readHexexTets(const Input& input, Stage& stage) {
  const TetMap map = readHexex(input, {}, stage);
  TetCells tets;
  tets.points.assign(map.points.begin(), map.points.end());
  tets.cells.assign(map.tets.begin(), map.tets.end());
  tets.features = map.features;
  return tets;
}

// Functions of formats based on HDF5, null in builds without it.
#if defined(HEXHEX_HAS_HDF5)
template <auto& function>
constexpr auto* kOverHdf5 = &function;
#else
template <auto& function>
constexpr std::remove_reference_t<decltype(function)>* kOverHdf5 = nullptr;
#endif

constexpr Format exodusFormat(std::string_view name, std::string_view extension,
                              std::string_view parts) {
  return {.label = {name, extension, "Exodus II"},
          .readTets = ExodusFormat::readTets,
          .meshes = {ExodusFormat::readMesh, writeExodus},
          .curved = {.isIn = ExodusFormat::holdsCurved,
                     .read = ExodusFormat::readCurved,
                     .write = writeQuadraticExodus,
                     .onlyOrder = 2},
          .parts = {openExodusPartSink, parts},
          .others = true};
}

template <bool binary>
constexpr Format meditFormat(std::string_view name, std::string_view extension,
                             std::string_view description) {
  using Medit = MeditFormat<binary>;
  return {.label = {name, extension, description},
          .readTets = Medit::readTets,
          .meshes = {Medit::readMesh, Medit::write},
          .curved = {.isIn = Medit::holdsCurved,
                     .read = Medit::readCurved,
                     .write = Medit::writeCurved,
                     .onlyOrder = 2},
          .pieces = {Medit::openSink, Medit::readTo},
          .others = true};
}

constexpr Format vtkGridFormat(std::string_view name, std::string_view extension,
                               std::string_view description) {
  return {.label = {name, extension, description},
          .meshes = {.read = readVtu},
          .pieces = {.read = readVtuTo}};
}

constexpr std::array kFormatTable = {
    Format{.label = {"hexex", ".hexex", "text of parametrized tets"},
           .maps = {readHexex, writeHexex},
           .readTets = readHexexTets},
    // Before "mesh": .mesh files of higher order are MFEM's.
    Format{.label = {"mfem", "", "MFEM mesh v1.0, text"},
           .readTets = MfemFormat::readTets,
           .meshes = {MfemFormat::readMesh, writeMfem},
           .curved = {.isIn = MfemFormat::holdsCurved,
                      .read = MfemFormat::readCurved,
                      .write = writeLagrangeMfem,
                      .extension = ".mesh"},
           .parts = {openMfemPartSink, "MFEM parallel mesh v1.2: NAME.000000 ..."}},
    meditFormat<false>("mesh", ".mesh", "MEDIT (Gamma Mesh Format), text"),
    meditFormat<true>("meshb", ".meshb", "MEDIT (Gamma Mesh Format), binary"),
    Format{.label = {"vtu", ".vtu", "VTK XML unstructured grid, binary"},
           .maps = {readVtuMap, writeVtuMap},
           .readTets = readVtuTets,
           .meshes = {readVtu, writeVtu},
           .curved = {holdsLagrangeVtu, readLagrangeVtu, writeLagrangeVtu},
           .pieces = {openVtuSink, readVtuTo},
           .writeArcs = PiecewiseVtk<false>::writeArcs,
           .writePatches = PiecewiseVtk<false>::writePatches,
           .compresses = true,
           .measures = true,
           .others = true,
           .groups = false},
    vtkGridFormat("vts", ".vts", "VTK XML structured grid"),
    vtkGridFormat("vtr", ".vtr", "VTK XML rectilinear grid"),
    vtkGridFormat("vti", ".vti", "VTK XML image data"),
    Format{.label = {"vtp", ".vtp", "VTK XML surface of polygons"},
           .triangles = {readVtp},
           .writeArcs = PiecewiseVtk<true>::writeArcs,
           .writePatches = PiecewiseVtk<true>::writePatches},
    Format{.label = {"pvtu", ".pvtu", "VTK XML in pieces (extract --parts)"},
           .meshes = {.read = readPvtu},
           .parts = {openPvtuSink, "VTK XML: NAME.pvtu, and pieces in the folder NAME"}},
    Format{.label = {"vtk", ".vtk", "legacy VTK 2.0, text"},
           .maps = {readVtkLegacyMap, VtkLegacyWriting<false>::writeMap},
           .readTets = readVtkLegacyTets,
           .triangles = {readVtkLegacySurface, holdsVtkLegacySurface},
           .meshes = {readVtkLegacy, VtkLegacyWriting<false>::writeMesh},
           .curved = {holdsCurvedVtkLegacy, readCurvedVtkLegacy},
           .pieces = {VtkLegacyWriting<false>::openSink, readVtkLegacyTo},
           .others = true,
           .groups = false},
    Format{.label = {"vtk-binary", ".vtk", "legacy VTK 2.0, binary"},
           .maps = {readVtkLegacyMap, VtkLegacyWriting<true>::writeMap},
           .readTets = readVtkLegacyTets,
           .meshes = {readVtkLegacy, VtkLegacyWriting<true>::writeMesh},
           .curved = {holdsCurvedVtkLegacy, readCurvedVtkLegacy},
           .pieces = {VtkLegacyWriting<true>::openSink, readVtkLegacyTo},
           .others = true,
           .groups = false},
    Format{.label = {"ovm", ".ovm", "OpenVolumeMesh, text"},
           .maps = {OvmText::readMap, OvmText::writeMap},
           .readTets = OvmText::readTets,
           .meshes = {OvmText::readMesh, OvmText::writeMesh},
           .groups = false},
    Format{.label = {"ovmb", ".ovmb", "OpenVolumeMesh, binary"},
           .maps = {OvmBinary::readMap, OvmBinary::writeMap},
           .readTets = OvmBinary::readTets,
           .meshes = {OvmBinary::readMesh, OvmBinary::writeMesh},
           .writeArcs = writeArcsOvmb,
           .writePatches = writePatchesOvmb,
           .groups = false},
    Format{.label = {"msh", ".msh", "Gmsh 4.1, binary"},
           .readTets = GmshFormat::readTets,
           .meshes = {GmshFormat::readMesh, writeGmsh41Binary},
           .curved = {GmshFormat::holdsCurved, GmshFormat::readCurved, writeLagrangeGmsh},
           .pieces = {openGmsh41BinarySink, readGmshTo},
           .parts = {openGmshPartSink, "Gmsh 4.1, binary: one file with partitioned entities"},
           .others = true},
    Format{.label = {"msh-split", ""},
           .parts = {openSplitGmshPartSink, "Gmsh 4.1, binary: NAME_K.msh, K from 1 on"}},
    Format{.label = {"msh41-ascii", ".msh", "Gmsh 4.1, text"},
           .readTets = GmshFormat::readTets,
           .meshes = {GmshFormat::readMesh, writeGmsh41Text},
           .others = true},
    Format{.label = {"msh22-ascii", ".msh", "Gmsh 2.2, text"},
           .readTets = GmshFormat::readTets,
           .meshes = {GmshFormat::readMesh, writeGmsh22Text},
           .others = true},
    Format{.label = {"inp", ".inp", "Abaqus and CalculiX, text"},
           .readTets = AbaqusFormat::readTets,
           .meshes = {AbaqusFormat::readMesh, writeAbaqus},
           .curved = {.isIn = AbaqusFormat::holdsCurved,
                      .read = AbaqusFormat::readCurved,
                      .write = writeQuadraticAbaqus,
                      .onlyOrder = 2},
           .others = true},
    Format{.label = {"unv", ".unv", "I-deas universal, text"},
           .readTets = UnvFormat::readTets,
           .meshes = {.read = UnvFormat::readMesh},
           .curved = {UnvFormat::holdsCurved, UnvFormat::readCurved}},
    Format{.label = {"tetgen", ".ele", "TetGen: tets, and points in NAME.node"},
           .readTets = readTetgen},
    Format{
        .label = {"openfoam", ".foam", "OpenFOAM polyMesh, a folder"},
        .meshes = {.read = readOpenFoam, .writeFolder = writeOpenFoam},
        .parts = {openOpenFoamPartSink, "OpenFOAM: processorK/constant/polyMesh beside NAME.foam"}},
    Format{.label = {"vtkhdf", ".vtkhdf", "VTKHDF"},
           .readTets = kOverHdf5<readVtkHdfTets>,
           .meshes = {kOverHdf5<readVtkHdf>, kOverHdf5<writeVtkHdf>},
           .curved = {kOverHdf5<holdsCurvedVtkHdf>, kOverHdf5<readCurvedVtkHdf>},
           .parts = {kOverHdf5<openVtkHdfPartSink>, "VTKHDF: one file"},
           .measures = true,
           .others = true,
           .groups = false,
           .overHdf5 = true},
    Format{
        .label = {"cgns", ".cgns", "CGNS"},
        .readTets = kOverHdf5<CgnsFormat::readTets>,
        .meshes = {kOverHdf5<CgnsFormat::readMesh>, kOverHdf5<writeCgns>},
        .curved = {.isIn = kOverHdf5<CgnsFormat::holdsCurved>,
                   .read = kOverHdf5<CgnsFormat::readCurved>,
                   .write = kOverHdf5<writeQuadraticCgns>,
                   .onlyOrder = 2},
        .parts = {kOverHdf5<openCgnsPartSink>, "CGNS: one file with a zone for each part", false},
        .overHdf5 = true},
    exodusFormat("exodus", ".exo", "Exodus with Nemesis maps: NAME.exo.N.K"),
    exodusFormat("exodus-e", ".e", "Exodus with Nemesis maps: NAME.e.N.K"),
    Format{.label = {"stl", ".stl", "surface of triangles, text or binary"},
           .triangles = {readStl}},
    Format{.label = {"obj", ".obj", "Wavefront surface"}, .triangles = {readObj}},
    Format{.label = {"off", ".off", "surface of polygons, text"}, .triangles = {readOff}},
    Format{.label = {"ply", ".ply", "surface of polygons"}, .triangles = {readPly}},
};

/// Aliases of formats.
constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kOtherFormatNames = {
    {{"gmsh", "msh"},
     {"gmsh41", "msh"},
     {"gmsh41-ascii", "msh41-ascii"},
     {"gmsh22", "msh22-ascii"},
     {"medit", "mesh"}}};

/// Resolves an alias or a solver's name to the name of a format in the table.
std::string_view usualName(const std::filesystem::path& file, std::string_view name,
                           FileContent content) {
  if (const SolverFormat* const solver = findSolver(name)) {
    if (content != FileContent::CurvedCells) return solver->format;
    if (!solver->curved.empty()) return solver->curved;
    throw Error(ErrorCode::FileUnsupported,
                concat(file.string(), ": for ", solver->program,
                       ", straight cells are written only. Leave out --order, or write another "
                       "format of cells of higher order."));
  }
  for (const auto& [other, usual] : kOtherFormatNames) {
    if (name == other) return usual;
  }
  return name;
}

bool holdsMaps(const Format& format) {
  return format.maps.read != nullptr || format.maps.write != nullptr;
}
constexpr bool writesParts(const Format& format) { return !format.parts.description.empty(); }
bool writesMeshes(const Format& format) {
  return format.meshes.write != nullptr || format.meshes.writeFolder != nullptr;
}
bool holdsMeshes(const Format& format) {
  return format.meshes.read != nullptr || writesMeshes(format) || format.overHdf5;
}

/// A use of formats: which ones fit, and its name in messages.
struct Purpose {
  bool (*fits)(const Format& format);
  const char* what;
};

/// Indexed by FileContent.
constexpr std::array<Purpose, 9> kPurposes = {
    {{holdsMaps, "maps"},
     {holdsMeshes, "hexahedral meshes"},
     {[](const Format& format) { return holdsMaps(format) || holdsMeshes(format); },
      "maps or hexahedral meshes"},
     {[](const Format& format) { return format.readTets != nullptr; }, "tetrahedral meshes"},
     {[](const Format& format) { return format.triangles.read != nullptr; }, "surfaces"},
     {writesParts, "meshes in parts"},
     {[](const Format& format) { return format.curved.write != nullptr; }, "cells of higher order"},
     {[](const Format& format) { return format.writeArcs != nullptr; }, "arcs"},
     {[](const Format& format) { return format.writePatches != nullptr; }, "patches"}}};

constexpr const Purpose& purposeOf(FileContent content) {
  return kPurposes[static_cast<std::size_t>(content)];
}

/// Keys by which formats are looked up: name or extension.
std::string_view nameOf(const Format& format, FileContent /*content*/) { return format.label.name; }
std::string_view extensionOf(const Format& format, FileContent content) {
  const bool own = content == FileContent::CurvedCells && !format.curved.extension.empty();
  return own ? format.curved.extension : format.label.extension;
}
using Word = std::string_view (*)(const Format& format, FileContent content);

/// The names or extensions of the formats that fit: ".mesh, .vtu".
std::string listed(bool (*fits)(const Format&), Word wordOf,
                   FileContent content = FileContent::HexMesh) {
  std::string list;
  std::string_view last;
  for (const Format& format : kFormatTable) {
    const std::string_view word = wordOf(format, content);
    if (!fits(format) || word.empty() || word == last) continue;
    last = word;
    list += concat((list.empty() ? "" : ", "), word);
  }
  return list;
}
std::string listed(FileContent content, Word wordOf) {
  return listed(purposeOf(content).fits, wordOf, content);
}

/// The first suitable format with this key; null if there is none.
/// @param key  a name or an extension, depending on `wordOf`
const Format* formatWith(std::string_view key, Word wordOf, FileContent content) {
  const auto found =
      std::find_if(kFormatTable.begin(), kFormatTable.end(), [&](const Format& format) {
        return !key.empty() && wordOf(format, content) == key && purposeOf(content).fits(format);
      });
  return found == kFormatTable.end() ? nullptr : &*found;
}

[[noreturn]] void failToFind(const std::filesystem::path& file, const std::string& problem,
                             FileContent content, const std::string& known) {
  throw Error(ErrorCode::FileUnsupported, file.string() + ": " + problem + " is no format of " +
                                              purposeOf(content).what + ". Formats: " + known +
                                              ".");
}

/// Extensions of meshes that meshio converts.
constexpr std::array<std::string_view, 10> kReadByMeshio = {
    ".avs", ".bdf", ".f3grid", ".fem", ".mdpa", ".med", ".nas", ".su2", ".xdmf", ".xmf"};

/// Advice for a file that holds something other than the requested content.
std::string adviceOn(const std::string& extension, FileContent content) {
  const Format* const surface = formatWith(extension, extensionOf, FileContent::Triangles);
  if (surface != nullptr && surface->triangles.isIn == nullptr) {
    return ' ' + extension +
           " files hold surfaces: `hexhex mesh` fills them with tets and makes hexahedra of these.";
  }
  if (std::find(kReadByMeshio.begin(), kReadByMeshio.end(), extension) != kReadByMeshio.end()) {
    return " meshio converts " + extension +
           " files from and to .vtu: `pip install meshio[all]`, then `meshio convert FROM TO`.";
  }
  if (extension == ".fra") {
    return " .fra files hold frame fields, not maps: `hexhex map` makes a map of the tets alone.";
  }
  const bool tetsOnly = (content == FileContent::Map || content == FileContent::MapOrHexMesh) &&
                        formatWith(extension, extensionOf, FileContent::Tets) != nullptr;
  if (!tetsOnly) return {};
  return " Tets without a map: `hexhex mesh` makes hexahedra of them, or give a second mesh with "
         "their parameters (--tets, --polycube).";
}

[[noreturn]] void failToExtend(const std::filesystem::path& file, const std::string& extension,
                               FileContent content) {
  const std::string named = "the extension \"" + extension + '"';
  if (content == FileContent::Parts) failToFind(file, named, content, listed(content, nameOf));
  if (content > FileContent::Parts) failToFind(file, named, content, listed(content, extensionOf));
  std::error_code unknown;
  const std::string problem =
      extension.empty()
          ? (std::filesystem::is_directory(file, unknown) ? "it is a folder"
                                                          : "the file name has no extension")
          : named + " is no format of " + purposeOf(content).what;
  throw Error(ErrorCode::FileUnsupported,
              file.string() + ": " + problem + ". Maps: " + listed(FileContent::Map, extensionOf) +
                  "; hexahedral meshes: " + listed(FileContent::HexMesh, extensionOf) + "." +
                  adviceOn(extension, content));
}

}  // namespace

const Format& findFormat(const std::filesystem::path& file, std::string_view name,
                         FileContent content) {
  const std::string_view usual = usualName(file, name, content);
  const std::string extension = contentExtension(file);
  const Format* const format = usual.empty() ? formatWith(extension, extensionOf, content)
                                             : formatWith(usual, nameOf, content);
  if (format == nullptr && !usual.empty()) {
    failToFind(file, concat('"', usual, '"'), content, listed(content, nameOf));
  }
  if (format == nullptr) failToExtend(file, extension, content);
  return *format;
}

bool holdsSurface(const std::filesystem::path& file, Context& context) {
  const std::string extension = contentExtension(file);
  const Format* const format = formatWith(extension, extensionOf, FileContent::Triangles);
  return format != nullptr &&
         (format->triangles.isIn == nullptr || format->triangles.isIn(openInput(file, context)));
}

std::string streamingFormats() {
  return listed([](const Format& format) { return format.pieces.openSink != nullptr; }, nameOf);
}

std::string formatsOfOthers() {
  return listed([](const Format& format) { return format.others; }, extensionOf);
}

std::string teamFormats() {
  return listed(
      [](const Format& format) {
        return purposeOf(FileContent::Parts).fits(format) && format.parts.byTeams;
      },
      nameOf);
}

}  // namespace hexhex::io

namespace hexhex {

std::span<const FileFormat> fileFormats() {
  static const std::vector<FileFormat> list = [] {
    std::vector<FileFormat> result;
    for (const io::Format& format : io::kFormatTable) {
      const FileFormat row = {format.label.name,
                              format.label.extension,
                              format.label.description,
                              format.maps.read != nullptr,
                              format.maps.write != nullptr,
                              format.readTets != nullptr,
                              format.meshes.read != nullptr,
                              io::writesMeshes(format),
                              format.pieces.openSink != nullptr,
                              format.compresses && io::hasZlib(),
                              format.triangles.read != nullptr};
      // Skips formats that this build lacks, and those for parts, arcs or patches only.
      if (io::holdsMaps(format) || row.readsHexMeshes || row.writesHexMeshes || row.readsSurfaces ||
          row.readsTets) {
        result.push_back(row);
      }
    }
    return result;
  }();
  return list;
}

std::span<const PartFormat> partFormats() noexcept {
  constexpr auto kCount = static_cast<std::size_t>(
      std::count_if(io::kFormatTable.begin(), io::kFormatTable.end(), io::writesParts));
  static constexpr std::array<PartFormat, kCount> kList = [] {
    std::array<PartFormat, kCount> list{};
    std::size_t i = 0;
    for (const io::Format& format : io::kFormatTable) {
      if (!io::writesParts(format)) continue;
      list[i++] = {format.label.name, format.label.extension, format.parts.description,
                   format.parts.byTeams};
    }
    return list;
  }();
  return kList;
}

std::span<const SolverFormat> solverFormats() noexcept {
  // MSH 2.2 text for readers that support neither newer versions nor binary files.
  static constexpr std::array kSolvers = {
      SolverFormat{"abaqus", "Abaqus", "inp", ".inp", "inp"},
      SolverFormat{"calculix", "CalculiX", "inp", ".inp", "inp"},
      SolverFormat{"code-aster", "Code_Aster", "msh22-ascii", ".msh"},
      SolverFormat{"dealii", "deal.II", "msh22-ascii", ".msh"},
      SolverFormat{"dolfinx", "DOLFINx", "msh", ".msh", "msh"},
      SolverFormat{"dune", "DUNE", "msh22-ascii", ".msh"},
      SolverFormat{"elmer", "ElmerGrid", "msh22-ascii", ".msh", "msh"},
      SolverFormat{"febio", "FEBio Studio", "inp", ".inp", "inp"},
      SolverFormat{"getfem", "GetFEM", "msh22-ascii", ".msh"},
      SolverFormat{"mfem", "MFEM", "mfem", ".mesh", "mfem"},
      SolverFormat{"moose", "MOOSE", "exodus-e", ".e", "exodus-e"},
      SolverFormat{"ngsolve", "NGSolve", "msh22-ascii", ".msh"},
      SolverFormat{"openfoam", "OpenFOAM", "openfoam", ".foam"},
      SolverFormat{"scikit-fem", "scikit-fem", "msh", ".msh", "msh"},
  };
  return kSolvers;
}

const SolverFormat* findSolver(std::string_view name) noexcept {
  const auto solvers = solverFormats();
  const auto found = std::find_if(solvers.begin(), solvers.end(),
                                  [name](const SolverFormat& each) { return each.name == name; });
  return found == solvers.end() ? nullptr : &*found;
}

}  // namespace hexhex
