#include "report.hpp"

#include <array>
#include <cmath>
#if defined(_WIN32)
#if !defined(NOMINMAX)
#define NOMINMAX
#endif
#include <windows.h>
// After it, as it needs it.
#include <psapi.h>
#else
#include <sys/resource.h>
#endif

#include <hexhex/version.hpp>

#include "improve_options.hpp"
#include "json.hpp"
#include "output.hpp"
#include "quantize_options.hpp"
#include "repair_text.hpp"

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

/// {"reading": 0.01, "extraction": 3.85, ...}
Json partsAsJson(const std::vector<StageTime>& parts) {
  Json json = Json::object();
  for (const StageTime& part : parts) json[part.stage] = part.seconds;
  return json;
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
  const PartsSummary& summary = record.summary;
  return {{"count", record.options.parts},
          {"partition", partitionName(record.options.method)},
          {"ghost_layers", record.options.ghostLayers},
          {"verified", record.options.verify},
          {"largest", summary.largest},
          {"smallest", summary.smallest},
          {"empty", summary.empty},
          {"shared_vertices", summary.sharedVertices},
          {"shared_faces", summary.sharedFaces},
          {"most_neighbours", summary.mostNeighbours}};
}

Json curvesAsJson(const CurvesRecord& parts, const char* pieces) {
  if (parts.file.empty()) return nullptr;
  return {{"file", parts.file.string()}, {"count", parts.count}, {pieces, parts.pieces}};
}

/// JSON knows no infinity.
Json finiteOrNull(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

}  // namespace

const char* engineName(Engine engine) noexcept {
  return engine == Engine::Atlas ? "atlas" : "propeller";
}

std::string reportAsJson(const ExtractionRecord& record) {
  const ExtractStatistics& statistics = record.statistics;
  const Json report = {
      {"hexhex_version", HEXHEX_VERSION},
      {"input", fileAsJson(record.input)},
      {"output", fileAsJson(record.output)},
      {"extract_seconds", statistics.seconds},
      {"seconds", partsAsJson(record.parts)},
      {"cells", record.cells},
      {"vertices", record.vertices},
      {"tets", record.tets},
      {"points", record.points},
      {"scale", record.scale},
      {"order", record.order},
      {"nodes", record.order > 1 ? record.nodes : record.vertices},
      {"arcs", curvesAsJson(record.arcs, "inner_points")},
      {"patches", curvesAsJson(record.patches, "polygons")},
      {"threads", statistics.threads},
      {"engine", engineName(record.engine)},
      {"epsilon", finiteOrNull(statistics.epsilon)},
      {"epsilon_fallback", statistics.epsilonFallback},
      {"stages", stagesAsJson(record.stages)},
      {"peak_memory_bytes", peakMemory()},
      {"generators", byKind(statistics.generators)},
      {"vertices_by_generator", byKind(statistics.vertices)},
      {"local_propellers", statistics.localPropellers},
      {"global_propellers", statistics.globalPropellers},
      {"charts", statistics.charts},
      {"cut_faces", statistics.cutFaces},
      {"overlapping_tets", statistics.overlappingTets},
      {"traced_cells", statistics.tracedCells},
      {"singular_edges", statistics.singularEdges},
      {"chart_jumps", statistics.chartJumps},
      {"inner_faces", statistics.innerFaces},
      {"max_displacement", statistics.maxDisplacement},
      {"max_transition_residual", statistics.maxTransitionResidual},
      {"mirrored", statistics.mirrored},
      {"tets_inverted_in_space", statistics.tetsInvertedInSpace},
      {"quality", orNull(record.certificate, qualityAsJson)},
      {"validity", orNull(record.certificate, validityAsJson)},
      {"verification", orNull(record.verification, verificationAsJson)},
      {"repair", repairAsJson(statistics.repair)},
      {"quantization", record.quantized ? quantizeAsJson(*record.quantized) : Json(nullptr)},
      {"improvement", record.improved ? improvementAsJson(*record.improved) : Json(nullptr)},
      {"streamed", record.streamed.has_value()},
      {"checksums", orNull(record.streamed, checksumsAsJson)},
      {"parts", orNull(record.meshParts, meshPartsAsJson)}};
  return jsonText(report);
}

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

}  // namespace hexhex::command
