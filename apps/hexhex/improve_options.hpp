// Options of improvement, and what it tells.
#pragma once

#include <vector>

#include <CLI/CLI.hpp>

#include <hexhex/improve.hpp>

namespace hexhex::command {

/// Adds --target, --passes, --fix-boundary, --feature-angle, --slack, --pillow and --snap-curves.
/// @return all of them
std::vector<CLI::Option*> addImproveOptions(CLI::App& parser, ImproveOptions& options);

/// Where the vertices of an improved mesh were before, those of a pillow when it was added.
/// @param points  of the mesh before; empty if they are not wanted
[[nodiscard]] Array<Vec3> pointsBefore(Array<Vec3> points, const ImproveReport& report);

/// What happened, in some lines on the standard output; cells that stay bad as a warning.
void printImprovement(const ImproveReport& report);

}  // namespace hexhex::command
