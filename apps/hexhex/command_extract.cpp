// `hexhex extract`: from a map to a verified hexahedral mesh.
#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include <fmt/core.h>

#include <hexhex/error.hpp>
#include <hexhex/extract.hpp>
#include <hexhex/io.hpp>
#include <hexhex/partial.hpp>
#include <hexhex/quality.hpp>
#include <hexhex/verify.hpp>

#include "command.hpp"
#include "exit_codes.hpp"
#include "extract_stream.hpp"
#include "interrupt.hpp"
#include "output.hpp"
#include "progress.hpp"
#include "repair_text.hpp"
#include "report.hpp"
#include "shared_options.hpp"
#include "verification.hpp"

namespace hexhex::command {
namespace {

struct Arguments {
  std::string input;
  std::string output;
  std::string report;
  ExtractOptions options;
  double patchAngle = WriteOptions{}.patchAngle;
  int threads = 0;
  bool stream = false;
  bool partial = false;
  bool noVerify = false;
  bool quiet = false;
};

/// Whether two names mean one file, or would once both are written.
bool sameFile(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code missing;
  if (std::filesystem::equivalent(a, b, missing)) return !std::filesystem::is_other(a, missing);
  const auto whole = [](const std::filesystem::path& file) {
    std::error_code error;
    std::filesystem::path path =
        std::filesystem::weakly_canonical(std::filesystem::absolute(file), error);
    return error ? file : path;
  };
  return whole(a) == whole(b) && !std::filesystem::is_other(a, missing);
}

void requireDifferent(const std::filesystem::path& a, const std::filesystem::path& b) {
  if (!sameFile(a, b)) return;
  throw Error(ErrorCode::InvalidArgument, a.string() + " and " + b.string() +
                                              " are the same file. Input, mesh and report need "
                                              "files of their own.");
}

/// Everything that can be known to fail before long work.
void requireOutputs(const Arguments& arguments) {
  requireDifferent(arguments.input, arguments.output);
  if (!arguments.report.empty()) {
    requireDifferent(arguments.input, arguments.report);
    requireDifferent(arguments.output, arguments.report);
  }
  requireHexMeshFormat(arguments.output);
  requireWritable(arguments.output);
  if (arguments.partial && arguments.stream) {
    throw Error(
        ErrorCode::InvalidArgument,
        "--partial needs the whole mesh in memory. Leave out one of --stream and --partial.");
  }
  if (arguments.stream) requireStreamable(arguments.output, arguments.options);
  if (!arguments.report.empty()) requireWritable(arguments.report);
}

void printWarnings(const ExtractionRecord& record, const TetMap& map) {
  const ExtractStatistics& statistics = record.statistics;
  if (record.streamed && !(map.features.empty() && map.regions.empty())) {
    printWarning(
        "The tags and regions of the map are not in the mesh; leave out --stream for them.");
  }
  if (statistics.repair.changed) printWarning(repairNotice(statistics.repair));
  if (statistics.tetsInvertedInSpace > 0) {
    printWarning(counted(statistics.tetsInvertedInSpace, "tet") +
                 " of the input are inverted in space. The mesh has the right connectivity, but "
                 "cells there may be inverted, too.");
  }
  if (statistics.mirrored) {
    printWarning("The map reverses orientation; it was mirrored before the extraction.");
  }
  if (statistics.epsilonFallback) {
    printWarning(
        "Epsilon was too small, so that the whole bounding boxes were searched: the "
        "result is right but took longer. Try a larger --epsilon.");
  }
}

std::string verificationAsText(const ExtractionRecord& record) {
  if (!record.verification) return "skipped";
  std::string passed =
      fmt::format("passed, {}", counted(record.verification->items.size(), "check"));
  if (!record.streamed) return passed;
  return passed + " of counts and checksums, in the file as it was read back";
}

void printSummary(const ExtractionRecord& record) {
  const ExtractStatistics& statistics = record.statistics;
  fmt::print("{} -> {}\n", record.input.file.string(), record.output.file.string());
  printLine("map", fmt::format("{}, {}, {} of {} with a chart jump", counted(record.tets, "tet"),
                               counted(record.points, "point"), statistics.chartJumps,
                               counted(statistics.innerFaces, "inner face")));
  printLine(
      "mesh",
      fmt::format("{}, {}", counted(record.cells, "cell"),
                  record.vertices == 1 ? "1 vertex" : fmt::format("{} vertices", record.vertices)));
  if (record.tags != std::array<std::uint64_t, 3>{}) {
    printLine(
        "tagged",
        fmt::format("{}, {}, {}",
                    record.tags[0] == 1 ? "1 vertex" : fmt::format("{} vertices", record.tags[0]),
                    counted(record.tags[1], "edge"), counted(record.tags[2], "quad")));
  }
  if (record.engine != Engine::Atlas) printLine("engine", engineName(record.engine));
  printLine("extraction",
            fmt::format("{:.3f} s on {}{}, peak memory {}", statistics.seconds,
                        counted(static_cast<std::uint64_t>(statistics.threads), "thread"),
                        record.streamed ? ", writing included" : "", bytesAsText(peakMemory())));
  if (statistics.repair.changed) {
    printLine("repair", fmt::format("{:.3f} s, {}", statistics.repair.seconds,
                                    counted(statistics.repair.regions.size(), "place")));
  }
  if (record.quality) printLine("scaled Jacobian", qualityAsText(*record.quality));
  printLine("verification", verificationAsText(record));
  if (record.streamed) {
    printLine("checksum of cells", checksumAsText(record.streamed->cellChecksum));
    printLine("checksum of vertices", checksumAsText(record.streamed->pointChecksum));
  }
  printLine("file", bytesAsText(record.output.bytes));
}

/// Extracts, verifies and writes a mesh in memory.
void extractWhole(const Arguments& arguments, const TetMap& map, Context& context,
                  ExtractionRecord& record) {
  const HexMesh mesh = extract(map, arguments.options, context, &record.statistics);
  const TetMapView extracted = extractedMap(map, record.statistics);
  if (!arguments.noVerify) {
    record.verification =
        verify(extracted, mesh, {arguments.options.scale, arguments.options.tolerance}, context);
    requirePassed(*record.verification, "The mesh does not agree with the map and was not written",
                  "Please report this with the map.");
  }
  const Array<double> quality = scaledJacobians(mesh, context);
  record.quality = summarize(quality);
  WriteOptions options;
  options.scaledJacobians = quality;
  options.patchAngle = arguments.patchAngle;
  writeHexMesh(mesh, arguments.output, options, context);
  record.tags = {mesh.features.vertices.size(), mesh.features.edges.size(),
                 mesh.features.quads.size()};
  record.vertices = mesh.points.size();
  record.cells = mesh.cells.size();
}

/// The same in pieces, verified after it was written.
void extractInPieces(const Arguments& arguments, const TetMap& map, Context& context,
                     ExtractionRecord& record) {
  StreamedMesh mesh = extractStreamed(map, arguments.output, arguments.options, !arguments.noVerify,
                                      context, record.statistics);
  record.verification = std::move(mesh.verification);
  record.vertices = mesh.written.points;
  record.cells = mesh.written.cells;
  record.streamed = mesh.written;
}

void printHoles(const PartialMesh& partial) {
  constexpr std::size_t kMaxListed = 20;
  for (std::size_t i = 0; i < std::min(partial.holes.size(), kMaxListed); ++i) {
    const Hole& hole = partial.holes[i];
    printLine(fmt::format("hole at tet {}", hole.tet),
              fmt::format("about {:.2f} cells missing near ({:.4g}, {:.4g}, {:.4g}), in {}, {} of "
                          "them invalid",
                          hole.missingCells, hole.position[0], hole.position[1], hole.position[2],
                          counted(hole.tets, "tet"), hole.invalidTets));
  }
  if (partial.holes.size() > kMaxListed) {
    printLine("and", fmt::format("{} smaller holes", partial.holes.size() - kMaxListed));
  }
}

/// What is left of a map beyond repair. Always an invalid map, by its exit code.
int extractWhatIsValid(const Arguments& arguments, const TetMap& map, const Error& problem,
                       Context& context, ProgressDisplay& progress) {
  const PartialMesh partial =
      extractPartial(map, {arguments.options.scale, arguments.options.tolerance}, context);
  WriteOptions options;
  options.patchAngle = arguments.patchAngle;
  writeHexMesh(partial.mesh, arguments.output, options, context);
  progress.clear();
  printError(problem);
  if (arguments.quiet) return kInvalidMap;
  printWarning("Only a part of the mesh was extracted, as --partial asks for.");
  fmt::print("{} -> {}\n", arguments.input, arguments.output);
  const auto atHole =
      std::count(partial.mesh.regions.begin(), partial.mesh.regions.end(), std::int32_t{1});
  printLine("mesh", fmt::format("{}, {} of them at holes (region 1)",
                                counted(partial.mesh.cells.size(), "cell"), atHole));
  printLine("missing", fmt::format("about {:.1f} cells, at {} with {}", partial.missingCells,
                                   counted(partial.holes.size(), "hole"),
                                   counted(partial.invalidTets, "invalid tet")));
  printLine("local verification",
            fmt::format("every cell is filled by valid tets; {} do not fit together",
                        counted(partial.faceConflicts, "face")));
  printHoles(partial);
  return kInvalidMap;
}

int run(const Arguments& arguments) {
  requireOutputs(arguments);
  ProgressDisplay progress(arguments.quiet);
  Context context(arguments.threads, progress.callback());
  const CancelOnSignal cancelOnSignal(context);

  const TetMap map = readMap(arguments.input, context);
  ExtractionRecord record;
  try {
    (arguments.stream ? extractInPieces : extractWhole)(arguments, map, context, record);
  } catch (const Error& error) {
    if (!arguments.partial || exitCodeOf(error.code()) != kInvalidMap) throw;
    return extractWhatIsValid(arguments, map, error, context, progress);
  }
  progress.clear();

  std::error_code unknown;  // the size of a pipe
  record.input = {arguments.input, std::filesystem::file_size(arguments.input, unknown)};
  record.output = {arguments.output, std::filesystem::file_size(arguments.output, unknown)};
  record.scale = arguments.options.scale;
  record.engine = arguments.options.engine;
  record.points = map.points.size();
  record.tets = map.tets.size();
  record.stages = context.stageTimes();
  if (!arguments.report.empty()) writeTextFile(arguments.report, reportAsJson(record));
  if (!arguments.quiet) {
    printWarnings(record, map);
    printSummary(record);
  }
  return kSuccess;
}

/// What happens to maps that are not valid.
void addRepairOptions(CLI::App& parser, Arguments& arguments) {
  parser
      .add_option("--repair", arguments.options.repair,
                  "auto: mend flipped and flat tets of the map first, with a\n"
                  "notice; off: they are an error. Valid maps pay nothing")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, RepairMode>{{"auto", RepairMode::Auto}, {"off", RepairMode::Off}}))
      ->option_text("MODE [auto]");
  addRound(parser, arguments.options.round);
  parser.add_flag("--partial", arguments.partial,
                  "Write what can be extracted of a map beyond repair, cells\n"
                  "at holes as region 1, and list the holes; exit code 1");
}

/// Options that change how a mesh is made, but not the mesh.
void addMethod(CLI::App& parser, Arguments& arguments) {
  addThreads(parser, arguments.threads);
  parser
      .add_option("--engine", arguments.options.engine,
                  "atlas: reads cells off a picture of the map and traces\n"
                  "few; propeller: the algorithm of the paper. Both give\n"
                  "the same mesh, bit for bit")
      ->transform(CLI::CheckedTransformer(std::map<std::string, Engine>{
          {"atlas", Engine::Atlas}, {"propeller", Engine::Propeller}}))
      ->option_text("ENGINE [atlas]");
  parser
      .add_option("--epsilon", arguments.options.epsilon,
                  "Enlargement of tets while the propeller engine searches\n"
                  "lattice points, in parameter units; inf is legal. Never\n"
                  "changes the result, only the time")
      ->option_text("NUMBER [1e-6]");
  parser.add_flag("--stream", arguments.stream,
                  "Write the mesh piece by piece, .vtu or .mesh, for meshes\n"
                  "larger than the memory. Nothing that takes the whole mesh:\n"
                  "no scaled Jacobians, no boundary quads, and verified by\n"
                  "counts and checksums, by reading the file again");
}

}  // namespace

Command addExtract(CLI::App& app) {
  const auto arguments = std::make_shared<Arguments>();
  arguments->options.repair = RepairMode::Auto;
  CLI::App* const parser = app.add_subcommand("extract", "Extract the hexahedral mesh of a map");
  parser->add_option("MAP", arguments->input, mapDescription())
      ->required()
      ->option_text("FILE REQUIRED");
  parser
      ->add_option("-o,--output", arguments->output,
                   "The mesh to write, .mesh, .vtu, .ovm or .ovmb")
      ->required()
      ->option_text("FILE REQUIRED");
  addScale(*parser, arguments->options.scale,
           "Multiply all parameters by this integer: its cube as\nmany cells");
  addMethod(*parser, *arguments);
  addTolerance(*parser, arguments->options.tolerance);
  parser
      ->add_option("--patch-angle", arguments->patchAngle,
                   "Where the map tags no faces, group boundary quads by\npatches that turn by at "
                   "most this angle in degrees\nbetween neighbours; 0: one group")
      ->check(CLI::Range(0, 180))
      ->option_text("DEGREES [40]");
  addRepairOptions(*parser, *arguments);
  parser->add_flag("--no-verify", arguments->noVerify, "Write the mesh without verifying it");
  parser
      ->add_option("--report", arguments->report,
                   "Write a report in JSON: times, counts, quality,\nverification")
      ->option_text("FILE");
  parser->add_flag("--quiet", arguments->quiet, "Print nothing but errors");
  parser->footer(
      "The mesh is verified against the map before it is written; with --stream, the file is read\n"
      "again before it gets its name: it must hold what was extracted, and as many cells and\n"
      "vertices as follow from the map. The same input gives the same bytes with any number of\n"
      "threads.\n\nExample:\n"
      "  hexhex extract sphere.hexex -o sphere.vtu --scale 2 --report sphere.json");
  return {parser, [arguments] { return run(*arguments); }};
}

}  // namespace hexhex::command
