// Options and statistics of extractions.
#pragma once

#include <hexhex/extract.hpp>
#include <hexhex/io.hpp>

#include "handles.hpp"

namespace hexhex::c {

[[nodiscard]] ExtractOptions extractOptions(const hexhex_extract_options* options);

/// The strings are the caller's.
[[nodiscard]] ReadOptions readOptions(const hexhex_read_options* options);
/// @param cells  as many scaled Jacobians are there, if any
[[nodiscard]] WriteOptions writeOptions(const hexhex_write_options* options, std::size_t cells);

[[nodiscard]] Repaired repairedBy(ExtractStatistics&& statistics);
/// @param map, report  may be null
void giveRepair(const Repaired& repaired, hexhex_map** map, hexhex_repair_report** report);

/// @param out  may be null
void writeStatistics(const ExtractStatistics& statistics, hexhex_statistics* out);

}  // namespace hexhex::c
