// `hexhex verify`: checks a mesh against its map.
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/core.h>

#include <hexhex/io.hpp>
#include <hexhex/quality.hpp>
#include <hexhex/verify.hpp>

#include "command.hpp"
#include "expected_words.hpp"
#include "json.hpp"
#include "long_run.hpp"
#include "output.hpp"
#include "shared_options.hpp"

namespace hexhex::command {
namespace {

struct VerifyArguments {
  MapSource map;
  std::string mesh;
  VerifyOptions options;
  RunOptions run;
  bool json = false;
};

/// Prints a row per check, with columns as wide as their longest entry.
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

/// Another scale at which the map would have as many cells as the mesh.
std::optional<int> likelyScale(const VerifyReport& report, int scale) {
  const auto isCells = [](const VerifyItem& item) { return item.name == "cells"; };
  const auto cells = std::find_if(report.items.begin(), report.items.end(), isCells);
  if (cells == report.items.end() || cells->passed) return std::nullopt;
  const double expected = std::stod(cells->expected) / std::pow(scale, 3);
  const double found = std::stod(cells->found);
  const double likely = std::round(std::cbrt(found / expected));
  constexpr double kMost = 1e6;  // cubes of larger numbers would be too inexact
  if (!(likely >= 1 && likely < kMost) || expected * std::pow(likely, 3) != found) {
    return std::nullopt;
  }
  return static_cast<int>(likely);
}

struct Comparison {
  VerifyReport report;
  Certificate certificate;  ///< a cell may be in the right place and still be invalid
};

Comparison compare(const VerifyArguments& arguments) {
  LongRun longRun(arguments.run, {{"readMap", 0.05},
                                  {"readMapPair", 0.05},
                                  {"readHexMesh", 3},
                                  {"verify", 2.5},
                                  {"certify", 0.5}});
  Context& context = longRun.context();
  const TetMap map = readMap(arguments.map, context);
  const HexMesh mesh = readHexMesh(arguments.mesh, context);
  Comparison result;
  result.report = verify(map, mesh, arguments.options, context);
  if (arguments.json || !arguments.run.quiet) result.certificate = certify(mesh, context);
  longRun.finish();
  return result;
}

int run(const VerifyArguments& arguments) {
  const Comparison result = compare(arguments);
  const std::optional<int> scale = likelyScale(result.report, arguments.options.scale);
  if (arguments.json) {
    Json json = verificationAsJson(result.report);
    json["scale"] = arguments.options.scale;
    json["likely_scale"] = scale ? Json(*scale) : Json(nullptr);
    json["quality"] = qualityAsJson(result.certificate);
    json["validity"] = validityAsJson(result.certificate);
    fmt::print("{}", jsonText(json));
  } else if (!arguments.run.quiet) {
    printTable(result.report);
    if (scale) fmt::print("This looks like scale {}: try --scale {}.\n", *scale, *scale);
    printQuality(result.certificate);
    if (result.certificate.refuted > 0) printWarning(refutationAsText(result.certificate));
  }
  return result.report.passed() ? kSuccess : kFailure;
}

}  // namespace

Command addVerify(CLI::App& app) {
  const auto arguments = std::make_shared<VerifyArguments>();
  arguments->options.countElements = true;
  CLI::App* const parser =
      app.add_subcommand("verify", "Compare a hexahedral mesh with the map that it came from");
  addMapSourceBefore(*parser, arguments->map, "MAP", mapDescription(), arguments->mesh, "MESH",
                     "The mesh, in any format that is read");
  addScale(*parser, arguments->options.scale, "The scale that the mesh was extracted with");
  addTolerance(*parser, arguments->options.tolerance);
  addValue(*parser, "--digits", arguments->options.digits, "INTEGER",
           "Significant digits of the mesh's coordinates, 1 to 17;\n"
           "by default 7 if all are single-precision numbers, else 17")
      ->check(CLI::Range(1, 17));
  addJson(*parser, arguments->json);
  addRunOptions(*parser, arguments->run, "Print nothing but errors: the exit code is the answer");
  parser->footer(
      "Exit code 0: they agree; 4: they do not.\n\nExample:\n"
      "  hexhex verify sphere.hexex sphere.vtu --scale 2");
  return {parser, [arguments] { return run(*arguments); }};
}

}  // namespace hexhex::command
