// Options and output of map computation from tets.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include <hexhex/fill.hpp>
#include <hexhex/shape.hpp>

#include "json.hpp"

namespace hexhex::command {

/// Adds an argument PART, and --mesher and --tet-size for parts that are not tets.
void addPart(CLI::App& parser, std::string& part, FillOptions& options);
/// Adds --method and --seed.
void addShapeOptions(CLI::App& parser, ShapeOptions& options);

// Print to standard output.
void printFill(const FilledPart& part);
void printShape(const ShapeReport& report);

// docs/user/report.md explains the keys.
[[nodiscard]] Json filledAsJson(const std::string& file, const FilledPart& part);

}  // namespace hexhex::command
