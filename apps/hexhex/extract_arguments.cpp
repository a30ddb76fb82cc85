#include "extract_arguments.hpp"

#include <array>
#include <string>
#include <vector>

#include <hexhex/curved.hpp>
#include <hexhex/error.hpp>

#include "expected_words.hpp"
#include "extract_stream.hpp"
#include "improve_options.hpp"
#include "output.hpp"
#include "quantize_options.hpp"
#include "view_page.hpp"

namespace hexhex::command {
namespace {

void requireCurvedOutputs(const ExtractArguments& arguments) {
  const bool piecewise = !arguments.arcs.empty() || !arguments.patches.empty();
  refuseIf(arguments.stream && (piecewise || arguments.order > 1),
           "Curved meshes are made as a whole. Leave out --stream, or --arcs, --patches and "
           "--order.");
  refuseIf(piecewise && arguments.order > 1,
           "Arcs and patches belong to meshes of order 1. Leave out --order, or --arcs and "
           "--patches.");
  if (arguments.order > 1 && !arguments.parts.parts) {
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
}

/// Only straight cells of a valid map can be written in parts.
void requirePartsOutputs(const ExtractArguments& arguments) {
  refuseIf(arguments.options.engine != Engine::Atlas || arguments.order > 1 || arguments.partial ||
               !arguments.arcs.empty() || !arguments.patches.empty(),
           "--parts makes straight cells with the engine atlas, of valid maps. Leave out "
           "--parts, or --engine, --order, --arcs, --patches and --partial.");
  refuseIf(arguments.choice.compress,
           "Files of parts are not compressed. Leave out --parts or --compress.");
  requirePartFormat(arguments.output, arguments.choice.options(), arguments.team != nullptr);
}

/// Only a complete mesh in memory can be improved.
void requireImprovable(const ExtractArguments& arguments) {
  if (!arguments.improve) return;
  if (arguments.stream || arguments.partial || arguments.parts.parts) {
    throw Error(ErrorCode::InvalidArgument,
                "--improve needs the whole mesh in memory. Leave it out, or --stream, "
                "--parts and --partial; `hexhex improve` takes a file.");
  }
  refuseIf(arguments.order > 3 || !arguments.arcs.empty() || !arguments.patches.empty(),
           "--improve moves nodes of cells up to order 3, away from the map that arcs and "
           "patches follow. Leave out --improve, or --arcs and --patches, or lower --order.");
  refuseIf(arguments.order > 1 && arguments.improveOptions.pillow != PillowMode::Never,
           "--pillow adds straight cells. Leave out --pillow or --order.");
}

/// Only a complete and valid mesh can be shown on a page.
void requirePageOutput(const ExtractArguments& arguments) {
  if (arguments.page.empty()) return;
  if (arguments.stream || arguments.partial || arguments.parts.parts) {
    throw Error(ErrorCode::InvalidArgument,
                "--view needs the whole mesh in memory. Leave it out, or --stream, --parts "
                "and --partial; `hexhex view` takes a file.");
  }
  requirePage(arguments.page);
}

/// A partial extraction needs a straight mesh in memory.
void requirePartialOutputs(const ExtractArguments& arguments) {
  if (!arguments.partial) return;
  refuseIf(arguments.stream,
           "--partial needs the whole mesh in memory. Leave out one of --stream and --partial.");
  refuseIf(arguments.order > 1 || !arguments.arcs.empty() || !arguments.patches.empty(),
           "--partial writes straight cells only: beside holes, there is no map for curved "
           "ones to follow. Leave out --partial, or --order, --arcs and --patches.");
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
                      "boundary quads; verified by reading the file back");
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
      "The mesh is verified against the map before it is written; with --stream, the file is read\n"
      "back before it gets its name: it must hold what was extracted, and as many cells and\n"
      "vertices as follow from the map. Parts are verified one by one. The same input gives the\n"
      "same bytes with any number of threads.\n\nExample:\n"
      "  hexhex extract sphere.hexex -o sphere.vtu --scale 2 --report sphere.json");
}

void requireOutputs(const ExtractArguments& arguments) {
  if (arguments.names.isGiven() &&
      (arguments.stream || arguments.partial || arguments.parts.parts)) {
    throw Error(
        ErrorCode::InvalidArgument,
        "--names and --split-tags need the whole mesh in memory. Leave them out, or --stream, "
        "--parts and --partial; `hexhex convert` takes a file.");
  }
  std::vector<std::filesystem::path> inputs = arguments.input.files();
  inputs.emplace_back(arguments.names.file());
  requireAllDifferent(inputs, {arguments.output, arguments.report, arguments.arcs,
                               arguments.patches, arguments.page});
  requireCurvedOutputs(arguments);
  requirePartialOutputs(arguments);
  requireImprovable(arguments);
  requirePageOutput(arguments);
  refuseIf(!arguments.parts.parts && arguments.parts.isOfParts(),
           "--ghosts and --partition say how a mesh is cut. Leave them out, or add --parts.");
  if (arguments.parts.parts) {
    requirePartsOutputs(arguments);
  } else if (arguments.order == 1) {
    requireHexMeshFormat(arguments.output, arguments.choice.options());
  }
  // In a team, each process would create its own folder.
  requireWritable(arguments.output, !arguments.parts.parts);
  if (arguments.stream && !arguments.parts.parts) {
    requireStreamable(arguments.output, arguments.choice.options(), arguments.options);
  }
}

}  // namespace hexhex::command
