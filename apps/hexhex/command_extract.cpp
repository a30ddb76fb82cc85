// `hexhex extract`: extracts a verified hexahedral mesh from a map.
#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include <fmt/core.h>

#include <hexhex/curved.hpp>
#include <hexhex/error.hpp>
#include <hexhex/extract.hpp>
#include <hexhex/extractor.hpp>
#include <hexhex/improve.hpp>
#include <hexhex/io.hpp>
#include <hexhex/partial.hpp>
#include <hexhex/patches.hpp>
#include <hexhex/quality.hpp>
#include <hexhex/quantize.hpp>
#include <hexhex/verify.hpp>

#include "command.hpp"
#include "extract_arguments.hpp"
#include "extract_parts.hpp"
#include "extract_report.hpp"
#include "extract_stream.hpp"
#include "improve_options.hpp"
#include "json.hpp"
#include "long_run.hpp"
#include "map_text.hpp"
#include "output.hpp"
#include "quantize_options.hpp"
#include "shared_options.hpp"
#include "started_team.hpp"
#include "view_page.hpp"

namespace hexhex::command {
namespace {

/// The options; the record receives the repaired map.
ExtractOptions optionsOf(const ExtractArguments& arguments, ExtractionRecord& record) {
  ExtractOptions options = arguments.options;
  if (arguments.repair) options.repair = &record.repaired;
  return options;
}

/// Creates the extractor, which repairs the map if requested.
Extractor prepareExtractor(const ExtractArguments& arguments, const TetMap& map, LongRun& longRun,
                           ExtractionRecord& record) {
  const ExtractOptions options = optionsOf(arguments, record);
  // If the product overflows, the extraction reports it.
  const bool fits = options.scale <= std::numeric_limits<int>::max() / arguments.order;
  const int maxScale = fits ? options.scale * arguments.order : options.scale;
  return longRun.part("extraction", [&] {
    return Extractor(map, {options.tolerance, maxScale, options.repair, options.round},
                     longRun.context());
  });
}

void verifyMesh(const ExtractArguments& arguments, Extractor& extractor, const HexMesh& mesh,
                LongRun& longRun, ExtractionRecord& record) {
  if (arguments.noVerify) return;
  record.verification = longRun.part("verification", [&] {
    return extractor.verify(mesh, {.scale = arguments.options.scale}, longRun.context());
  });
  requirePassed(*record.verification, "The mesh does not agree with the map and was not written",
                "Please report this with the map.");
}

/// Extracts the mesh with the requested arcs and patches.
PiecewiseLinearMesh extractWithCurves(const ExtractArguments& arguments, Extractor& extractor,
                                      Context& context, ExtractionRecord& record) {
  if (arguments.arcs.empty() && arguments.patches.empty()) {
    return {extractor.extract(arguments.options, context, &record.statistics), {}, {}};
  }
  const auto parts =
      arguments.patches.empty() ? PiecewiseLinearParts::Arcs : PiecewiseLinearParts::ArcsAndPatches;
  return extractor.extractPiecewiseLinear(parts, arguments.options, context, &record.statistics);
}

/// Improves the mesh if requested; otherwise only certifies its quality.
/// @param mesh  straight or curved
/// @return the points before improvement, if a page shows them; otherwise empty
Array<Vec3> improveOrCertify(const ExtractArguments& arguments, const TetMap& map, auto& mesh,
                             LongRun& longRun, ExtractionRecord& record) {
  Context& context = longRun.context();
  if (!arguments.improve) {
    record.certificate = longRun.part("quality", [&] { return certify(mesh, context); });
    return {};
  }
  Array<Vec3> before = arguments.page.empty() ? Array<Vec3>() : mesh.points;
  record.improved = longRun.part("improvement", [&] {
    return improve(mesh, extractedMap(map, &record.repaired), arguments.improveOptions, context);
  });
  record.certificate = record.improved->after;
  return pointsBefore(std::move(before), *record.improved);
}

/// @param mesh  straight or curved  @param before  the result of improveOrCertify()
void writeMeshPage(const ExtractArguments& arguments, const auto& mesh, const Array<Vec3>& before,
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

/// Lists the boundary if the mesh is small or this was requested: it takes 0.7 of 6 s for six
/// million cells.
/// @param mesh  straight or curved
void noteBoundary(const ExtractArguments& arguments, const auto& mesh, LongRun& longRun,
                  ExtractionRecord& record) {
  constexpr std::size_t kFew = 100'000;
  if (record.certificate->validity.size() > kFew && !arguments.patchAngle.isGiven) return;
  if (arguments.run.quiet && arguments.report.empty()) return;
  record.boundary = longRun.part("quality", [&] {
    const double angle = arguments.patchAngle.degrees;
    if constexpr (std::is_same_v<std::decay_t<decltype(mesh)>, LagrangeMesh>) {
      return namedPatches(straightMesh(mesh), angle, longRun.context());
    } else {
      return namedPatches(mesh, angle, longRun.context());
    }
  });
}

/// Improves, examines and writes a verified mesh, straight or curved.
void finishMesh(const ExtractArguments& arguments, const TetMap& map, auto& mesh, LongRun& longRun,
                ExtractionRecord& record) {
  Context& context = longRun.context();
  const Array<Vec3> before = improveOrCertify(arguments, map, mesh, longRun, record);
  WriteOptions writing = arguments.choice.options();
  writing.scaledJacobians = record.certificate->scaledJacobians;
  writing.patchAngle = arguments.patchAngle.degrees;
  longRun.part("writing",
               [&] { writeNamed(arguments.names, mesh, arguments.output, writing, context); });
  noteBoundary(arguments, mesh, longRun, record);
  writeMeshPage(arguments, mesh, before, longRun, record);
  record.tags = {mesh.features.vertices.size(), mesh.features.edges.size(),
                 mesh.features.quads.size()};
}

/// Extracts, verifies and writes a mesh in memory.
void extractWhole(const ExtractArguments& arguments, const TetMap& map, LongRun& longRun,
                  ExtractionRecord& record) {
  Context& context = longRun.context();
  std::optional<Extractor> extractor = prepareExtractor(arguments, map, longRun, record);
  PiecewiseLinearMesh all = longRun.part(
      "extraction", [&] { return extractWithCurves(arguments, *extractor, context, record); });
  HexMesh& mesh = all.mesh;
  verifyMesh(arguments, *extractor, mesh, longRun, record);
  extractor.reset();  // frees its memory for the next steps
  if (!arguments.arcs.empty()) {
    longRun.part("writing", [&] {
      writeArcs(all, extractedMap(map, &record.repaired), arguments.arcs, context);
    });
    record.arcs = {arguments.arcs, all.arcs.count(), all.arcs.points.size()};
  }
  if (!arguments.patches.empty()) {
    longRun.part("writing", [&] {
      writePatches(all, extractedMap(map, &record.repaired), arguments.patches, context);
    });
    record.patches = {arguments.patches, all.patches.count(), all.patches.polygonTet.size()};
  }
  finishMesh(arguments, map, mesh, longRun, record);
  record.vertices = mesh.points.size();
  record.cells = mesh.cells.size();
}

/// The same for cells of higher order.
void extractCurved(const ExtractArguments& arguments, const TetMap& map, LongRun& longRun,
                   ExtractionRecord& record) {
  Context& context = longRun.context();
  std::optional<Extractor> extractor = prepareExtractor(arguments, map, longRun, record);
  LagrangeMesh mesh = longRun.part("extraction", [&] {
    return extractor->extractLagrange(arguments.order, arguments.options, context,
                                      &record.statistics);
  });
  record.straightenedCells = mesh.straightenedCells;
  verifyMesh(arguments, *extractor, straightMesh(mesh), longRun, record);
  extractor.reset();
  finishMesh(arguments, map, mesh, longRun, record);
  record.vertices = mesh.vertexCount;
  record.cells = mesh.cellCount();
  record.nodes = mesh.points.size();
}

/// Extracts and writes a mesh in pieces, and verifies the file.
void extractInPieces(const ExtractArguments& arguments, const TetMap& map, LongRun& longRun,
                     ExtractionRecord& record) {
  StreamedMesh mesh = extractStreamed(map, arguments.output, arguments.choice.options(),
                                      optionsOf(arguments, record), !arguments.noVerify, longRun,
                                      record.statistics);
  record.verification = std::move(mesh.verification);
  record.vertices = mesh.written.points;
  record.cells = mesh.written.cells;
  record.streamed = mesh.written;
}

/// Extracts and writes a mesh in parts.
void extractAllParts(const ExtractArguments& arguments, const TetMap& map, LongRun& longRun,
                     ExtractionRecord& record) {
  WriteOptions options = arguments.choice.options();
  options.patchAngle = arguments.patchAngle.degrees;
  PartOptions parts = arguments.parts.chosen();
  parts.verify = !arguments.noVerify;
  record.meshParts = longRun.part("extraction", [&] {
    return extractInParts(map, arguments.output, options, optionsOf(arguments, record), parts,
                          arguments.team, longRun.context(), record.statistics);
  });
  record.vertices = record.meshParts->summary.vertices;
  record.cells = record.meshParts->summary.cells;
}

/// Extracts the valid part of a map beyond repair. The exit code is always that of an invalid map.
int extractWhatIsValid(const ExtractArguments& arguments, const TetMap& map, const Error& problem,
                       LongRun& longRun, Report& report) {
  Context& context = longRun.context();
  const PartialMesh partial =
      extractPartial(map, {arguments.options.scale, arguments.options.tolerance}, context);
  WriteOptions options = arguments.choice.options();
  options.patchAngle = arguments.patchAngle.degrees;
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

/// The library functions that a run calls; weights are their seconds for a mesh of seven million
/// cells.
std::vector<WorkStep> stepsOf(const ExtractArguments& arguments) {
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
                {"namedPatches", 0.2},
                {"writeHexMesh", 1},
                {"writeLagrangeMesh", 4},
                {"writeViewPage", 10}};
  steps.insert(steps.end(), rest.begin(), rest.end());
  return steps;
}

TetMap readAndQuantize(const ExtractArguments& arguments, LongRun& longRun,
                       ExtractionRecord& record) {
  TetMap map = longRun.part("reading", [&] { return readMap(arguments.input, longRun.context()); });
  if (!arguments.quantize) return map;
  QuantizedMap quantized = longRun.part(
      "quantization", [&] { return quantize(map, arguments.quantizeOptions, longRun.context()); });
  record.quantized = std::move(quantized.report);
  return std::move(quantized.map);
}

/// In a team, the first process reads the map and broadcasts it.
TetMap readForTeam(const ExtractArguments& arguments, LongRun& longRun, ExtractionRecord& record) {
  if (arguments.team == nullptr) return readAndQuantize(arguments, longRun, record);
  const bool reads = arguments.team->rank() == 0;
  TetMap read = reads ? readAndQuantize(arguments, longRun, record) : TetMap{};
  TetMap shared = longRun.part("broadcast", [&] { return shareMap(*arguments.team, read); });
  return reads ? std::move(read) : std::move(shared);
}

/// Fills in what the steps have not recorded.
void fillRecord(const ExtractArguments& arguments, const TetMap& map, LongRun& longRun,
                ExtractionRecord& record) {
  std::error_code unknown;  // a pipe has no size
  record.input.file = arguments.input.description();
  for (const std::filesystem::path& file : arguments.input.files()) {
    record.input.bytes += std::filesystem::file_size(file, unknown);
  }
  record.output.file = arguments.output;
  record.page = arguments.page;
  const auto bytes = std::filesystem::file_size(arguments.output, unknown);
  if (!unknown) record.output.bytes = bytes;  // the files of parts may have other names
  record.order = arguments.order;
  record.curvedNodes = arguments.options.curvedNodes;
  record.scale = arguments.options.scale;
  record.engine = arguments.options.engine;
  record.points = map.points.size();
  record.tets = map.tets.size();
  record.stages = longRun.context().stageTimes();
  record.parts = longRun.parts();
  record.partsAsText = longRun.partsAsText();
}

int extractMesh(const ExtractArguments& arguments) {
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
      if (arguments.quantize) throw;
      throw withAdvice(error, map, quantizationOf(arguments.input), longRun.context());
    }
    return extractWhatIsValid(arguments, map, error, longRun, report);
  }
  longRun.finish();
  fillRecord(arguments, map, longRun, record);
  if (report.isWanted()) report.write(reportAsJson(record));
  if (arguments.run.quiet) return kSuccess;
  printWarnings(record, map);
  if (arguments.stream || arguments.parts.parts) {
    arguments.patchAngle.warnIfGiven(
        "smooth patches are those of a mesh that is whole; leave out --stream and --parts");
  } else if (record.boundary && !arguments.names.isGiven()) {
    arguments.patchAngle.warnIfUseless(*record.boundary, arguments.output,
                                       arguments.choice.options());
  }
  if (!report.isOnOutput()) printSummary(record);
  return kSuccess;
}

/// The options that must agree across a team: all except those that are per process, or that only
/// the first process uses.
std::string commonOptions(const CLI::App& parser) {
  constexpr std::array<std::string_view, 5> kOwn = {"--threads", "--verbose", "--quiet", "--report",
                                                    "--mpi"};
  std::string text;
  for (const CLI::Option* const option : parser.get_options()) {
    const std::string name = option->get_name();
    if (option->count() == 0 || std::find(kOwn.begin(), kOwn.end(), name) != kOwn.end()) continue;
    if (name.starts_with('-')) text += name + ' ';
    if (option->get_expected_max() == 0) continue;  // a flag
    for (const std::string& value : option->results()) text += value + ' ';
  }
  text.pop_back();  // not empty: map and output are mandatory
  return text;
}

int run(const ExtractArguments& given, const CLI::App& parser) {
  if (!isInTeam(given.parts.mpi)) return extractMesh(given);
  const StartedTeam started;
  ExtractArguments arguments = given;
  arguments.team = &started.team();
  if (!arguments.parts.parts) arguments.parts.parts = arguments.team->size();
  if (arguments.run.threads == 0) arguments.run.threads = threadsInTeam();
  const bool speaks = arguments.team->rank() == 0;
  if (!speaks) {
    arguments.report.clear();
    arguments.run.quiet = true;
  }
  try {
    arguments.team->run([&] {
      arguments.team->requireSame(commonOptions(parser), "command line");
      static_cast<void>(extractMesh(arguments));
    });
  } catch (const Error& error) {
    // Print before this process exits: mpirun then stops the others.
    if (speaks) printError(error, sentenceOf(error));
    return exitCodeOf(error.code());
  }
  return kSuccess;
}

}  // namespace

Command addExtract(CLI::App& app) {
  const auto arguments = std::make_shared<ExtractArguments>();
  CLI::App* const parser = app.add_subcommand("extract", "Extract the hexahedral mesh of a map");
  addExtractOptions(*parser, *arguments);
  return {parser, [arguments, parser] { return run(*arguments, *parser); }};
}

}  // namespace hexhex::command
