// The table of formats for meshes in parts.
#include <algorithm>
#include <array>
#include <string>

#include <hexhex/error.hpp>

#include <io/core/hdf5_library.hpp>
#include <io/core/text_scanner.hpp>
#include <io/parts/file_set.hpp>
#include <io/parts/parts.hpp>

namespace hexhex::io {
namespace {

#if defined(HEXHEX_HAS_HDF5)
constexpr OpenPartSink* kOpenVtkHdf = openVtkHdfPartSink;
constexpr OpenPartSink* kOpenCgns = openCgnsPartSink;
#else
constexpr OpenPartSink* kOpenVtkHdf = nullptr;
constexpr OpenPartSink* kOpenCgns = nullptr;
#endif

constexpr std::array kPartFormats = {
    PartFormat{"pvtu", ".pvtu", "VTK XML: NAME.pvtu, and pieces in the folder NAME", true},
    PartFormat{"vtkhdf", ".vtkhdf", "VTKHDF: one file", true},
    PartFormat{"msh", ".msh", "Gmsh 4.1, binary: one file with partitioned entities", true},
    PartFormat{"msh-split", "", "Gmsh 4.1, binary: NAME_K.msh, K from 1 on", true},
    PartFormat{"openfoam", ".foam", "OpenFOAM: processorK/constant/polyMesh beside NAME.foam",
               true},
    PartFormat{"exodus-e", ".e", "Exodus with Nemesis maps: NAME.e.N.K", true},
    PartFormat{"exodus", ".exo", "Exodus with Nemesis maps: NAME.exo.N.K", true},
    PartFormat{"mfem", "", "MFEM parallel mesh v1.2: NAME.000000 ...", true},
    PartFormat{"cgns", ".cgns", "CGNS: one file with a zone for each part"},
};
constexpr std::array<OpenPartSink*, kPartFormats.size()> kOpen = {
    openPvtuSink,          kOpenVtkHdf,          openGmshPartSink,
    openSplitGmshPartSink, openOpenFoamPartSink, openExodusPartSink,
    openExodusPartSink,    openMfemPartSink,     kOpenCgns};

/// @throws Error FileUnsupported
std::size_t findFormat(const std::filesystem::path& file, std::string_view name) {
  const std::string extension = lowerCaseExtension(file);
  std::string known;
  for (std::size_t i = 0; i < kPartFormats.size(); ++i) {
    const PartFormat& format = kPartFormats[i];
    if (name.empty() ? format.extension == extension && !extension.empty() : format.name == name) {
      return i;
    }
    known += (known.empty() ? "" : ", ") + std::string(format.name);
  }
  const std::string what =
      name.empty() ? "the extension \"" + extension + '"' : '"' + std::string(name) + '"';
  throw Error(
      ErrorCode::FileUnsupported,
      file.string() + ": " + what + " is no format of meshes in parts. Formats: " + known + '.');
}

void requireForTeams(const std::filesystem::path& file, std::size_t format) {
  if (kPartFormats[format].byTeams) return;
  std::string known;
  for (const PartFormat& each : kPartFormats) {
    if (each.byTeams) known += (known.empty() ? "" : ", ") + std::string(each.name);
  }
  throw Error(ErrorCode::FileUnsupported, file.string() + ": several processes cannot write \"" +
                                              std::string(kPartFormats[format].name) +
                                              "\" together. They can write: " + known + '.');
}

/// Files of other names, or in other formats, are no set that can be read.
void requireSameOutput(ProcessTeam& team, const std::filesystem::path& file,
                       const WriteOptions& options) {
  team.requireSame(file.string(), "name of the file to write");
  team.requireSame(std::string(options.format), "format to write");
  team.requireSame(std::to_string(options.patchAngle), "patch angle");
}

bool isOverHdf5(std::size_t format) {
  return kPartFormats[format].name == "vtkhdf" || kPartFormats[format].name == "cgns";
}

}  // namespace

}  // namespace hexhex::io

namespace hexhex {

std::unique_ptr<PartSink> openPartSink(const std::filesystem::path& file,
                                       const WriteOptions& options, Context& context,
                                       ProcessTeam* team) {
  const std::size_t format = io::findFormat(file, options.format);
  if (team != nullptr) {
    io::requireForTeams(file, format);
    io::requireSameOutput(*team, file, options);
  }
  if (io::isOverHdf5(format) && io::isFirst(team)) io::requireHdf5(file);
  return io::kOpen[format](file, options, context, team);
}

void requirePartFormat(const std::filesystem::path& file, const WriteOptions& options,
                       bool byTeam) {
  const std::size_t format = io::findFormat(file, options.format);
  if (byTeam) io::requireForTeams(file, format);
}

std::span<const PartFormat> partFormats() noexcept { return io::kPartFormats; }

}  // namespace hexhex
