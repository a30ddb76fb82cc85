// Options and statistics of extractions.
#pragma once

#include <hexhex/extract.hpp>

#include "handles.hpp"

namespace hexhex::c {

[[nodiscard]] ExtractOptions extractOptions(const hexhex_extract_options* options);

/// @param out  may be null
void writeStatistics(const ExtractStatistics& statistics, hexhex_statistics* out);

}  // namespace hexhex::c
