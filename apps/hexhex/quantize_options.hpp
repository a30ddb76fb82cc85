// Options and output of quantization.
#pragma once

#include <array>
#include <string>

#include <CLI/CLI.hpp>

#include <hexhex/quantize.hpp>

#include "shared_options.hpp"

namespace hexhex::command {

/// Adds --cells and --edge-length.
/// @return both
std::array<CLI::Option*, 2> addDensity(CLI::App& parser, QuantizeOptions& options);

/// Adds these, a scale option of this name, and --densify.
/// @return all of them
std::array<CLI::Option*, 4> addQuantizeOptions(CLI::App& parser, QuantizeOptions& options,
                                               const std::string& scaleName);

/// Adds --quantize and the same options, for subcommands that use the resulting map; the scale
/// option is --map-scale.
void addQuantization(CLI::App& parser, bool& quantize, QuantizeOptions& options);

/// "5109 cells of 5000 asked for; 31 arcs of 1 to 26 hexahedra"
[[nodiscard]] std::string quantizeSummary(const QuantizeReport& report);

/// The command that would quantize this map.
[[nodiscard]] QuantizeCall quantizationOf(const MapSource& input);

}  // namespace hexhex::command
