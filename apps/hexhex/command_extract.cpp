// `hexhex extract`: from a map to a verified hexahedral mesh.
#include <array>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <fmt/core.h>

#include <hexhex/curved.hpp>
#include <hexhex/error.hpp>
#include <hexhex/extract.hpp>
#include <hexhex/extractor.hpp>
#include <hexhex/improve.hpp>
#include <hexhex/io.hpp>
#include <hexhex/partial.hpp>
#include <hexhex/quality.hpp>
#include <hexhex/quantize.hpp>
#include <hexhex/verify.hpp>

#include "command.hpp"
#include "exit_codes.hpp"
#include "extract_parts.hpp"
#include "extract_stream.hpp"
#include "extract_text.hpp"
#include "improve_options.hpp"
#include "json.hpp"
#include "long_run.hpp"
#include "output.hpp"
#include "partial_text.hpp"
#include "quantize_options.hpp"
#include "repair_text.hpp"
#include "report.hpp"
#include "shared_options.hpp"
#include "started_team.hpp"
#include "suggestions.hpp"
#include "verification.hpp"
#include "view_page.hpp"

namespace hexhex::command {
namespace {

struct Arguments {
  MapSource input;
  std::string output;
  OutputChoice choice;
  std::string report;
  std::string arcs;
  std::string patches;
  std::string page;  ///< empty: none
  int order = 1;
  ExtractOptions options;
  bool quantize = false;
  QuantizeOptions quantizeOptions;
  bool improve = false;
  ImproveOptions improveOptions;
  double patchAngle = WriteOptions{}.patchAngle;
  RunOptions run;
  bool stream = false;
  PartsChoice parts;
  ProcessTeam* team = nullptr;  ///< of which this is one process
  bool partial = false;
  bool noVerify = false;
};

void requireAllDifferent(const Arguments& arguments) {
  std::vector<std::filesystem::path> files = arguments.input.files();
  for (const std::string& output :
       {arguments.output, arguments.report, arguments.arcs, arguments.patches, arguments.page}) {
    for (const std::filesystem::path& file : files) {
      if (!output.empty()) requireDifferent(file, output);
    }
    if (!output.empty()) files.emplace_back(output);
  }
}

void requireCurvedOutputs(const Arguments& arguments) {
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
  if (arguments.order > 1 && (!arguments.choice.format.empty() || arguments.choice.compress)) {
    throw Error(ErrorCode::InvalidArgument,
                "The extension alone decides on the format of a mesh of higher order. Leave out "
                "--format and --compress.");
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
void requirePartsOutputs(const Arguments& arguments) {
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
void requireImprovable(const Arguments& arguments) {
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
}

/// A page shows a mesh that is whole and valid.
void requirePageOutput(const Arguments& arguments) {
  if (arguments.page.empty()) return;
  if (arguments.stream || arguments.partial || arguments.parts.parts) {
    throw Error(ErrorCode::InvalidArgument,
                "--view shows a whole mesh that was in memory. Leave it out, or --stream, --parts "
                "and --partial; `hexhex view` takes a file.");
  }
  requirePage(arguments.page);
}

/// What is left of a map beyond repair is a straight mesh in memory.
void requirePartialOutputs(const Arguments& arguments) {
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

/// Everything that can be known to fail before long work.
void requireOutputs(const Arguments& arguments) {
  requireAllDifferent(arguments);
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
  } else if (arguments.order > 1) {
    requireLagrangeFormat(arguments.output);
  } else {
    requireHexMeshFormat(arguments.output, arguments.choice.options());
  }
  requireWritable(arguments.output);
  if (arguments.stream && !arguments.parts.parts) {
    requireStreamable(arguments.output, arguments.choice.options(), arguments.options);
  }
}

/// What extracts a mesh and then verifies it.
Extractor prepareExtractor(const Arguments& arguments, const TetMap& map, LongRun& longRun) {
  const ExtractOptions& options = arguments.options;
  // Where there is no such number, the extraction says so.
  const bool fits = options.scale <= std::numeric_limits<int>::max() / arguments.order;
  const int maxScale = fits ? options.scale * arguments.order : options.scale;
  return longRun.part("extraction", [&] {
    return Extractor(map, {options.tolerance, maxScale, options.repair, options.round},
                     longRun.context());
  });
}

void verifyMesh(const Arguments& arguments, Extractor& extractor, const HexMesh& mesh,
                LongRun& longRun, ExtractionRecord& record) {
  if (arguments.noVerify) return;
  record.verification = longRun.part("verification", [&] {
    return extractor.verify(mesh, {.scale = arguments.options.scale}, longRun.context());
  });
  requirePassed(*record.verification, "The mesh does not agree with the map and was not written",
                "Please report this with the map.");
}

/// Extracts the mesh with the arcs and patches that are asked for.
PiecewiseLinearMesh extractWithCurves(const Arguments& arguments, Extractor& extractor,
                                      Context& context, ExtractionRecord& record) {
  if (arguments.arcs.empty() && arguments.patches.empty()) {
    return {extractor.extract(arguments.options, context, &record.statistics), {}, {}};
  }
  const auto parts =
      arguments.patches.empty() ? PiecewiseLinearParts::Arcs : PiecewiseLinearParts::ArcsAndPatches;
  return extractor.extractPiecewiseLinear(parts, arguments.options, context, &record.statistics);
}

/// @param mesh  straight or curved
/// @return where its points were before; empty without an improvement, and if no page shows them
Array<Vec3> improveOrCertify(const Arguments& arguments, const TetMap& map, auto& mesh,
                             LongRun& longRun, ExtractionRecord& record) {
  Context& context = longRun.context();
  if (!arguments.improve) {
    record.certificate = longRun.part("quality", [&] { return certify(mesh, context); });
    return {};
  }
  Array<Vec3> before = arguments.page.empty() ? Array<Vec3>() : mesh.points;
  record.improved = longRun.part("improvement", [&] {
    return improve(mesh, extractedMap(map, record.statistics), arguments.improveOptions, context);
  });
  record.certificate = record.improved->after;
  return before;
}

/// @param mesh  straight or curved  @param before  as improveOrCertify() returned it
void writeMeshPage(const Arguments& arguments, const auto& mesh, const Array<Vec3>& before,
                   LongRun& longRun, const ExtractionRecord& record) {
  if (arguments.page.empty()) return;
  ViewOptions options;
  if (record.verification) options.verification = &*record.verification;
  options.mapName = std::filesystem::path(arguments.input.description()).filename().string();
  options.scaledJacobians = record.certificate->scaledJacobians;
  options.pointsBefore = before;
  longRun.part("page", [&] {
    writePage(mesh, arguments.page, arguments.output, options, longRun.context());
  });
}

/// Extracts, verifies and writes a mesh in memory.
void extractWhole(const Arguments& arguments, const TetMap& map, LongRun& longRun,
                  ExtractionRecord& record) {
  Context& context = longRun.context();
  std::optional<Extractor> extractor = prepareExtractor(arguments, map, longRun);
  PiecewiseLinearMesh all = longRun.part(
      "extraction", [&] { return extractWithCurves(arguments, *extractor, context, record); });
  HexMesh& mesh = all.mesh;
  verifyMesh(arguments, *extractor, mesh, longRun, record);
  extractor.reset();  // its memory serves what follows
  if (!arguments.arcs.empty()) {
    longRun.part("writing", [&] {
      writeArcs(all, extractedMap(map, record.statistics), arguments.arcs, context);
    });
    record.arcs = {arguments.arcs, all.arcs.count(), all.arcs.points.size()};
  }
  if (!arguments.patches.empty()) {
    longRun.part("writing", [&] {
      writePatches(all, extractedMap(map, record.statistics), arguments.patches, context);
    });
    record.patches = {arguments.patches, all.patches.count(), all.patches.polygonTet.size()};
  }
  const Array<Vec3> before = improveOrCertify(arguments, map, mesh, longRun, record);
  WriteOptions writing = arguments.choice.options();
  writing.scaledJacobians = record.certificate->scaledJacobians;
  writing.patchAngle = arguments.patchAngle;
  longRun.part("writing", [&] { writeHexMesh(mesh, arguments.output, writing, context); });
  writeMeshPage(arguments, mesh, before, longRun, record);
  record.tags = {mesh.features.vertices.size(), mesh.features.edges.size(),
                 mesh.features.quads.size()};
  record.vertices = mesh.points.size();
  record.cells = mesh.cells.size();
}

/// Cells of higher order.
void extractCurved(const Arguments& arguments, const TetMap& map, LongRun& longRun,
                   ExtractionRecord& record) {
  Context& context = longRun.context();
  std::optional<Extractor> extractor = prepareExtractor(arguments, map, longRun);
  LagrangeMesh mesh = longRun.part("extraction", [&] {
    return extractor->extractLagrange(arguments.order, arguments.options, context,
                                      &record.statistics);
  });
  verifyMesh(arguments, *extractor, straightMesh(mesh), longRun, record);
  extractor.reset();
  const Array<Vec3> before = improveOrCertify(arguments, map, mesh, longRun, record);
  WriteOptions options;
  options.scaledJacobians = record.certificate->scaledJacobians;
  options.patchAngle = arguments.patchAngle;
  longRun.part("writing", [&] { writeLagrangeMesh(mesh, arguments.output, options, context); });
  writeMeshPage(arguments, mesh, before, longRun, record);
  record.tags = {mesh.features.vertices.size(), mesh.features.edges.size(),
                 mesh.features.quads.size()};
  record.vertices = mesh.vertexCount;
  record.cells = mesh.cellCount();
  record.nodes = mesh.points.size();
}

/// The same in pieces, verified after it was written.
void extractInPieces(const Arguments& arguments, const TetMap& map, LongRun& longRun,
                     ExtractionRecord& record) {
  StreamedMesh mesh =
      extractStreamed(map, arguments.output, arguments.choice.options(), arguments.options,
                      !arguments.noVerify, longRun, record.statistics);
  record.verification = std::move(mesh.verification);
  record.vertices = mesh.written.points;
  record.cells = mesh.written.cells;
  record.streamed = mesh.written;
}

/// The same in parts.
void extractAllParts(const Arguments& arguments, const TetMap& map, LongRun& longRun,
                     ExtractionRecord& record) {
  WriteOptions options = arguments.choice.options();
  options.patchAngle = arguments.patchAngle;
  PartOptions parts = arguments.parts.chosen();
  parts.verify = !arguments.noVerify;
  record.meshParts = longRun.part("extraction", [&] {
    return extractInParts(map, arguments.output, options, arguments.options, parts, arguments.team,
                          longRun.context(), record.statistics);
  });
  record.vertices = record.meshParts->summary.vertices;
  record.cells = record.meshParts->summary.cells;
}

/// What is left of a map beyond repair. Always an invalid map, by its exit code.
int extractWhatIsValid(const Arguments& arguments, const TetMap& map, const Error& problem,
                       LongRun& longRun, Report& report) {
  Context& context = longRun.context();
  const PartialMesh partial =
      extractPartial(map, {arguments.options.scale, arguments.options.tolerance}, context);
  WriteOptions options = arguments.choice.options();
  options.patchAngle = arguments.patchAngle;
  writeHexMesh(partial.mesh, arguments.output, options, context);
  longRun.finish();
  if (report.isWanted()) {
    report.write(partialReportAsJson(partial, problem, arguments.options.scale));
  }
  printError(problem);
  if (arguments.run.quiet) return kInvalidMap;
  printWarning("Only a part of the mesh was extracted, as --partial asks for.");
  if (report.isOnOutput()) return kInvalidMap;
  printFiles(arguments.input.description(), arguments.output);
  printPartial(partial);
  return kInvalidMap;
}

/// Says of a map that is not integer, but seamless, what to do.
void adviseQuantization(const Arguments& arguments, const TetMap& map, const Error& error,
                        Context& context) {
  if (arguments.quantize || !canQuantize() || !mayBeSeamless(error.code())) return;
  const std::string advice = adviceFor(examineSeamless(map, context), arguments.input);
  if (!advice.empty()) throw Error(error.code(), advice);
}

/// The functions of the library that a run calls; weights are their seconds for a mesh of seven
/// million cells.
std::vector<WorkStep> stepsOf(const Arguments& arguments) {
  std::vector<WorkStep> steps = {{"readMap", 0.05}, {"readMapPair", 0.05}};
  if (arguments.quantize) steps.push_back({"quantize", 20});
  if (arguments.parts.parts) {
    steps.push_back({"extractParts", 4});
    return steps;
  }
  const std::vector<WorkStep> rest =
      arguments.stream
          ? std::vector<WorkStep>{{"extractTo", 4}, {"VerifySink", 0.5}, {"readHexMeshTo", 3}}
          : std::vector<WorkStep>{
                {"Extractor", 0.3},
                {arguments.order > 1 ? "Extractor::extractLagrange" : "Extractor::extract", 4},
                {"Extractor::extractPiecewiseLinear", 20},
                {"Extractor::verify", 2.5},
                {"writeArcs", 2},
                {"writePatches", 5},
                {"certify", 0.5},
                {"writeHexMesh", 1},
                {"writeLagrangeMesh", 4},
                {"writeViewPage", 10}};
  steps.insert(steps.end(), rest.begin(), rest.end());
  return steps;
}

TetMap readAndQuantize(const Arguments& arguments, LongRun& longRun, ExtractionRecord& record) {
  TetMap map = longRun.part("reading", [&] { return readMap(arguments.input, longRun.context()); });
  if (!arguments.quantize) return map;
  QuantizedMap quantized = longRun.part("quantization", [&] {
    return quantize(map, optionsFor(arguments.input, arguments.quantizeOptions), longRun.context());
  });
  record.quantized = std::move(quantized.report);
  return std::move(quantized.map);
}

/// In a team, the first process reads, and all others get what it has.
TetMap readForTeam(const Arguments& arguments, LongRun& longRun, ExtractionRecord& record) {
  if (arguments.team == nullptr) return readAndQuantize(arguments, longRun, record);
  const bool reads = arguments.team->rank() == 0;
  TetMap read = reads ? readAndQuantize(arguments, longRun, record) : TetMap{};
  TetMap shared = longRun.part("broadcast", [&] { return shareMap(*arguments.team, read); });
  return reads ? std::move(read) : std::move(shared);
}

/// What is known beside what the steps have noted.
void fillRecord(const Arguments& arguments, const TetMap& map, LongRun& longRun,
                ExtractionRecord& record) {
  std::error_code unknown;  // the size of a pipe
  record.input.file = arguments.input.description();
  for (const std::filesystem::path& file : arguments.input.files()) {
    record.input.bytes += std::filesystem::file_size(file, unknown);
  }
  record.output.file = arguments.output;
  record.page = arguments.page;
  const auto bytes = std::filesystem::file_size(arguments.output, unknown);
  if (!unknown) record.output.bytes = bytes;  // the files of parts may have other names
  record.order = arguments.order;
  record.scale = arguments.options.scale;
  record.engine = arguments.options.engine;
  record.points = map.points.size();
  record.tets = map.tets.size();
  record.stages = longRun.context().stageTimes();
  record.parts = longRun.parts();
  record.partsAsText = longRun.partsAsText();
}

int extractMesh(const Arguments& arguments) {
  LongRun longRun(arguments.run, stepsOf(arguments));
  requireOutputs(arguments);
  Report report(arguments.report);
  ExtractionRecord record;
  const TetMap map = readForTeam(arguments, longRun, record);
  const auto make = [&arguments] {
    if (arguments.parts.parts) return extractAllParts;
    if (arguments.stream) return extractInPieces;
    return arguments.order > 1 ? extractCurved : extractWhole;
  }();
  try {
    make(arguments, map, longRun, record);
  } catch (const Error& error) {
    if (!arguments.partial || exitCodeOf(error.code()) != kInvalidMap) {
      adviseQuantization(arguments, map, error, longRun.context());
      throw;
    }
    return extractWhatIsValid(arguments, map, error, longRun, report);
  }
  longRun.finish();
  fillRecord(arguments, map, longRun, record);
  if (report.isWanted()) report.write(reportAsJson(record));
  if (arguments.run.quiet) return kSuccess;
  printWarnings(record, map);
  if (!report.isOnOutput()) printSummary(record);
  return kSuccess;
}

int run(const Arguments& given) {
  if (!isInTeam(given.parts.mpi)) return extractMesh(given);
  const StartedTeam started;
  Arguments arguments = given;
  arguments.team = &started.team();
  if (!arguments.parts.parts) arguments.parts.parts = arguments.team->size();
  if (arguments.run.threads == 0) arguments.run.threads = threadsInTeam();
  const bool speaks = arguments.team->rank() == 0;
  if (!speaks) {
    arguments.report.clear();
    arguments.run.quiet = true;
  }
  try {
    arguments.team->run([&arguments] { static_cast<void>(extractMesh(arguments)); });
  } catch (const Error& error) {
    // Here, where all are still there: when one has ended so, mpirun stops the others.
    if (speaks) printError(error);
    return exitCodeOf(error.code());
  }
  return kSuccess;
}

/// What happens to maps that are not valid.
void addRepairOptions(CLI::App& parser, Arguments& arguments) {
  addChoice<RepairMode>(parser, "--repair", arguments.options.repair,
                        {{"auto", RepairMode::Auto}, {"off", RepairMode::Off}},
                        "auto: repair flipped and flat tets of the map first, with a\n"
                        "notice; off: they are an error. Valid maps pay nothing")
      ->option_text("MODE [auto]");
  addRound(parser, arguments.options.round);
  parser.add_flag("--partial", arguments.partial,
                  "Write what can be extracted of a map beyond repair, cells\n"
                  "at holes as region 1, and list the holes; exit code 1");
}

/// After the extraction.
void addImprovement(CLI::App& parser, Arguments& arguments) {
  CLI::Option* const flag =
      parser.add_flag("--improve", arguments.improve,
                      "Move vertices after the verification: all cells become\n"
                      "positive, and better (`hexhex improve --help`)");
  for (CLI::Option* const option : addImproveOptions(parser, arguments.improveOptions)) {
    option->needs(flag);
  }
}

/// Options that change how a mesh is made, but not the mesh.
void addMethod(CLI::App& parser, Arguments& arguments) {
  addChoice<Engine>(parser, "--engine", arguments.options.engine,
                    {{"atlas", Engine::Atlas}, {"propeller", Engine::Propeller}},
                    "atlas: reads most cells off large charts of the map;\n"
                    "propeller: the algorithm of the paper, slower. Both give\n"
                    "the same mesh, bit for bit")
      ->option_text("ENGINE [atlas]");
  parser
      .add_option("--epsilon", arguments.options.epsilon,
                  "Enlargement of tets while the propeller engine searches\n"
                  "lattice points, in parameter units; inf is legal. Never\n"
                  "changes the result, only the time")
      ->check(CLI::Range(0.0, std::numeric_limits<double>::infinity()))
      ->option_text("NUMBER [1e-6]");
  parser.add_flag("--stream", arguments.stream,
                  "Write the mesh piece by piece, for meshes larger than the\nmemory: " +
                      extensionsThat(&FileFormat::streams) +
                      ".\nNothing that takes the whole mesh: no scaled Jacobians,\n"
                      "no boundary quads; verified when the file is read back");
  addPartsOptions(parser, arguments.parts);
}

/// Meshes that follow the map more closely.
void addCurved(CLI::App& parser, Arguments& arguments) {
  parser
      .add_option(
          "--order", arguments.order,
          "Write cells of this order, whose nodes are on the images\nof a finer grid: .vtu, "
          ".msh, or .mesh (MFEM)")
      ->check(CLI::Range(1, kMaxOrder))
      ->option_text("P [1]");
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

Command addExtract(CLI::App& app) {
  const auto arguments = std::make_shared<Arguments>();
  arguments->options.repair = RepairMode::Auto;
  CLI::App* const parser = app.add_subcommand("extract", "Extract the hexahedral mesh of a map");
  addMapSource(*parser, arguments->input);
  parser
      ->add_option("-o,--output", arguments->output,
                   "The mesh to write; `hexhex formats` lists the formats")
      ->required()
      ->option_text("FILE REQUIRED");
  addOutputChoice(*parser, arguments->choice);
  addScale(*parser, arguments->options.scale,
           "Multiply all parameters by this integer: its cube as\nmany cells");
  addCurved(*parser, *arguments);
  addMethod(*parser, *arguments);
  addTolerance(*parser, arguments->options.tolerance);
  addPatchAngle(*parser, arguments->patchAngle);
  addRepairOptions(*parser, *arguments);
  addQuantization(*parser, arguments->quantize, arguments->quantizeOptions);
  addImprovement(*parser, *arguments);
  parser->add_flag("--no-verify", arguments->noVerify, "Write the mesh without verifying it");
  addReport(*parser, arguments->report,
            "Write a report in JSON: times, counts, quality,\nverification");
  addPage(*parser, arguments->page,
          "Also write a page that shows the mesh in any browser; with\n--improve before and after");
  addRunOptions(*parser, arguments->run);
  parser->footer(
      "The mesh is verified against the map before it is written; with --stream, the file is read\n"
      "again before it gets its name: it must hold what was extracted, and as many cells and\n"
      "vertices as follow from the map. Parts are verified one by one. The same input gives the\n"
      "same bytes with any number of threads.\n\nExample:\n"
      "  hexhex extract sphere.hexex -o sphere.vtu --scale 2 --report sphere.json");
  return {parser, [arguments] { return run(*arguments); }};
}

}  // namespace hexhex::command
