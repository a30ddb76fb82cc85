#include "extract_text.hpp"

#include <array>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "improve_options.hpp"
#include "output.hpp"
#include "quantize_options.hpp"
#include "repair_text.hpp"

namespace hexhex::command {
namespace {

std::string verificationAsText(const ExtractionRecord& record) {
  if (record.meshParts) return "passed: parts agree on what they share, and make up one mesh";
  if (!record.verification) return "skipped";
  std::string passed =
      fmt::format("passed, {}", counted(record.verification->items.size(), "check"));
  if (!record.streamed) return passed;
  return passed + ", of the file as it was read back";
}

}  // namespace

void printWarnings(const ExtractionRecord& record, const TetMap& map) {
  const ExtractStatistics& statistics = record.statistics;
  if (record.streamed && !(map.features.empty() && map.regions.empty())) {
    printWarning(
        "The tags and regions of the map are not in the mesh; leave out --stream for them.");
  }
  if (statistics.repair.changed) printWarning(repairNotice(statistics.repair));
  if (statistics.tetsInvertedInSpace > 0) {
    printWarning(counted(statistics.tetsInvertedInSpace, "tet") +
                 " of the input are inverted in space. The mesh has the right connectivity, but "
                 "cells there may be inverted, too.");
  }
  if (record.certificate && record.certificate->refuted > 0 && !record.improved) {
    printWarning(refutationAsText(*record.certificate));
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
  printLine(
      "mesh",
      fmt::format("{}, {}", counted(record.cells, "cell"),
                  record.vertices == 1 ? "1 vertex" : fmt::format("{} vertices", record.vertices)));
  if (record.tags != std::array<std::uint64_t, 3>{}) {
    printLine(
        "tagged",
        fmt::format("{}, {}, {}",
                    record.tags[0] == 1 ? "1 vertex" : fmt::format("{} vertices", record.tags[0]),
                    counted(record.tags[1], "edge"), counted(record.tags[2], "quad")));
  }
  if (record.engine != Engine::Atlas) printLine("engine", engineName(record.engine));
  printLine("time", record.partsAsText);
  printLine("peak memory",
            fmt::format("{}, with {}", bytesAsText(peakMemory()),
                        counted(static_cast<std::uint64_t>(statistics.threads), "thread")));
  if (statistics.repair.changed) {
    printLine("repair", fmt::format("{:.3f} s, {}", statistics.repair.seconds,
                                    counted(statistics.repair.regions.size(), "place")));
  }
  if (record.improved) {
    printImprovement(*record.improved);
  } else if (record.certificate) {
    printQuality(*record.certificate);
  }
  if (record.order > 1) {
    printLine("order", fmt::format("{}, {} nodes", record.order, record.nodes));
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

}  // namespace hexhex::command
