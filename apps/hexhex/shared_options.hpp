// Options that several subcommands have, and checks with messages that people understand.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace hexhex::command {

/// Accepts whole numbers from `minimum` that fit in an int.
[[nodiscard]] CLI::Validator wholeNumberFrom(int minimum);

/// For options and arguments that name a map to read.
[[nodiscard]] std::string mapDescription();

void addScale(CLI::App& parser, int& scale, const std::string& description);
void addThreads(CLI::App& parser, int& threads);
void addTolerance(CLI::App& parser, double& tolerance);
void addRound(CLI::App& parser, bool& round);

}  // namespace hexhex::command
