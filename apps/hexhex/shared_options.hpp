// Options that several subcommands have, and checks with messages that people understand.
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

/// Accepts whole numbers from `minimum` that fit in an int.
[[nodiscard]] CLI::Validator wholeNumberFrom(int minimum);

/// Where a subcommand has its map from: a file, two meshes, or a mesh and labels.
struct MapSource {
  std::string file;
  std::string tets;
  std::string polycube;
  std::string flags;    ///< labels of the boundary of `tets`, instead of `polycube`
  std::string surface;  ///< that the labels belong to, or empty
  std::string flagsArray = "flags";
  std::string mapArray = "igm";
  std::string format;
  bool keepWalls = false;

  [[nodiscard]] bool isPair() const noexcept { return !tets.empty(); }
  /// "sphere.hexex", "tets.mesh and polycube.mesh", "tets.mesh and labels.txt"
  [[nodiscard]] std::string description() const;
  /// All files that are read.
  [[nodiscard]] std::vector<std::filesystem::path> files() const;
  [[nodiscard]] ReadOptions options() const;
};

/// ".mesh, .vtu or .vtk": the extensions of the formats that can do this.
[[nodiscard]] std::string extensionsThat(bool FileFormat::*can);

/// Adds --input-format.
void addInputFormat(CLI::App& parser, MapSource& source);

/// Adds --keep-walls; addMapSource() sees to it that --tets is not given beside it.
void addKeepWalls(CLI::App& parser, MapSource& source);

/// For arguments that name a map to read.
[[nodiscard]] std::string mapDescription();

/// Adds an argument, and --tets, --polycube, --flags, --surface, --flags-array and --map-array; a
/// map has to be given in one of these ways.
void addMapSource(CLI::App& parser, MapSource& source, const std::string& argument = "MAP",
                  const std::string& description = mapDescription());
/// For subcommands with another argument behind MAP: where two meshes are given instead, the first
/// argument is that other one.
/// @param argument, otherArgument  their names
void addMapSourceBefore(CLI::App& parser, MapSource& source, const std::string& argument,
                        const std::string& description, std::string& other,
                        const std::string& otherArgument, const std::string& otherDescription);

/// @throws Error  as readMap(), readMapPair(), readFlags() and mapFromFlags()
[[nodiscard]] TetMap readMap(const MapSource& source, Context& context);

/// Adds -o for the map or the mesh that a subcommand makes.
void addMapOutput(CLI::App& parser, std::string& file);
void addMeshOutput(CLI::App& parser, std::string& file);

/// How a subcommand writes its result.
struct OutputChoice {
  std::string format;
  std::string solver;  ///< that chooses the format, or empty
  std::string mapArray = "igm";
  bool compress = false;

  [[nodiscard]] WriteOptions options() const;
  /// @param order  0: not known yet
  /// @throws Error InvalidArgument, FileUnsupported if cells of higher order are not written so
  void requireForCurved(const std::string& output, int order = 0) const;
};

/// Accepts names of formats.
[[nodiscard]] CLI::Validator formatName();

/// Adds --format and --compress.
/// @return the former
CLI::Option* addOutputChoice(CLI::App& parser, OutputChoice& choice);
/// Adds these, and --for.
/// @param output  gets the extension that the solver expects, if it has none
void addMeshChoice(CLI::App& parser, OutputChoice& choice, std::string& output);

/// Adds --hexes-only.
void addHexesOnly(CLI::App& parser, bool& hexesOnly);
/// Names the cells that were left out for it, if there are any.
void warnOfOtherCells(const std::vector<CellCount>& counts);

/// What --patch-angle says.
struct PatchAngle {
  double degrees = WriteOptions{}.patchAngle;
  bool isGiven = false;

  /// Warns of an angle that was given, but changes nothing in a file.
  /// @param patches  of the mesh that was written
  void warnIfUseless(std::span<const NamedPatch> patches, const std::string& file,
                     const WriteOptions& options) const;
  /// The same of a mesh whose patches nobody needs else.
  void warnIfUseless(const HexMesh& mesh, const std::string& file, const WriteOptions& options,
                     Context& context) const;
  /// The same where there are no patches at all. @param why  "maps have no boundary quads"
  void warnIfGiven(std::string_view why) const;
};
/// Adds it, from 0 to 180 degrees.
CLI::Option* addPatchAngle(CLI::App& parser, PatchAngle& angle);
/// Adds --report. @param description  of what is in it
void addReport(CLI::App& parser, std::string& file, const std::string& description);
/// Adds --view. @param description  of what the page shows
void addPage(CLI::App& parser, std::string& page, const std::string& description);
/// Adds --json.
void addJson(CLI::App& parser, bool& json);
void addQuiet(CLI::App& parser, bool& quiet,
              const std::string& description = "Print nothing but errors");

void addScale(CLI::App& parser, int& scale, const std::string& description);
/// Of cells of higher order.
/// @param order  the option that says which
void addCurvedNodes(CLI::App& parser, CurvedNodes& nodes, CLI::Option* order);
void addTolerance(CLI::App& parser, double& tolerance);
void addRound(CLI::App& parser, bool& round);

}  // namespace hexhex::command
