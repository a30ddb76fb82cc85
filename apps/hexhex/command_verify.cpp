// `hexhex verify`: does a mesh agree with its map?
#include <algorithm>
#include <memory>
#include <string_view>

#include <fmt/core.h>

#include <hexhex/io.hpp>
#include <hexhex/quality.hpp>
#include <hexhex/verify.hpp>

#include "command.hpp"
#include "exit_codes.hpp"
#include "interrupt.hpp"
#include "output.hpp"
#include "progress.hpp"
#include "shared_options.hpp"

namespace hexhex::command {
namespace {

struct Arguments {
  MapSource map;
  std::string mesh;
  VerifyOptions options;
  int threads = 0;
  bool quiet = false;
};

/// One row per check, columns as wide as their longest entry.
void printTable(const VerifyReport& report) {
  const VerifyItem head{"check", "expected", "found", true};
  std::size_t nameWidth = head.name.size();
  std::size_t expectedWidth = head.expected.size();
  std::size_t foundWidth = head.found.size();
  for (const VerifyItem& item : report.items) {
    nameWidth = std::max(nameWidth, item.name.size());
    expectedWidth = std::max(expectedWidth, item.expected.size());
    foundWidth = std::max(foundWidth, item.found.size());
  }
  const auto printRow = [&](const VerifyItem& item, std::string_view result) {
    fmt::print("{:<{}}  {:<{}}  {:<{}}  {}\n", item.name, nameWidth, item.expected, expectedWidth,
               item.found, foundWidth, result);
  };
  printRow(head, "result");
  for (const VerifyItem& item : report.items) printRow(item, item.passed ? "ok" : "FAILED");
  fmt::print("The mesh {} with the map.\n", report.passed() ? "agrees" : "does not agree");
}

struct Comparison {
  VerifyReport report;
  Certificate certificate;  ///< a cell may be where it belongs and yet not be valid
};

Comparison compare(const Arguments& arguments) {
  ProgressDisplay progress(arguments.quiet);
  Context context(arguments.threads, progress.callback());
  const CancelOnSignal cancelOnSignal(context);
  const TetMap map = readMap(arguments.map, context);
  const HexMesh mesh = readHexMesh(arguments.mesh, context);
  Comparison result;
  result.report = verify(map, mesh, arguments.options, context);
  if (!arguments.quiet) result.certificate = certify(mesh, context);
  return result;
}

int run(const Arguments& arguments) {
  const Comparison result = compare(arguments);
  if (!arguments.quiet) {
    printTable(result.report);
    printQuality(result.certificate);
    if (result.certificate.refuted > 0) printWarning(refutationAsText(result.certificate));
  }
  return result.report.passed() ? kSuccess : kFailure;
}

}  // namespace

Command addVerify(CLI::App& app) {
  const auto arguments = std::make_shared<Arguments>();
  arguments->options.countElements = true;
  CLI::App* const parser =
      app.add_subcommand("verify", "Compare a hexahedral mesh with the map that it came from");
  addMapSourceBefore(*parser, arguments->map, "MAP", arguments->mesh, "MESH",
                     "The mesh, in any format that is read");
  addScale(*parser, arguments->options.scale, "The scale that the mesh was extracted with");
  addTolerance(*parser, arguments->options.tolerance);
  parser
      ->add_option("--digits", arguments->options.digits,
                   "Significant digits of the mesh's coordinates\n"
                   "(default: 7 if all are single-precision numbers, otherwise 17)")
      ->check(CLI::Range(1, 17));
  addThreads(*parser, arguments->threads);
  addQuiet(*parser, arguments->quiet, "Print nothing but errors: the exit code tells");
  parser->footer(
      "Exit code 0: they agree; 4: they do not.\n\nExample:\n"
      "  hexhex verify sphere.hexex sphere.vtu --scale 2");
  return {parser, [arguments] { return run(*arguments); }};
}

}  // namespace hexhex::command
