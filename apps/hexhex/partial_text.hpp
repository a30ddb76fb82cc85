// What a partial extraction left out, for people and for reports.
#pragma once

#include <string>

#include <hexhex/error.hpp>
#include <hexhex/partial.hpp>

namespace hexhex::command {

/// Counts, and the places of the largest holes, on the standard output.
void printPartial(const PartialMesh& partial);

/// The report of a partial extraction, with all holes, as JSON text that ends with a line break;
/// docs/report.md explains the keys.
/// @param problem  why there is no whole mesh
[[nodiscard]] std::string partialReportAsJson(const PartialMesh& partial, const Error& problem,
                                              int scale);

}  // namespace hexhex::command
