// `hexhex convert`: converts a map or a hexahedral mesh to another format.
#include <filesystem>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include <fmt/core.h>

#include <hexhex/curved.hpp>
#include <hexhex/error.hpp>
#include <hexhex/io.hpp>
#include <hexhex/structure.hpp>

#include "command.hpp"
#include "expected_words.hpp"
#include "long_run.hpp"
#include "output.hpp"
#include "patch_names.hpp"
#include "shared_options.hpp"

namespace hexhex::command {
namespace {

struct ConvertArguments {
  MapSource input;
  std::string output;
  OutputChoice choice;
  RunOptions run;
  PatchAngle patchAngle;
  PatchNames names;
  bool stream = false;
  bool reorient = false;
  bool hexesOnly = false;
};

/// Refuses a format that supports neither maps nor hex meshes before anything is read.
void requireAnyFormat(const ConvertArguments& arguments) {
  try {
    requireHexMeshFormat(arguments.output, arguments.choice.options());
  } catch (const Error& error) {
    if (error.code() != ErrorCode::FileUnsupported) throw;
    requireMapFormat(arguments.output, arguments.choice.options());
  }
}

/// Calls require(), and adds the kind of the input to its error.
template <class F>
void requireFor(const ConvertArguments& arguments, const char* content, const F& require) {
  try {
    require(arguments.output, arguments.choice.options());
  } catch (const Error& error) {
    if (error.code() != ErrorCode::FileUnsupported) throw;
    throw Error(error.code(), fmt::format("{} holds {}, which this output cannot. {}",
                                          arguments.input.description(), content, error.what()));
  }
}

/// The options for reading.
ReadOptions readingOf(const ConvertArguments& arguments, std::vector<CellCount>& counts) {
  ReadOptions options = arguments.input.options();
  options.hexesOnly = arguments.hexesOnly;
  options.cellCounts = &counts;
  return options;
}

std::variant<TetMap, HexMesh> readInput(const ConvertArguments& arguments,
                                        std::vector<CellCount>& counts, OtherCells& others,
                                        Context& context) {
  if (arguments.input.isPair()) return readMap(arguments.input, context);
  ReadOptions options = readingOf(arguments, counts);
  options.others = &others;
  return readMapOrHexMesh(arguments.input.file, options, context);
}

/// Whether the input has cells of higher order. Pipes can be read only once, so they are not
/// inspected.
bool isCurved(const ConvertArguments& arguments, Context& context) {
  const MapSource& input = arguments.input;
  std::error_code unknown;
  return !input.isPair() && input.options().format.empty() &&
         std::filesystem::is_regular_file(input.file, unknown) &&
         holdsLagrangeCells(input.file, context);
}

std::string convertCurved(const ConvertArguments& arguments, Context& context) {
  requireFor(arguments, "cells of higher order",
             [](const std::filesystem::path& file, const WriteOptions& options) {
               requireLagrangeFormat(file, options.format);
             });
  refuseIf(arguments.reorient,
           arguments.input.description() +
               " holds cells of higher order, but --reorient is for straight cells.");
  WriteOptions writing = arguments.choice.options();
  writing.patchAngle = arguments.patchAngle.degrees;
  LagrangeMesh mesh = readLagrangeMesh(arguments.input.file, context);
  arguments.names.apply(mesh, writing.patchAngle, context);
  writeLagrangeMesh(mesh, arguments.output, writing, context);
  arguments.names.warnOfAngle(arguments.patchAngle, mesh, arguments.output, writing, context);
  return fmt::format("a mesh of {} of order {}, {} nodes", counted(mesh.cellCount(), "cell"),
                     mesh.order, mesh.points.size());
}

/// Converts the input and returns a description of what was converted.
std::string convertWhole(const ConvertArguments& arguments, std::vector<CellCount>& counts,
                         Context& context) {
  if (isCurved(arguments, context)) return convertCurved(arguments, context);
  OtherCells others;
  auto content = readInput(arguments, counts, others, context);
  WriteOptions writing = arguments.choice.options();
  writing.others = &others;
  writing.mapArray = arguments.input.mapArray;
  writing.patchAngle = arguments.patchAngle.degrees;
  if (const auto* const map = std::get_if<TetMap>(&content)) {
    requireFor(arguments, "a map", requireMapFormat);
    refuseIf(arguments.reorient, arguments.input.description() +
                                     " holds a map, but --reorient is for hexahedral meshes.");
    refuseIf(arguments.names.isGiven(),
             arguments.input.description() +
                 " holds a map, but --names and --split-tags are for hexahedral meshes.");
    writeMap(*map, arguments.output, writing, context);
    arguments.patchAngle.warnIfGiven("a map has no quads");
    return fmt::format("a map of {}, {}", counted(map->tets.size(), "tet"),
                       counted(map->points.size(), "point"));
  }
  auto& mesh = std::get<HexMesh>(content);
  refuseIf(arguments.names.isGiven() && others.count() > 0,
           arguments.input.description() +
               " holds other cells beside hexahedra, but --names and --split-tags are for "
               "boundaries of hexahedra.");
  requireFor(arguments, "a hexahedral mesh",
             [](const std::filesystem::path& file, const WriteOptions& options) {
               requireHexMeshFormat(file, options);
             });
  const std::string turned =
      arguments.reorient ? fmt::format(", {} of them reoriented", reorient(mesh, context)) : "";
  arguments.names.apply(mesh, writing.patchAngle, context);
  writeHexMesh(mesh, arguments.output, writing, context);
  arguments.names.warnOfAngle(arguments.patchAngle, mesh, arguments.output, writing, context);
  const std::string beside =
      others.count() > 0 ? fmt::format(" and {} of other types", others.count()) : "";
  return fmt::format("a mesh of {}{}{}, {} vertices", counted(mesh.cells.size(), "cell"), turned,
                     beside, mesh.points.size());
}

std::string convertInPieces(const ConvertArguments& arguments, std::vector<CellCount>& counts,
                            Context& context) {
  const std::unique_ptr<MeshSink> sink =
      openMeshSink(arguments.output, arguments.choice.options(), context);
  readHexMeshTo(*sink, arguments.input.file, readingOf(arguments, counts), context);
  arguments.patchAngle.warnIfGiven("--stream writes no quads");
  return "a mesh, piece by piece";
}

int run(const ConvertArguments& arguments) {
  std::vector<std::filesystem::path> inputs = arguments.input.files();
  inputs.emplace_back(arguments.names.file());
  requireAllDifferent(inputs, {arguments.output});
  refuseIf(arguments.stream && arguments.input.isPair(),
           "--stream converts hexahedral meshes, but --tets and --polycube are a map.");
  refuseIf(arguments.stream && arguments.names.isGiven(),
           "--names and --split-tags need the whole mesh in memory. Leave them out, or --stream.");
  refuseIf(arguments.stream && arguments.reorient,
           "--reorient compares neighbouring cells, which --stream does not keep in memory. "
           "Leave out one of them.");
  requireAnyFormat(arguments);
  const std::vector<WorkStep> whole = {{"readMapPair", 1},       {"readMapOrHexMesh", 1},
                                       {"findCellFaults", 0.3},  {"readLagrangeMesh", 1},
                                       {"writeLagrangeMesh", 1}, {"writeMap", 1},
                                       {"writeHexMesh", 1}};
  LongRun longRun(arguments.run,
                  arguments.stream ? std::vector<WorkStep>{{"readHexMeshTo", 1}} : whole);
  Context& context = longRun.context();
  requireWritable(arguments.output);
  std::vector<CellCount> counts;
  const std::string what =
      (arguments.stream ? convertInPieces : convertWhole)(arguments, counts, context);
  longRun.finish();
  if (arguments.hexesOnly) warnOfOtherCells(counts);
  if (arguments.run.quiet) return kSuccess;
  std::error_code unknown;  // a pipe has no size
  const std::uintmax_t bytes = std::filesystem::file_size(arguments.output, unknown);
  printFiles(arguments.input.description(), arguments.output,
             ": " + what + (unknown ? "" : ", " + bytesAsText(bytes)));
  return kSuccess;
}

}  // namespace

Command addConvert(CLI::App& app) {
  const auto arguments = std::make_shared<ConvertArguments>();
  CLI::App* const parser =
      app.add_subcommand("convert", "Write a map or a hexahedral mesh in another format");
  addMapSourceBefore(*parser, arguments->input, "INPUT", "The map or the hexahedral mesh",
                     arguments->output, "OUTPUT", "The file to write");
  addKeepWalls(*parser, arguments->input);
  addMeshChoice(*parser, arguments->choice, arguments->output);
  addInputFormat(*parser, arguments->input);
  addHexesOnly(*parser, arguments->hexesOnly);
  addPatchAngle(*parser, arguments->patchAngle);
  addPatchNames(*parser, arguments->names);
  parser->add_flag("--stream", arguments->stream,
                   "Read and write a mesh piece by piece, for meshes larger\n"
                   "than the memory, from .vtu to " +
                       extensionsThat(&FileFormat::streams) +
                       ";\nwithout boundary quads and quality");
  parser->add_flag("--reorient", arguments->reorient,
                   "Reorient cells that list their corners mirrored, so that\n"
                   "neighbours agree and the volume is positive");
  addRunOptions(*parser, arguments->run);
  parser->footer(
      "A map is written as a map, and a hexahedral mesh as a hexahedral mesh, with "
      "its\ntetrahedra, "
      "pyramids and prisms if the format holds them. `hexhex formats`\n"
      "lists the formats.\n\nExamples:\n"
      "  hexhex convert sphere.vtu sphere.msh\n"
      "  hexhex convert --tets ball.mesh --polycube cube.mesh ball.hexex");
  return {parser, [arguments] { return run(*arguments); }};
}

}  // namespace hexhex::command
