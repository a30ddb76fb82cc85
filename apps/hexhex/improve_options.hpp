// Options and output of improvement.
#pragma once

#include <vector>

#include <CLI/CLI.hpp>

#include <hexhex/improve.hpp>

namespace hexhex::command {

/// Adds --target, --passes, --fix-boundary, --feature-angle, --slack, --pillow and --snap-curves.
/// @return all of them
std::vector<CLI::Option*> addImproveOptions(CLI::App& parser, ImproveOptions& options);

/// The points of a mesh before improvement, matching its vertices after it; vertices of a pillow
/// have the positions where they were inserted.
/// @param points  of the mesh before; empty if not needed
[[nodiscard]] Array<Vec3> pointsBefore(Array<Vec3> points, const ImproveReport& report);

/// Prints the results; warns of cells that remain bad.
void printImprovement(const ImproveReport& report);

}  // namespace hexhex::command
