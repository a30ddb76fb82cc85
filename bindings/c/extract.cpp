#include <algorithm>
#include <utility>

#include "options.hpp"

namespace hexhex::c {

ExtractOptions extractOptions(const hexhex_extract_options* options, RepairedMap& repaired) {
  const hexhex_extract_options given = readStruct(options, HEXHEX_EXTRACT_OPTIONS_INIT, "options");
  if (given.engine != HEXHEX_ENGINE_ATLAS && given.engine != HEXHEX_ENGINE_PROPELLER) {
    throw Error(ErrorCode::InvalidArgument, "There is no such engine.");
  }
  if (given.curved_nodes != HEXHEX_NODES_BLENDED && given.curved_nodes != HEXHEX_NODES_EXACT) {
    throw Error(ErrorCode::InvalidArgument,
                "There are no such nodes. Choose HEXHEX_NODES_BLENDED or HEXHEX_NODES_EXACT.");
  }
  return {.engine = static_cast<Engine>(given.engine),
          .scale = given.scale,
          .tolerance = given.tolerance,
          .repair = given.repair != 0 ? &repaired : nullptr,
          .round = given.round != 0,
          .curvedNodes = static_cast<CurvedNodes>(given.curved_nodes)};
}

void writeStatistics(const ExtractStatistics& statistics, hexhex_statistics* out) {
  if (out == nullptr) return;
  hexhex_statistics result = HEXHEX_STATISTICS_INIT;
  result.seconds = statistics.seconds;
  result.threads = statistics.threads;
  result.mirrored = statistics.mirrored ? 1 : 0;
  result.tets_inverted_in_space = statistics.tetsInvertedInSpace;
  result.max_displacement = statistics.maxDisplacement;
  result.max_transition_residual = statistics.maxTransitionResidual;
  result.chart_jumps = statistics.chartJumps;
  result.inner_faces = statistics.innerFaces;
  result.singular_edges = statistics.singularEdges;
  std::copy(statistics.generators.begin(), statistics.generators.end(), result.generators);
  std::copy(statistics.vertices.begin(), statistics.vertices.end(), result.vertices);
  result.local_propellers = statistics.localPropellers;
  result.global_propellers = statistics.globalPropellers;
  result.charts = statistics.charts;
  result.cut_faces = statistics.cutFaces;
  result.overlapping_tets = statistics.overlappingTets;
  result.traced_cells = statistics.tracedCells;
  writeStruct(result, *out, "statistics");
}

}  // namespace hexhex::c

hexhex_status hexhex_extract(const hexhex_map* map, const hexhex_extract_options* options,
                             hexhex_context* context, hexhex_mesh** mesh,
                             hexhex_statistics* statistics, hexhex_error* error) {
  using namespace hexhex::c;
  return runExtract(options, context, mesh, statistics, error,
                    [&](hexhex_mesh& made, const hexhex::ExtractOptions& given,
                        hexhex::Context& used, hexhex::ExtractStatistics& filled) {
                      made.own = hexhex::extract(Used(map, "map")->view, given, used, &filled);
                    });
}

hexhex_status hexhex_extractor_create(const hexhex_map* map, double tolerance, int max_scale,
                                      hexhex_context* context, hexhex_extractor** extractor,
                                      hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    require(extractor, "extractor");
    ContextOrDefault used(context);
    *extractor = enter(std::make_unique<hexhex_extractor>(
        map, hexhex::ExtractorOptions{.tolerance = tolerance, .maxScale = max_scale}, *used));
  });
}

hexhex_status hexhex_extractor_extract(hexhex_extractor* extractor,
                                       const hexhex_extract_options* options,
                                       hexhex_context* context, hexhex_mesh** mesh,
                                       hexhex_statistics* statistics, hexhex_error* error) {
  using namespace hexhex::c;
  return runExtract(options, context, mesh, statistics, error,
                    [&](hexhex_mesh& made, const hexhex::ExtractOptions& given,
                        hexhex::Context& used, hexhex::ExtractStatistics& filled) {
                      made.own =
                          Used(extractor, "extractor")->extractor.extract(given, used, &filled);
                    });
}

void hexhex_extractor_destroy(hexhex_extractor* extractor) { hexhex::c::destroy(extractor); }

uint64_t hexhex_extractor_cells(const hexhex_extractor* extractor) {
  const hexhex::c::Used used(extractor, std::nothrow, hexhex::c::Use::Look);
  return used ? used->extractor.cellsAtScaleOne() : 0;
}
