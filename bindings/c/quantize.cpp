#include <utility>

#include <hexhex/quantize.hpp>

#include "options.hpp"

namespace hexhex::c {

QuantizeOptions quantizeOptions(const hexhex_quantize_options* options) {
  const hexhex_quantize_options o =
      readStruct(&require(options, "options"), HEXHEX_QUANTIZE_OPTIONS_INIT, "options");
  return {.cells = o.cells,
          .scale = o.scale,
          .edgeLength = o.edge_length,
          .densify = o.densify != 0,
          .wallTag = o.wall_tag,
          .tolerance = o.tolerance};
}

void writeReport(const QuantizeReport& r, hexhex_quantize_report* out) {
  if (out == nullptr) return;
  hexhex_quantize_report result = {.size = sizeof(hexhex_quantize_report),
                                   .cells_wanted = r.cellsWanted,
                                   .cells = r.cells,
                                   .scale = r.scale,
                                   .displacement = r.displacement,
                                   .blocks = r.blocks,
                                   .arcs = r.arcs,
                                   .shortest_arc = r.shortestArc,
                                   .longest_arc = r.longestArc,
                                   .integers_by = {},
                                   .attempts = r.attempts,
                                   .split_edges = r.splitEdges,
                                   .added_tets = r.addedTets,
                                   .worst_before = r.distortionBefore.worst,
                                   .median_before = r.distortionBefore.median,
                                   .worst_after = r.distortionAfter.worst,
                                   .median_after = r.distortionAfter.median};
  r.integersBy.copy(result.integers_by, sizeof result.integers_by - 1);
  writeStruct(result, *out, "report");
}

}  // namespace hexhex::c

int hexhex_can_quantize(void) { return hexhex::canQuantize() ? 1 : 0; }

hexhex_status hexhex_quantize(const hexhex_map* map, const hexhex_quantize_options* options,
                              hexhex_context* context, hexhex_map** quantized,
                              hexhex_quantize_report* report, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    require(quantized, "quantized");
    const Used given(map, "map");
    const hexhex::QuantizeOptions chosen = quantizeOptions(options);
    ContextOrDefault used(context);
    hexhex::QuantizedMap made = hexhex::quantize(given->view, chosen, *used);
    writeReport(made.report, report);
    give(std::move(made.map), quantized);
  });
}

hexhex_status hexhex_examine_seamless(const hexhex_map* map, hexhex_context* context,
                                      hexhex_seamless_report* report, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const Used given(map, "map");
    ContextOrDefault used(context);
    const hexhex::SeamlessReport found = hexhex::examineSeamless(given->view, *used);
    hexhex_seamless_report result = HEXHEX_SEAMLESS_REPORT_INIT;
    result.kind = static_cast<hexhex_seamless_kind>(found.kind);
    result.displacement = found.displacement;
    result.cells = found.cells;
    found.problem.copy(result.problem, sizeof result.problem - 1);
    writeStruct(result, require(report, "report"), "report");
  });
}
