// `hexhex extract`: extracts a verified hexahedral mesh from a map.
#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <hexhex/error.hpp>
#include <hexhex/io.hpp>
#include <hexhex/partial.hpp>
#include <hexhex/parts.hpp>
#include <hexhex/quantize.hpp>

#include "command.hpp"
#include "extract_arguments.hpp"
#include "extract_report.hpp"
#include "extract_run.hpp"
#include "json.hpp"
#include "long_run.hpp"
#include "map_text.hpp"
#include "output.hpp"
#include "quantize_options.hpp"
#include "shared_options.hpp"
#include "started_team.hpp"

namespace hexhex::command {
namespace {

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
  std::vector<WorkStep> steps = {{"readMap", 0.05}, {"readMapPair", 0.05}};
  if (arguments.quantize) steps.push_back({"quantize", 20});
  const std::vector<WorkStep> others = extractionSteps(arguments);
  steps.insert(steps.end(), others.begin(), others.end());
  LongRun longRun(arguments.run, std::move(steps));
  requireOutputs(arguments);
  Report report(arguments.report);
  ExtractionRecord record;
  Extraction extraction(arguments, longRun, record);
  const TetMap map = readForTeam(arguments, longRun, record);
  try {
    extraction.run(map);
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
