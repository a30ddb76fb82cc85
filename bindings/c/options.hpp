// Options and reports of several files.
#pragma once

#include <hexhex/extract.hpp>
#include <hexhex/improve.hpp>
#include <hexhex/io.hpp>
#include <hexhex/quantize.hpp>

#include "handles.hpp"

namespace hexhex::c {

/// @param repaired  receives the map if it is to be repaired
[[nodiscard]] ExtractOptions extractOptions(const hexhex_extract_options* options,
                                            RepairedMap& repaired);

/// The strings are the caller's.
[[nodiscard]] ReadOptions readOptions(const hexhex_read_options* options);
/// @param cells  as many scaled Jacobians are there, if any
[[nodiscard]] WriteOptions writeOptions(const hexhex_write_options* options, std::size_t cells);

/// @param options  not null
[[nodiscard]] QuantizeOptions quantizeOptions(const hexhex_quantize_options* options);
/// @param[out] surface  that the options name, or null: they must not name one
[[nodiscard]] ImproveOptions improveOptions(const hexhex_improve_options* options,
                                            const char** surface = nullptr);

/// @param out  may be null
void writeReport(const QuantizeReport& report, hexhex_quantize_report* out);
void writeReport(const ImproveReport& report, hexhex_improve_report* out);

/// Points and tets of the caller's arrays, with tags.
[[nodiscard]] TetMesh tetMeshOf(const hexhex_map_arrays* arrays, const char* argument);

/// With tags, and without parameters.
void give(TetMesh&& tets, hexhex_map** map);

/// @param map, report  may be null
void giveRepair(const RepairedMap& repaired, hexhex_map** map, hexhex_repair_report** report);

/// @param out  may be null
void writeStatistics(const ExtractStatistics& statistics, hexhex_statistics* out);

// Where the handles of results keep what was repaired.
[[nodiscard]] inline RepairedMap& repairedIn(hexhex_mesh& mesh) { return mesh.repaired; }
[[nodiscard]] inline RepairedMap& repairedIn(hexhex_lagrange_mesh& mesh) { return mesh.repaired; }
[[nodiscard]] inline RepairedMap& repairedIn(hexhex_piecewise_mesh& mesh) {
  return mesh.straight->repaired;
}

/// Runs an extraction and gives a handle of its result.
/// @param extract  called with the new handle, options, context and statistics; fills the handle
template <class Handle, class Extract>
hexhex_status runExtract(const hexhex_extract_options* options, hexhex_context* context,
                         Handle** result, hexhex_statistics* statistics, hexhex_error* error,
                         const Extract& extract) {
  return guarded(error, [&] {
    require(result, "mesh");
    RepairedMap repaired;
    const ExtractOptions given = extractOptions(options, repaired);
    ContextOrDefault used(context);
    ExtractStatistics filled;
    auto handle = std::make_unique<Handle>();
    extract(*handle, given, *used, filled);
    writeStatistics(filled, statistics);
    repairedIn(*handle) = std::move(repaired);
    *result = enter(std::move(handle));
  });
}

}  // namespace hexhex::c
