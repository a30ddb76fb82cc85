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
  if (arguments.stream && (piecewise || arguments.order > 1)) {
    throw Error(ErrorCode::InvalidArgument,
                "Curved meshes are made as a whole. Leave out --stream, or --arcs, --patches and "
                "--order.");
  }
  if (piecewise && arguments.order > 1) {
    throw Error(ErrorCode::InvalidArgument,
                "Arcs and patches belong to meshes of order 1. Leave out --order, or --arcs and "
                "--patches.");
  }
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

/// Parts are straight cells of a valid map.
void requirePartsOutputs(const ExtractArguments& arguments) {
  if (arguments.options.engine != Engine::Atlas || arguments.order > 1 || arguments.partial ||
      !arguments.arcs.empty() || !arguments.patches.empty()) {
    throw Error(ErrorCode::InvalidArgument,
                "--parts makes straight cells with the engine atlas, of valid maps. Leave out "
                "--parts, or --engine, --order, --arcs, --patches and --partial.");
  }
  if (arguments.choice.compress) {
    throw Error(ErrorCode::InvalidArgument,
                "Files of parts are not compressed. Leave out --parts or --compress.");
  }
  requirePartFormat(arguments.output, arguments.choice.options(), arguments.team != nullptr);
}

/// Vertices move in a mesh that is whole.
void requireImprovable(const ExtractArguments& arguments) {
  if (!arguments.improve) return;
  if (arguments.stream || arguments.partial || arguments.parts.parts) {
    throw Error(ErrorCode::InvalidArgument,
                "--improve needs the whole mesh in memory. Leave it out, or --stream, "
                "--parts and --partial; `hexhex improve` takes a file.");
  }
  if (arguments.order > 3 || !arguments.arcs.empty() || !arguments.patches.empty()) {
    throw Error(ErrorCode::InvalidArgument,
                "--improve moves nodes of cells up to order 3, away from the map that arcs and "
                "patches follow. Leave out --improve, or --arcs and --patches, or lower --order.");
  }
  if (arguments.order > 1 && arguments.improveOptions.pillow != PillowMode::Never) {
    throw Error(ErrorCode::InvalidArgument,
                "--pillow adds straight cells. Leave out --pillow or --order.");
  }
}

/// A page shows a mesh that is whole and valid.
void requirePageOutput(const ExtractArguments& arguments) {
  if (arguments.page.empty()) return;
  if (arguments.stream || arguments.partial || arguments.parts.parts) {
    throw Error(ErrorCode::InvalidArgument,
                "--view shows a whole mesh that was in memory. Leave it out, or --stream, --parts "
                "and --partial; `hexhex view` takes a file.");
  }
  requirePage(arguments.page);
}

/// What is left of a map beyond repair is a straight mesh in memory.
void requirePartialOutputs(const ExtractArguments& arguments) {
  if (!arguments.partial) return;
  if (arguments.stream) {
    throw Error(
        ErrorCode::InvalidArgument,
        "--partial needs the whole mesh in memory. Leave out one of --stream and --partial.");
  }
  if (arguments.order > 1 || !arguments.arcs.empty() || !arguments.patches.empty()) {
    throw Error(ErrorCode::InvalidArgument,
                "--partial writes straight cells only: beside holes, there is no map for curved "
                "ones to follow. Leave out --partial, or --order, --arcs and --patches.");
  }
}

/// What happens to maps that are not valid.
void addRepairOptions(CLI::App& parser, ExtractArguments& arguments) {
  addChoice<bool>(parser, "--repair", arguments.repair, {{"auto", true}, {"off", false}},
                  "auto: repair flipped and flat tets of the map first, with a\n"
                  "notice; off: they are an error. Valid maps pay nothing")
      ->option_text("MODE [auto]");
  addRound(parser, arguments.options.round);
  parser.add_flag("--partial", arguments.partial,
                  "Write what can be extracted of a map beyond repair, cells\n"
                  "at holes as region 1, and list the holes; exit code 1");
}

/// After the extraction.
void addImprovement(CLI::App& parser, ExtractArguments& arguments) {
  CLI::Option* const flag =
      parser.add_flag("--improve", arguments.improve,
                      "Move vertices after the verification: all cells become\n"
                      "positive, and better (`hexhex improve --help`)");
  for (CLI::Option* const option : addImproveOptions(parser, arguments.improveOptions)) {
    option->needs(flag);
  }
}

/// Options that change how a mesh is made, but not the mesh.
void addMethod(CLI::App& parser, ExtractArguments& arguments) {
  addChoice<Engine>(parser, "--engine", arguments.options.engine,
                    {{"atlas", Engine::Atlas}, {"propeller", Engine::Propeller}},
                    "atlas: reads most cells off large charts of the map;\n"
                    "propeller: the algorithm of the paper, slower. Both give\n"
                    "the same mesh, bit for bit")
      ->option_text("ENGINE [atlas]");
  parser.add_flag("--stream", arguments.stream,
                  "Write the mesh piece by piece, for meshes larger than the\nmemory: " +
                      extensionsThat(&FileFormat::streams) +
                      ".\nNothing that takes the whole mesh: no scaled Jacobians,\n"
                      "no boundary quads; verified when the file is read back");
  addPartsOptions(parser, arguments.parts);
}

/// Meshes that follow the map more closely.
void addCurved(CLI::App& parser, ExtractArguments& arguments) {
  CLI::Option* const order =
      parser
          .add_option("--order", arguments.order,
                      "Write cells of this order, curved as the surface is: .vtu,\n"
                      ".msh, .mesh (MFEM); order 2 also .inp, .exo, .cgns")
          ->check(CLI::Range(1, kMaxOrder))
          ->option_text("P [1]");
  addCurvedNodes(parser, arguments.options.curvedNodes, order);
  parser
      .add_option("--arcs", arguments.arcs,
                  "Also write hex edges as polylines through the tets,\n.vtu, .vtp or .ovmb")
      ->option_text("FILE");
  parser
      .add_option("--patches", arguments.patches,
                  "Also write hex faces as polygons, tet by tet: .vtu, .vtp\nor .ovmb")
      ->option_text("FILE");
}

}  // namespace

void addExtractOptions(CLI::App& parser, ExtractArguments& arguments) {
  addMapSource(parser, arguments.input);
  addKeepWalls(parser, arguments.input);
  addMeshOutput(parser, arguments.output);
  addMeshChoice(parser, arguments.choice, arguments.output);
  addScale(parser, arguments.options.scale,
           "Multiply all parameters by this integer: its cube as\nmany cells");
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
  addPage(parser, arguments.page,
          "Also write a page that shows the mesh in any browser; with\n--improve before and after");
  addRunOptions(parser, arguments.run);
  parser.footer(
      "The mesh is verified against the map before it is written; with --stream, the file is read\n"
      "again before it gets its name: it must hold what was extracted, and as many cells and\n"
      "vertices as follow from the map. Parts are verified one by one. The same input gives the\n"
      "same bytes with any number of threads.\n\nExample:\n"
      "  hexhex extract sphere.hexex -o sphere.vtu --scale 2 --report sphere.json");
}

void requireOutputs(const ExtractArguments& arguments) {
  if (arguments.names.isGiven() &&
      (arguments.stream || arguments.partial || arguments.parts.parts)) {
    throw Error(
        ErrorCode::InvalidArgument,
        "--names and --split-tags take a whole mesh in memory. Leave them out, or --stream, "
        "--parts and --partial; `hexhex convert` has them, too.");
  }
  std::vector<std::filesystem::path> inputs = arguments.input.files();
  inputs.emplace_back(arguments.names.file());
  requireAllDifferent(inputs, {arguments.output, arguments.report, arguments.arcs,
                               arguments.patches, arguments.page});
  requireCurvedOutputs(arguments);
  requirePartialOutputs(arguments);
  requireImprovable(arguments);
  requirePageOutput(arguments);
  if (!arguments.parts.parts && arguments.parts.isOfParts()) {
    throw Error(ErrorCode::InvalidArgument,
                "--ghosts and --partition say how a mesh is cut. Leave them out, or add --parts.");
  }
  if (arguments.parts.parts) {
    requirePartsOutputs(arguments);
  } else if (arguments.order == 1) {
    requireHexMeshFormat(arguments.output, arguments.choice.options());
  }
  // Several processes would each make a folder of their own.
  requireWritable(arguments.output, !arguments.parts.parts);
  if (arguments.stream && !arguments.parts.parts) {
    requireStreamable(arguments.output, arguments.choice.options(), arguments.options);
  }
}

}  // namespace hexhex::command
