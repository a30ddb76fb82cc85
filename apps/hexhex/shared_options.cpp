#include "shared_options.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <hexhex/curved.hpp>
#include <hexhex/error.hpp>
#include <hexhex/parts.hpp>
#include <hexhex/quantize.hpp>
#include <hexhex/shape.hpp>

#include "expected_words.hpp"
#include "output.hpp"

namespace hexhex::command {

CLI::Validator wholeNumberFrom(int minimum) {
  const auto check = [minimum](const std::string& text) -> std::string {
    int value = 0;
    const char* const end = text.data() + text.size();
    const auto result = std::from_chars(text.data(), end, value);
    if (result.ec == std::errc{} && result.ptr == end && value >= minimum) return {};
    return fmt::format("expected a whole number from {}, found \"{}\"", minimum, text);
  };
  return CLI::Validator(check, fmt::format("from {}", minimum));
}

std::string MapSource::description() const {
  return isPair() ? tets + " and " + (flags.empty() ? polycube : flags) : file;
}

namespace {
/// Used in place of a file with labels.
constexpr const char* kAutomaticFlags = "auto";
}  // namespace

std::vector<std::filesystem::path> MapSource::files() const {
  if (!isPair()) return {file};
  std::vector<std::filesystem::path> all = {tets};
  for (const std::string* const each : {&polycube, &flags, &surface}) {
    if (!each->empty() && *each != kAutomaticFlags) all.emplace_back(*each);
  }
  return all;
}

ReadOptions MapSource::options() const {
  ReadOptions options;
  options.format = format;
  options.mapArray = mapArray;
  options.keepWalls = keepWalls;
  return options;
}

std::string extensionsThat(bool FileFormat::*can) {
  std::vector<std::string_view> list;
  for (const FileFormat& format : fileFormats()) {
    const bool isNew = list.empty() || list.back() != format.extension;
    if (format.*can && isNew && !format.extension.empty()) list.push_back(format.extension);
  }
  std::string text;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const char* const before = i + 1 < list.size() ? ", " : " or ";
    text += (i == 0 ? "" : before) + std::string(list[i]);
  }
  return text;
}

std::string mapDescription() { return "The map, " + extensionsThat(&FileFormat::readsMaps); }

void addKeepWalls(CLI::App& parser, MapSource& source) {
  parser.add_flag("--keep-walls", source.keepWalls,
                  "Walls of a motorcycle complex that a .hexex file lists\n"
                  "become features with the tag 2: faces between blocks");
}

namespace {

void addMapOptions(CLI::App& parser, MapSource& source) {
  CLI::Option* const tets =
      addValue(parser, "--tets", source.tets, "FILE",
               "Instead of MAP: a tet mesh,\n" + extensionsThat(&FileFormat::readsTets) + " ...");
  CLI::Option* const polycube = addValue(parser, "--polycube", source.polycube, "FILE",
                                         "... and the same tets with the parameters as vertices");
  CLI::Option* const flags =
      addValue(parser, "--flags", source.flags, "FILE",
               "... or labels 0 to 5 (+x -x +y -y +z -z) of its boundary,\n"
               "from which a polycube's seamless map is made. Text with four\n"
               "per tet, or one per triangle of --surface; or .vtu, .vtk\n"
               "with triangles (docs/user/quantize.md); auto: finds labels");
  polycube->needs(tets)->excludes(flags);
  flags->needs(tets);
  addValue(parser, "--surface", source.surface, "FILE",
           "The .obj file whose triangles the labels belong to")
      ->needs(flags);
  addValue(parser, "--flags-array", source.flagsArray, "NAME [flags]",
           "The cell array of .vtu and .vtk files that holds the labels")
      ->needs(flags);
  addValue(parser, "--map-array", source.mapArray, "NAME [igm]",
           "The array of .vtu and .vtk files that holds the map:\n"
           "12 numbers per cell, or 3 per point");
}

void requireMesh(const std::filesystem::path& file, const WriteOptions& options) {
  requireHexMeshFormat(file, options);
}

/// Whether a name is an alias of a format.
bool isOtherName(const std::string& name) {
  for (const auto require : {requireMapFormat, requireMesh}) {
    try {
      require("", WriteOptions{.format = name});
      return true;
    } catch (const Error&) {
      // not an alias
    }
  }
  return false;
}

/// Requires either one file or a pair.
void requireOneSource(const MapSource& source, const std::string& argument) {
  if (source.file.empty() && !source.isPair()) throw CLI::RequiredError(argument);
  if (source.isPair() && source.polycube.empty() && source.flags.empty()) {
    throw CLI::ValidationError("--tets", "requires --polycube or --flags");
  }
  // Not by excludes("--tets"): CLI11 looks up names in noexcept functions, which terminate when
  // memory runs out.
  if (source.isPair() && source.keepWalls) throw CLI::ExcludesError("--keep-walls", "--tets");
  if (source.file.empty() || !source.isPair()) return;
  throw CLI::ValidationError(argument, "cannot be combined with --tets");
}

}  // namespace

void addMapSource(CLI::App& parser, MapSource& source, const std::string& argument,
                  const std::string& description) {
  addValue(parser, argument, source.file, "FILE", description);
  addMapOptions(parser, source);
  parser.parse_complete_callback([&source, argument] { requireOneSource(source, argument); });
}

void addMapSourceBefore(CLI::App& parser, MapSource& source, const std::string& argument,
                        const std::string& description, std::string& other,
                        const std::string& otherArgument, const std::string& otherDescription) {
  addValue(parser, argument, source.file, "FILE", description);
  addValue(parser, otherArgument, other, "FILE REQUIRED", otherDescription);
  addMapOptions(parser, source);
  parser.parse_complete_callback([&source, &other, argument, otherArgument] {
    if (source.isPair() && other.empty()) std::swap(source.file, other);
    requireOneSource(source, argument);
    if (other.empty()) throw CLI::RequiredError(otherArgument);
  });
}

TetMap readMap(const MapSource& source, Context& context) {
  if (source.flags == kAutomaticFlags) {
    const TetMesh tets = readTetMesh(source.tets, {}, context);
    return mapFromTets(tets, {.method = ShapeMethod::Polycube}, context).map;
  }
  if (!source.flags.empty()) {
    const TetMesh tets = readTetMesh(source.tets, {}, context);
    const FlagsFile flags = {source.flags, source.surface, source.flagsArray};
    return mapFromFlags(tets, readFlags(flags, tets, context), context);
  }
  if (source.isPair()) return readMapPair(source.tets, source.polycube, context);
  return hexhex::readMap(source.file, source.options(), context);
}

namespace {

void addOutput(CLI::App& parser, std::string& file, const std::string& description) {
  addValue(parser, "-o,--output", file, "FILE REQUIRED", description)->required();
}

}  // namespace

void addMapOutput(CLI::App& parser, std::string& file) {
  addOutput(parser, file, "The map to write, " + extensionsThat(&FileFormat::writesMaps));
}

void addMeshOutput(CLI::App& parser, std::string& file) {
  addOutput(parser, file, "The mesh to write; `hexhex formats` lists the formats");
}

namespace {

constexpr const char* kLz4 = "lz4";

}  // namespace

WriteOptions OutputChoice::options() const {
  WriteOptions options;
  options.format = solver.empty() ? format : solver;
  if (!compress.empty()) {
    options.compress = compress == kLz4 ? Compression::Lz4 : Compression::Zlib;
  }
  options.mapArray = mapArray;
  options.elementType = elementType;
  return options;
}

void OutputChoice::requireForCurved(const std::string& output, int order) const {
  refuseIf(!compress.empty(),
           "Files of meshes of higher order are not compressed. Leave out --compress.");
  refuseIf(!elementType.empty(), "--element-type is of straight cells. Leave it out.");
  requireLagrangeFormat(output, options().format, order);
}

CLI::Validator formatName() {
  const auto check = [](const std::string& name) -> std::string {
    std::vector<std::string> names;
    for (const FileFormat& format : fileFormats()) names.emplace_back(format.name);
    for (const PartFormat& format : partFormats()) names.emplace_back(format.name);
    if (std::find(names.begin(), names.end(), name) != names.end() || isOtherName(name)) return {};
    return fmt::format("there is no format \"{}\"; `hexhex formats` lists them.{}", name,
                       suggestionFor(name, names));
  };
  return CLI::Validator(check, "");
}

void addInputFormat(CLI::App& parser, MapSource& source) {
  addValue(parser, "--input-format", source.format, "NAME",
           "Read this format, whatever the extension")
      ->check(formatName());
}

CLI::Option* addOutputChoice(CLI::App& parser, OutputChoice& choice) {
  CLI::Option* const format =
      addValue(parser, "--format", choice.format, "NAME",
               "Write this format, whatever the extension;\n`hexhex formats` lists them")
          ->check(formatName());
  parser
      .add_flag("--compress", choice.compress,
                "Compress a .vtu file, by zlib, or faster, to a larger\nfile, by LZ4")
      ->transform([](const std::string& how) { return how == "true" ? "zlib" : how; })
      ->check(oneOf({"zlib", kLz4}))
      ->option_text("[=zlib|lz4]");
  return format;
}

namespace {

std::vector<std::string> solverNames() {
  std::vector<std::string> names;
  for (const SolverFormat& each : solverFormats()) names.emplace_back(each.name);
  return names;
}

/// Requires the extension by which the solver recognizes its format.
void requireExtension(const SolverFormat& solver, std::string& output) {
  const std::filesystem::path file = output;
  std::error_code missing;
  // Pipes may have any name, and so may the folder of OpenFOAM's files.
  if (std::filesystem::is_other(file, missing) || file.filename() == "polyMesh") return;
  if (file.extension() == solver.extension) return;
  std::filesystem::path other = file;
  other.replace_extension(solver.extension);
  if (file.extension().empty()) {
    output = other.string();
    return;
  }
  throw CLI::ValidationError(
      "--for", fmt::format("{} reads {} files: write {} in place of {}.", solver.program,
                           solver.extension, other.string(), output));
}

}  // namespace

void addMeshChoice(CLI::App& parser, OutputChoice& choice, std::string& output) {
  // Looking up the option by name would make CLI11 terminate when memory runs out.
  CLI::Option* const format = addOutputChoice(parser, choice);
  addValue(parser, "--element-type", choice.elementType, "TYPE [C3D8]",
           "The type of elements in .inp files: C3D8, C3D8R or C3D8I");
  addValue(parser, "--for", choice.solver, "SOLVER",
           "Write what this solver reads (calculix, dealii, mfem, ...:\n"
           "`hexhex formats` lists them); gives FILE its extension")
      ->check(oneOf(solverNames()))
      ->excludes(format);
  parser.final_callback([&choice, &output] {
    if (!choice.solver.empty()) requireExtension(*findSolver(choice.solver), output);
  });
}

void addHexesOnly(CLI::App& parser, bool& hexesOnly) {
  parser.add_flag(
      "--hexes-only", hexesOnly,
      "Leave out cells of other types (tets, prisms, pyramids,\ncurved ones), which are "
      "otherwise an error; their vertices\nare kept");
}

void warnOfOtherCells(const std::vector<CellCount>& counts) {
  std::string others;
  for (const CellCount& each : counts) {
    if (each.name == "hexahedra") continue;
    others += fmt::format("{}{} ({})", others.empty() ? "" : ", ", each.name, each.count);
  }
  if (!others.empty()) printWarning("Left out because of --hexes-only: " + others + ".");
}

void PatchAngle::warnIfGiven(std::string_view why) const {
  if (isGiven) printWarning(fmt::format("--patch-angle does nothing here: {}.", why));
}

void PatchAngle::warnIfUseless(std::span<const NamedPatch> patches, const std::string& file,
                               const WriteOptions& options) const {
  const auto tagged = [](const NamedPatch& patch) { return patch.tag != 0; };
  if (std::any_of(patches.begin(), patches.end(), tagged)) {
    warnIfGiven("quads of the boundary are tagged, and tags define the groups");
  } else if (!writesPatches(file, options)) {
    warnIfGiven(file + " holds no groups of quads without tags; .msh, .inp and .exo do");
  } else if (degrees > 0 && patches.size() == 1) {
    warnIfGiven(fmt::format(
        "no edges at which the boundary turns by more than {:.6g} degrees divide it", degrees));
  }
}

void PatchAngle::warnIfUseless(const HexMesh& mesh, const std::string& file,
                               const WriteOptions& options, Context& context) const {
  if (isGiven) warnIfUseless(namedPatches(mesh, degrees, context), file, options);
}

CLI::Option* addPatchAngle(CLI::App& parser, PatchAngle& angle) {
  return parser
      .add_option_function<double>(
          "--patch-angle",
          [&angle](double degrees) {
            angle = {degrees, true};
          },
          "Where no faces are tagged, group boundary quads by\npatches that turn by at "
          "most this angle in degrees\nbetween neighbours; 0: one group")
      ->check(CLI::Range(0.0, 180.0))
      ->option_text("DEGREES [40]");
}

void addReport(CLI::App& parser, std::string& file, const std::string& description) {
  addValue(parser, "--report", file, "FILE", description + "; - = standard output");
}

void addPage(CLI::App& parser, std::string& page, const std::string& description) {
  addValue(parser, "--view", page, "FILE", description);
}

void addJson(CLI::App& parser, bool& json) {
  parser.add_flag("--json", json, "Print JSON instead of text");
}

void addQuiet(CLI::App& parser, bool& quiet, const std::string& description) {
  parser.add_flag("--quiet", quiet, description);
}

void addScale(CLI::App& parser, int& scale, const std::string& description) {
  addValue(parser, "--scale", scale, "INTEGER [1]", description)->check(wholeNumberFrom(1));
}

void addCurvedNodes(CLI::App& parser, CurvedNodes& nodes, CLI::Option* order) {
  addChoice<CurvedNodes>(parser, "--curved", nodes, "MODE [blended]",
                         {{"blended", CurvedNodes::Blended}, {"exact", CurvedNodes::Exact}},
                         "blended: nodes on the surface and on tagged edges and quads\n"
                         "are where the map puts them, others in between; cells are\n"
                         "positive wherever straight ones are, if need be off the\n"
                         "surface (reported). exact: all nodes are where the map puts\n"
                         "them, and cells may fold over")
      ->needs(order);
}

void addTolerance(CLI::App& parser, double& tolerance) {
  addValue(parser, "--tolerance", tolerance, "NUMBER [0.01]",
           "How far the map may be from meeting its integer\n"
           "conditions, in parameter units; below 0.25");
}

void addRound(CLI::App& parser, bool& round) {
  parser.add_flag("--round", round,
                  "Move boundary and singularities that are off integers by\n"
                  "less than 0.1 onto them, and repair what that flips");
}

}  // namespace hexhex::command
