// Chart jumps and singular edges of maps.
#include <utility>

#include <hexhex/map_structure.hpp>

#include "handles.hpp"

namespace {

hexhex_chart_jump plain(const hexhex::ChartJump& jump) {
  hexhex_chart_jump result = {};
  std::copy(jump.tets.begin(), jump.tets.end(), result.tets);
  std::copy(jump.vertices.begin(), jump.vertices.end(), result.vertices);
  for (std::size_t i = 0; i < 9; ++i) result.rotation[i] = jump.rotation[i / 3][i % 3];
  std::copy(jump.translation.begin(), jump.translation.end(), result.translation);
  return result;
}

}  // namespace

hexhex_status hexhex_map_find_structure(const hexhex_map* map, double tolerance,
                                        hexhex_context* context, hexhex_map_structure** structure,
                                        hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    require(structure, "structure");
    ContextOrDefault used(context);
    const hexhex::MapStructure found =
        hexhex::findMapStructure(Used(map, "map")->view, tolerance, *used);
    auto made = std::make_unique<hexhex_map_structure>();
    made->chartJumps.reserve(found.chartJumps.size());
    for (const hexhex::ChartJump& jump : found.chartJumps) made->chartJumps.push_back(plain(jump));
    made->singularEdges.reserve(found.singularEdges.size());
    for (const hexhex::SingularTetEdge& edge : found.singularEdges) {
      made->singularEdges.push_back(
          {{edge.vertex0, edge.vertex1}, edge.valence, edge.boundary ? 1U : 0U});
    }
    made->defects = found.defects.size();
    *structure = enter(std::move(made));
  });
}

void hexhex_map_structure_destroy(hexhex_map_structure* structure) {
  hexhex::c::destroy(structure);
}

hexhex_status hexhex_map_structure_get_arrays(const hexhex_map_structure* structure,
                                              hexhex_map_structure_arrays* arrays,
                                              hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const Used used(structure, "structure");
    const hexhex_map_structure& s = *used;
    const hexhex_map_structure_arrays result = {
        .size = sizeof(hexhex_map_structure_arrays),
        .chart_jumps = flat<hexhex_chart_jump>(s.chartJumps),
        .chart_jump_count = s.chartJumps.size(),
        .singular_edges = flat<hexhex_singular_tet_edge>(s.singularEdges),
        .singular_edge_count = s.singularEdges.size(),
        .defect_count = s.defects};
    writeStruct(result, require(arrays, "arrays"), "arrays");
  });
}
