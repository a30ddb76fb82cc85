#include "extract_arguments.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <fmt/core.h>

#include <hexhex/curved.hpp>
#include <hexhex/error.hpp>

#include "expected_words.hpp"
#include "improve_options.hpp"
#include "output.hpp"
#include "quantize_options.hpp"
#include "view_page.hpp"

namespace hexhex::command {
namespace {

/// Refuses what needs a whole mesh in memory if there will be none.
void requireWhole(const ExtractArguments& arguments) {
  const bool inPieces = arguments.stream || arguments.parts.parts;
  const auto refuse = [](bool isRefused, const char* option, const char* instead) {
    refuseIf(isRefused, fmt::format("{} needs a whole mesh in memory. Leave it out, or --stream, "
                                    "--parts and --partial{}.",
                                    option, instead));
  };
  refuse(inPieces && arguments.partial, "--partial", "");
  refuse(inPieces && arguments.options.engine != Engine::Atlas, "--engine propeller", "");
  const bool missing = inPieces || arguments.partial;
  refuse(missing && arguments.order > 1, "--order", "");
  refuse(missing && !arguments.arcs.empty(), "--arcs", "");
  refuse(missing && !arguments.patches.empty(), "--patches", "");
  refuse(missing && arguments.improve, "--improve", "; `hexhex improve` takes a file");
  refuse(missing && !arguments.page.empty(), "--view", "; `hexhex view` takes a file");
  refuse(missing && arguments.names.isGiven(), "--names or --split-tags",
         "; `hexhex convert` takes a file");
}

void requireCurvedOutputs(const ExtractArguments& arguments) {
  const bool piecewise = !arguments.arcs.empty() || !arguments.patches.empty();
  refuseIf(piecewise && arguments.order > 1,
           "Arcs and patches belong to meshes of order 1. Leave out --order, or --arcs and "
           "--patches.");
  if (arguments.order > 1) {
    arguments.choice.requireForCurved(arguments.output, arguments.order);
  }
  if (!arguments.arcs.empty()) {
    requireArcFormat(arguments.arcs);
    requireWritable(arguments.arcs);
  }
  if (!arguments.patches.empty()) {
    requirePatchFormat(arguments.patches);
    requireWritable(arguments.patches);
  }
  refuseIf(arguments.improve && (arguments.order > 3 || piecewise),
           "--improve moves nodes of cells up to order 3, away from the map that arcs and "
           "patches follow. Leave out --improve, or --arcs and --patches, or lower --order.");
  refuseIf(arguments.improve && arguments.order > 1 &&
               arguments.improveOptions.pillow != PillowMode::Never,
           "--pillow adds straight cells. Leave out --pillow or --order.");
}

/// Options for invalid maps.
void addRepairOptions(CLI::App& parser, ExtractArguments& arguments) {
  addChoice<bool>(parser, "--repair", arguments.repair, "MODE [auto]",
                  {{"auto", true}, {"off", false}},
                  "auto: repair flipped and flat tets of the map first, with a\n"
                  "notice; off: they are an error. Costs valid maps nothing");
  addRound(parser, arguments.options.round);
  parser.add_flag("--partial", arguments.partial,
                  "Write what can be extracted from a map beyond repair, with\n"
                  "cells at holes as region 1, and list the holes; exit code 1");
}

/// Options for improvement after the extraction.
void addImprovement(CLI::App& parser, ExtractArguments& arguments) {
  CLI::Option* const flag =
      parser.add_flag("--improve", arguments.improve,
                      "After the verification, move vertices to make all cells\n"
                      "positive, and better (`hexhex improve --help`)");
  for (CLI::Option* const option : addImproveOptions(parser, arguments.improveOptions)) {
    option->needs(flag);
  }
}

/// Adds --parts, --ghosts, --partition and --mpi.
void addPartsOptions(CLI::App& parser, PartsChoice& choice) {
  std::string extensions;
  for (const PartFormat& format : partFormats()) {
    if (format.extension.empty()) continue;
    extensions += (extensions.empty() ? "" : ", ") + std::string(format.extension);
  }
  addValue(parser, "--parts", choice.parts, "N",
           "Write the mesh in this many parts, for distributed solvers,\none file each or all in "
           "one: " +
               extensions)
      ->check(CLI::Range(1U, kMaxParts));
  addValue(parser, "--ghosts", choice.options.ghostLayers, "LAYERS [0]",
           "Layers of cells of other parts around each part")
      ->check(CLI::Range(0U, kMaxGhostLayers));
  addChoice<PartitionMethod>(
      parser, "--partition", choice.options.method, "METHOD [curve]",
      {{"curve", PartitionMethod::Curve},
       {"scotch", PartitionMethod::Scotch},
       {"metis", PartitionMethod::Metis}},
      "How to divide the mesh: curve (recursive bisection);\nscotch or metis, if that library "
      "is installed");
  parser.add_flag(
      "--mpi", choice.mpi,
      "Make one part in each MPI process, as several processes\nstarted by mpirun do anyway");
}

/// Options that affect how a mesh is computed, but not the result.
void addMethod(CLI::App& parser, ExtractArguments& arguments) {
  addChoice<Engine>(parser, "--engine", arguments.options.engine, "ENGINE [atlas]",
                    {{"atlas", Engine::Atlas}, {"propeller", Engine::Propeller}},
                    "atlas: reads most cells off large charts of the map;\n"
                    "propeller: the algorithm of the paper, slower. Both give\n"
                    "the same mesh, bit for bit");
  parser.add_flag("--stream", arguments.stream,
                  "Write the mesh piece by piece, for meshes larger than the\nmemory, as " +
                      extensionsThat(&FileFormat::streams) +
                      ".\nWithout what needs the whole mesh: scaled Jacobians and\n"
                      "boundary quads");
  addPartsOptions(parser, arguments.parts);
}

/// Options for cells of higher order, arcs and patches.
void addCurved(CLI::App& parser, ExtractArguments& arguments) {
  CLI::Option* const order =
      addValue(parser, "--order", arguments.order, "P [1]",
               "Write cells of this order, which follow the curved surface,\n"
               "as .vtu, .msh, .mesh (MFEM); order 2 also .meshb, .inp, .exo, .cgns")
          ->check(CLI::Range(1, kMaxOrder));
  addCurvedNodes(parser, arguments.options.curvedNodes, order);
  addValue(parser, "--arcs", arguments.arcs, "FILE",
           "Also write hex edges as polylines through the tets,\n.vtu, .vtp or .ovmb");
  addValue(parser, "--patches", arguments.patches, "FILE",
           "Also write hex faces as polygons, tet by tet: .vtu, .vtp\nor .ovmb");
}

}  // namespace

void addExtractOptions(CLI::App& parser, ExtractArguments& arguments) {
  addMapSource(parser, arguments.input);
  addKeepWalls(parser, arguments.input);
  addMeshOutput(parser, arguments.output);
  addMeshChoice(parser, arguments.choice, arguments.output);
  addScale(parser, arguments.options.scale,
           "Multiply all parameters by this integer, and the number of\ncells by its cube");
  addCurved(parser, arguments);
  addMethod(parser, arguments);
  addTolerance(parser, arguments.options.tolerance);
  addPatchAngle(parser, arguments.patchAngle);
  addPatchNames(parser, arguments.names);
  addRepairOptions(parser, arguments);
  addQuantization(parser, arguments.quantize, arguments.quantizeOptions);
  addImprovement(parser, arguments);
  parser.add_flag("--no-verify", arguments.noVerify, "Write the mesh without verifying it");
  addReport(parser, arguments.report,
            "Write a report in JSON: times, counts, quality,\nverification");
  addPage(
      parser, arguments.page,
      "Also write a page that shows the mesh in any browser; with\n--improve, before and after");
  addRunOptions(parser, arguments.run);
  parser.footer(
      "The mesh is verified against the map before it is written; with --stream and --parts, on "
      "its\n"
      "way to files that get their names only if all of it is right. The same input gives the "
      "same\n"
      "bytes with any number of threads.\n\nExample:\n"
      "  hexhex extract sphere.hexex -o sphere.vtu --scale 2 --report sphere.json");
}

void requireOutputs(const ExtractArguments& arguments) {
  std::vector<std::filesystem::path> inputs = arguments.input.files();
  inputs.emplace_back(arguments.names.file());
  requireAllDifferent(inputs, {arguments.output, arguments.report, arguments.arcs,
                               arguments.patches, arguments.page});
  requireWhole(arguments);
  requireCurvedOutputs(arguments);
  if (!arguments.page.empty()) requirePage(arguments.page);
  refuseIf(!arguments.parts.parts && arguments.parts.isOfParts(),
           "--ghosts and --partition say how a mesh is cut. Leave them out, or add --parts.");
  const WriteOptions writing = arguments.choice.options();
  if (arguments.parts.parts) {
    refuseIf(writing.compress != Compression::None,
             "Files of parts are not compressed. Leave out --parts or --compress.");
    requirePartFormat(arguments.output, writing, arguments.team != nullptr);
  } else if (arguments.order == 1) {
    requireHexMeshFormat(arguments.output, writing);
  }
  // In a team, each process would create its own folder.
  requireWritable(arguments.output, !arguments.parts.parts);
}

}  // namespace hexhex::command
