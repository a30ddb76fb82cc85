#include "extract_report.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <utility>

#include <fmt/core.h>

#include <hexhex/version.hpp>

#include "improve_options.hpp"
#include "json.hpp"
#include "map_text.hpp"
#include "output.hpp"
#include "quantize_options.hpp"

#if defined(_WIN32)
#if !defined(NOMINMAX)
#define NOMINMAX
#endif
#include <windows.h>
// Must follow the header above.
#include <psapi.h>
#else
#include <sys/resource.h>
#endif

namespace hexhex::command {
namespace {

template <class Value, class AsJson>
Json orNull(const std::optional<Value>& value, const AsJson& asJson) {
  return value ? asJson(*value) : Json(nullptr);
}

Json fileAsJson(const FileSize& file) {
  return {{"file", file.file.string()}, {"bytes", file.bytes}};
}

Json stagesAsJson(const std::vector<StageTime>& stages) {
  double total = 0;
  for (const StageTime& stage : stages) total += stage.seconds;
  Json list = Json::array();
  for (const StageTime& stage : stages) {
    list.push_back({{"name", stage.stage},
                    {"seconds", stage.seconds},
                    {"share", total > 0 ? stage.seconds / total : 0}});
  }
  return list;
}

Json byKind(const std::array<std::uint64_t, 4>& counts) {
  return {{"vertex", counts[0]}, {"edge", counts[1]}, {"face", counts[2]}, {"cell", counts[3]}};
}

const char* partitionName(PartitionMethod method) {
  switch (method) {
    case PartitionMethod::Scotch:
      return "scotch";
    case PartitionMethod::Metis:
      return "metis";
    case PartitionMethod::Curve:
      break;
  }
  return "curve";
}

Json meshPartsAsJson(const PartsRecord& record) {
  return fieldsAsJson(record.summary, {{"count", record.options.parts},
                                       {"partition", partitionName(record.options.method)},
                                       {"ghost_layers", record.options.ghostLayers},
                                       {"verified", record.options.verify}});
}

Json curvesAsJson(const CurvesRecord& parts, const char* pieces) {
  if (parts.file.empty()) return nullptr;
  return {{"file", parts.file.string()}, {"count", parts.count}, {pieces, parts.pieces}};
}

Json curvedAsJson(const ExtractionRecord& record) {
  if (record.order == 1) return nullptr;
  return {{"nodes", record.curvedNodes == CurvedNodes::Exact ? "exact" : "blended"},
          {"straightened_cells", record.straightenedCells}};
}

const char* engineName(Engine engine) noexcept {
  return engine == Engine::Atlas ? "atlas" : "propeller";
}

}  // namespace

std::uint64_t peakMemory() {
#if defined(_WIN32)
  PROCESS_MEMORY_COUNTERS counters{};
  return K32GetProcessMemoryInfo(GetCurrentProcess(), &counters, sizeof counters) != 0
             ? counters.PeakWorkingSetSize
             : 0;
#else
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
#ifdef __APPLE__
  constexpr std::uint64_t kUnit = 1;
#else
  constexpr std::uint64_t kUnit = 1024;
#endif
  return static_cast<std::uint64_t>(usage.ru_maxrss) * kUnit;
#endif
}

std::string reportAsJson(const ExtractionRecord& record) {
  const ExtractStatistics& statistics = record.statistics;
  Json report = {{"hexhex_version", HEXHEX_VERSION},
                 {"input", fileAsJson(record.input)},
                 {"output", fileAsJson(record.output)},
                 {"extract_seconds", statistics.seconds},
                 {"seconds", secondsAsJson(record.parts)},
                 {"cells", record.cells},
                 {"vertices", record.vertices},
                 {"tets", record.tets},
                 {"points", record.points},
                 {"scale", record.scale},
                 {"order", record.order},
                 {"nodes", record.order > 1 ? record.nodes : record.vertices},
                 {"curved", curvedAsJson(record)},
                 {"arcs", curvesAsJson(record.arcs, "inner_points")},
                 {"patches", curvesAsJson(record.patches, "polygons")},
                 {"engine", engineName(record.engine)},
                 {"stages", stagesAsJson(record.stages)},
                 {"peak_memory_bytes", peakMemory()}};
  // Some names have another meaning for the whole run.
  Json counts = fieldsAsJson(statistics, {{"vertices_by_generator", byKind(statistics.vertices)}});
  counts["generators"] = byKind(statistics.generators);
  counts.erase("seconds");
  counts.erase("vertices");
  report.update(counts);
  report.update({{"quality", orNull(record.certificate, qualityAsJson)},
                 {"validity", orNull(record.certificate, validityAsJson)},
                 {"boundary", orNull(record.boundary, boundaryAsJson)},
                 {"verification", orNull(record.verification, verificationAsJson)},
                 {"repair", repairAsJson(record.repaired.report)},
                 {"quantization", orNull(record.quantized, quantizeAsJson)},
                 {"improvement", orNull(record.improved, improvementAsJson)},
                 {"streamed", record.streamed.has_value()},
                 {"checksums", orNull(record.streamed, checksumsAsJson)},
                 {"parts", orNull(record.meshParts, meshPartsAsJson)}});
  return jsonText(report);
}

namespace {

std::string verificationAsText(const ExtractionRecord& record) {
  if (record.meshParts) return "passed: parts agree on what they share, and make up one mesh";
  if (!record.verification) return "skipped";
  return fmt::format("passed, {}", counted(record.verification->items.size(), "check"));
}

void printParts(const PartsRecord& record) {
  const PartsSummary& summary = record.summary;
  printLine("parts", fmt::format("{}, of {} to {} cells", record.options.parts, summary.smallest,
                                 summary.largest));
  printLine("shared", fmt::format("{} vertices, {}, at most {} of a part", summary.sharedVertices,
                                  counted(summary.sharedFaces, "face"),
                                  counted(summary.mostNeighbours, "neighbour")));
}

}  // namespace

void printWarnings(const ExtractionRecord& record, const TetMap& map) {
  const ExtractStatistics& statistics = record.statistics;
  if (record.streamed && !(map.features.empty() && map.regions.empty())) {
    printWarning(
        "The tags and regions of the map are not in the mesh; leave out --stream for them.");
  }
  if (record.repaired.map) printWarning(repairNotice(record.repaired.report));
  if (statistics.tetsInvertedInSpace > 0) {
    printWarning(counted(statistics.tetsInvertedInSpace, "tet") +
                 " of the input are inverted in space. The mesh has the right connectivity, but "
                 "cells there may be inverted, too.");
  }
  if (record.certificate && record.certificate->refuted > 0 && !record.improved) {
    const bool canImprove = record.order <= 3;
    printWarning(refutationAsText(*record.certificate) +
                 (canImprove ? " --improve makes such cells positive where it can." : ""));
  }
  if (statistics.mirrored) {
    printWarning("The map reverses orientation; it was mirrored before the extraction.");
  }
}

void printSummary(const ExtractionRecord& record) {
  const ExtractStatistics& statistics = record.statistics;
  printFiles(record.input.file, record.output.file);
  printLine("map", fmt::format("{}, {}, {} of {} with a chart jump", counted(record.tets, "tet"),
                               counted(record.points, "point"), statistics.chartJumps,
                               counted(statistics.innerFaces, "inner face")));
  if (record.quantized) printLine("quantization", quantizeSummary(*record.quantized));
  printLine("mesh", fmt::format("{}, {}", counted(record.cells, "cell"),
                                counted(record.vertices, "vertex")));
  if (record.tags != std::array<std::uint64_t, 3>{}) {
    printLine("tagged",
              fmt::format("{}, {}, {}", counted(record.tags[0], "vertex"),
                          counted(record.tags[1], "edge"), counted(record.tags[2], "quad")));
  }
  if (record.engine != Engine::Atlas) printLine("engine", engineName(record.engine));
  printLine("time", record.partsAsText);
  printLine("peak memory",
            fmt::format("{}, with {}", bytesAsText(peakMemory()),
                        counted(static_cast<std::uint64_t>(statistics.threads), "thread")));
  if (record.repaired.map) {
    const RepairReport& repair = record.repaired.report;
    printLine("repair",
              fmt::format("{:.3f} s, {}", repair.seconds, counted(repair.regions.size(), "place")));
  }
  if (record.improved) {
    printImprovement(*record.improved);
  } else if (record.certificate) {
    printQuality(*record.certificate);
  }
  if (record.boundary) printPatches(*record.boundary);
  if (record.order > 1) {
    const std::size_t straightened = record.straightenedCells.size();
    printLine("order",
              fmt::format("{}, {} nodes{}", record.order, record.nodes,
                          straightened == 0 ? ""
                                            : fmt::format("; {} nearer to straight, to be positive",
                                                          counted(straightened, "cell"))));
  }
  for (const auto& [what, part] :
       {std::pair("arcs", &record.arcs), std::pair("patches", &record.patches)}) {
    if (part->file.empty()) continue;
    printLine(what, fmt::format("{} with {} {}, {}", part->count, part->pieces,
                                what == std::string("arcs") ? "inner points" : "polygons",
                                part->file.string()));
  }
  if (!record.page.empty()) printLine("page", record.page);
  if (record.meshParts) printParts(*record.meshParts);
  printLine("verification", verificationAsText(record));
  if (record.streamed) {
    printLine("checksum of cells", checksumAsText(record.streamed->cellChecksum));
    printLine("checksum of vertices", checksumAsText(record.streamed->pointChecksum));
  }
  if (!record.meshParts) printLine("file", bytesAsText(record.output.bytes));
}

namespace {

constexpr std::size_t kMaxListed = 20;

std::uint64_t cellsAtHoles(const PartialMesh& partial) {
  const auto& regions = partial.mesh.regions;
  return static_cast<std::uint64_t>(std::count(regions.begin(), regions.end(), std::int32_t{1}));
}

void printHole(const Hole& hole) {
  printLine(fmt::format("hole at tet {}", hole.tet),
            fmt::format("about {:.2f} cells missing near ({:.4g}, {:.4g}, {:.4g}), in {}, {} of "
                        "them invalid",
                        hole.missingCells, hole.position[0], hole.position[1], hole.position[2],
                        counted(hole.tets, "tet"), hole.invalidTets));
}

}  // namespace

void printPartial(const PartialMesh& partial) {
  printLine("mesh", fmt::format("{}, {} of them at holes (region 1)",
                                counted(partial.mesh.cells.size(), "cell"), cellsAtHoles(partial)));
  printLine("missing", fmt::format("about {:.1f} cells, at {} with {}", partial.missingCells,
                                   counted(partial.holes.size(), "hole"),
                                   counted(partial.invalidTets, "invalid tet")));
  printLine("local verification",
            fmt::format("every cell is filled by valid tets; {} do not fit together",
                        counted(partial.faceConflicts, "face")));
  const std::size_t listed = std::min(partial.holes.size(), kMaxListed);
  for (std::size_t i = 0; i < listed; ++i) printHole(partial.holes[i]);
  if (partial.holes.size() > listed) {
    printLine("and", counted(partial.holes.size() - listed, "smaller hole"));
  }
}

std::string partialReportAsJson(const PartialMesh& partial, const Error& problem, int scale) {
  Json holes = Json::array();
  for (const Hole& hole : partial.holes) {
    holes.push_back({{"tet", hole.tet},
                     {"position", hole.position},
                     {"tets", hole.tets},
                     {"invalid_tets", hole.invalidTets},
                     {"missing_cells", hole.missingCells}});
  }
  const Json report = {{"hexhex_version", HEXHEX_VERSION},
                       {"partial", true},
                       {"error",
                        {{"code", name(problem.code())},
                         {"sentence", problem.what()},
                         {"place", toString(problem.place())}}},
                       {"scale", scale},
                       {"cells", partial.mesh.cells.size()},
                       {"vertices", partial.mesh.points.size()},
                       {"cells_at_holes", cellsAtHoles(partial)},
                       {"face_conflicts", partial.faceConflicts},
                       {"invalid_tets", partial.invalidTets},
                       {"missing_cells", partial.missingCells},
                       {"holes", std::move(holes)}};
  return jsonText(report);
}

}  // namespace hexhex::command
