// What `hexhex extract` says of a mesh.
#pragma once

#include <hexhex/types.hpp>

#include "report.hpp"

namespace hexhex::command {

/// What is unusual, on the standard error output.
void printWarnings(const ExtractionRecord& record, const TetMap& map);

/// A line for each thing that is worth knowing.
void printSummary(const ExtractionRecord& record);

}  // namespace hexhex::command
