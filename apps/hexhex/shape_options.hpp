// Options of maps that are made of tets alone, and what they tell.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include <hexhex/shape.hpp>

namespace hexhex::command {

/// Adds an argument PART.
void addPart(CLI::App& parser, std::string& part);
/// Adds --method and --seed.
void addShapeOptions(CLI::App& parser, ShapeOptions& options);

/// Some lines on the standard output.
void printShape(const ShapeReport& report);

}  // namespace hexhex::command
