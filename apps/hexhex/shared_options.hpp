// Options shared by several subcommands, with readable error messages.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <hexhex/context.hpp>
#include <hexhex/extract.hpp>
#include <hexhex/io.hpp>
#include <hexhex/patches.hpp>
#include <hexhex/types.hpp>

namespace hexhex::command {

/// Accepts integers from `minimum` on that fit in an int.
[[nodiscard]] CLI::Validator wholeNumberFrom(int minimum);

/// The source of a map: a file, a pair of meshes, or a mesh and labels.
struct MapSource {
  std::string file;
  std::string tets;
  std::string polycube;
  std::string flags;    ///< labels of the boundary of `tets`, instead of `polycube`
  std::string surface;  ///< surface of the labels, or empty
  std::string flagsArray = "flags";
  std::string mapArray = "igm";
  std::string format;
  bool keepWalls = false;

  [[nodiscard]] bool isPair() const noexcept { return !tets.empty(); }
  /// "sphere.hexex", "tets.mesh and polycube.mesh", "tets.mesh and labels.txt"
  [[nodiscard]] std::string description() const;
  /// All files to read.
  [[nodiscard]] std::vector<std::filesystem::path> files() const;
  [[nodiscard]] ReadOptions options() const;
};

/// ".mesh, .vtu or .vtk": the extensions of formats with a capability.
[[nodiscard]] std::string extensionsThat(bool FileFormat::*can);

/// Adds --input-format.
void addInputFormat(CLI::App& parser, MapSource& source);

/// Adds --keep-walls; addMapSource() makes it incompatible with --tets.
void addKeepWalls(CLI::App& parser, MapSource& source);

/// The description of arguments that name a map to read.
[[nodiscard]] std::string mapDescription();

/// Adds an argument, and --tets, --polycube, --flags, --surface, --flags-array and --map-array; the
/// map must be given in one of these ways.
void addMapSource(CLI::App& parser, MapSource& source, const std::string& argument = "MAP",
                  const std::string& description = mapDescription());
/// For subcommands with another argument after MAP: if a pair of meshes is given, the first
/// argument is that other one.
/// @param argument, otherArgument  their names
void addMapSourceBefore(CLI::App& parser, MapSource& source, const std::string& argument,
                        const std::string& description, std::string& other,
                        const std::string& otherArgument, const std::string& otherDescription);

/// @throws Error  as readMap(), readMapPair(), readFlags() and mapFromFlags()
[[nodiscard]] TetMap readMap(const MapSource& source, Context& context);

/// Add -o for the resulting map or mesh.
void addMapOutput(CLI::App& parser, std::string& file);
void addMeshOutput(CLI::App& parser, std::string& file);

/// How a subcommand writes its result.
struct OutputChoice {
  std::string format;
  std::string solver;  ///< determines the format, unless empty
  std::string mapArray = "igm";
  std::string elementType;
  std::string compress;  ///< how; empty: not at all

  [[nodiscard]] WriteOptions options() const;
  /// @param order  0: not known yet
  /// @throws Error InvalidArgument, FileUnsupported if the format cannot hold cells of higher order
  void requireForCurved(const std::string& output, int order = 0) const;
};

/// Accepts names of formats.
[[nodiscard]] CLI::Validator formatName();

/// Adds --format and --compress.
/// @return the former
CLI::Option* addOutputChoice(CLI::App& parser, OutputChoice& choice);
/// Adds these, --element-type and --for.
/// @param output  gets the extension that the solver expects, if it has none
void addMeshChoice(CLI::App& parser, OutputChoice& choice, std::string& output);

/// Adds --hexes-only.
void addHexesOnly(CLI::App& parser, bool& hexesOnly);
/// Warns of cells that were skipped because of it, if there are any.
void warnOfOtherCells(const std::vector<CellCount>& counts);

/// The option --patch-angle.
struct PatchAngle {
  double degrees = WriteOptions{}.patchAngle;
  bool isGiven = false;

  /// Warns if the angle was given but has no effect on the file.
  /// @param patches  of the mesh that was written
  void warnIfUseless(std::span<const NamedPatch> patches, const std::string& file,
                     const WriteOptions& options) const;
  /// The same if patches are not needed otherwise; computes them.
  void warnIfUseless(const HexMesh& mesh, const std::string& file, const WriteOptions& options,
                     Context& context) const;
  /// The same if there are no patches at all. @param why  "maps have no boundary quads"
  void warnIfGiven(std::string_view why) const;
};
/// Adds --patch-angle, from 0 to 180 degrees.
CLI::Option* addPatchAngle(CLI::App& parser, PatchAngle& angle);
/// Adds --report. @param description  of its content
void addReport(CLI::App& parser, std::string& file, const std::string& description);
/// Adds --view. @param description  of the content of the page
void addPage(CLI::App& parser, std::string& page, const std::string& description);
/// Adds --json.
void addJson(CLI::App& parser, bool& json);
void addQuiet(CLI::App& parser, bool& quiet,
              const std::string& description = "Print nothing but errors");

void addScale(CLI::App& parser, int& scale, const std::string& description);
/// For cells of higher order.
/// @param order  the option for the order
void addCurvedNodes(CLI::App& parser, CurvedNodes& nodes, CLI::Option* order);
void addTolerance(CLI::App& parser, double& tolerance);
void addRound(CLI::App& parser, bool& round);

}  // namespace hexhex::command
