#include "quantize_options.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/core.h>

#include "expected_words.hpp"
#include "output.hpp"

namespace hexhex::command {

namespace {

std::string whyNotPositive(const std::string& text) {
  double value = 0;
  return CLI::detail::lexical_cast(text, value) && value > 0 && std::isfinite(value)
             ? std::string()
             : "'" + text + "' is not a number greater than 0";
}

}  // namespace

std::array<CLI::Option*, 2> addDensity(CLI::App& parser, QuantizeOptions& options) {
  CLI::Option* const cells =
      addValue(parser, "--cells", options.cells, "NUMBER", "Approximate number of hexahedra")
          ->check(whyNotPositive);
  CLI::Option* const edge = addValue(parser, "--edge-length", options.edgeLength, "LENGTH",
                                     "Approximate length of the edges of hexahedra in space")
                                ->check(whyNotPositive);
  cells->excludes(edge);
  return {cells, edge};
}

std::array<CLI::Option*, 4> addQuantizeOptions(CLI::App& parser, QuantizeOptions& options,
                                               const std::string& scaleName) {
  const auto [cells, edge] = addDensity(parser, options);
  CLI::Option* const scale = addValue(parser, scaleName, options.scale, "NUMBER",
                                      "Multiply the seamless map's parameters by about this")
                                 ->check(whyNotPositive);
  scale->excludes(cells)->excludes(edge);
  CLI::Option* const densify =
      parser.add_flag("--densify", options.densify,
                      "If the map cannot be bent onto so few cells, use the next\n"
                      "density that works, and report it");
  return {cells, scale, edge, densify};
}

void addQuantization(CLI::App& parser, bool& quantize, QuantizeOptions& options) {
  CLI::Option* const flag =
      parser.add_flag("--quantize", quantize,
                      "The map is seamless: make it an integer-grid map first;\n"
                      "needs --cells, --map-scale or --edge-length\n(`hexhex quantize --help`)");
  for (CLI::Option* const option : addQuantizeOptions(parser, options, "--map-scale")) {
    option->needs(flag);
  }
}

std::string quantizeSummary(const QuantizeReport& report) {
  std::string text = fmt::format(
      "{} of {:.0f} asked for; {} of {} to {} hexahedra", counted(report.cells, "cell"),
      report.cellsWanted, counted(report.arcs, "arc"), report.shortestArc, report.longestArc);
  if (report.addedTets > 0) {
    text += fmt::format("; {} added to the map by splits", counted(report.addedTets, "tet"));
  }
  return text;
}

QuantizeCall quantizationOf(const MapSource& input) {
  return [command = "`hexhex quantize " + input.description() + " -o integer.hexex --"](
             std::string_view option, std::string_view value) {
    return fmt::format("{}{} {}`", command, option, value);
  };
}

}  // namespace hexhex::command
