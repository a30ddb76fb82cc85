#include "quantize_options.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/core.h>

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
  CLI::Option* const cells = parser.add_option("--cells", options.cells, "About so many hexahedra")
                                 ->check(whyNotPositive)
                                 ->option_text("NUMBER");
  CLI::Option* const edge = parser
                                .add_option("--edge-length", options.edgeLength,
                                            "Hexahedra with edges of about this length in space")
                                ->check(whyNotPositive)
                                ->option_text("LENGTH");
  cells->excludes(edge);
  return {cells, edge};
}

std::array<CLI::Option*, 4> addQuantizeOptions(CLI::App& parser, QuantizeOptions& options,
                                               const std::string& scaleName) {
  const auto [cells, edge] = addDensity(parser, options);
  CLI::Option* const scale =
      parser
          .add_option(scaleName, options.scale,
                      "Multiply the seamless map's parameters by about so much")
          ->check(whyNotPositive)
          ->option_text("NUMBER");
  scale->excludes(cells)->excludes(edge);
  CLI::Option* const densify =
      parser.add_flag("--densify", options.densify,
                      "If the map cannot be bent onto so few cells: take the\n"
                      "next density that works, and say which");
  return {cells, scale, edge, densify};
}

void addQuantization(CLI::App& parser, bool& quantize, QuantizeOptions& options) {
  CLI::Option* const flag =
      parser.add_flag("--quantize", quantize,
                      "The map is seamless: make it an integer-grid map first, with\n"
                      "--cells, --map-scale or --edge-length (`hexhex quantize --help`)");
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
