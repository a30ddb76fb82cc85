// Cells of higher order.
#include <algorithm>
#include <limits>
#include <string>

#include <hexhex/curved.hpp>

#include "options.hpp"

using hexhex::Error;
using hexhex::ErrorCode;

namespace {

static_assert(hexhex::kMaxOrder == HEXHEX_MAX_ORDER);

/// Before anything is multiplied with the number of nodes of a cell.
void requireSizes(const hexhex_lagrange_arrays& given) {
  if (given.order < 1 || given.order > HEXHEX_MAX_ORDER) {
    throw Error(ErrorCode::InvalidArgument, "The order is " + std::to_string(given.order) +
                                                ". Choose it from 1 to " +
                                                std::to_string(HEXHEX_MAX_ORDER) + ".");
  }
  constexpr std::size_t kMaxPerCell = 1000;
  if (given.cell_count > std::numeric_limits<std::size_t>::max() / kMaxPerCell) {
    throw Error(ErrorCode::TooLarge, "So many cells cannot be.");
  }
}

}  // namespace

hexhex_status hexhex_extract_lagrange(const hexhex_map* map, int order,
                                      const hexhex_extract_options* options,
                                      hexhex_context* context, hexhex_lagrange_mesh** mesh,
                                      hexhex_statistics* statistics, hexhex_error* error) {
  using namespace hexhex::c;
  return runExtract(options, context, mesh, statistics, error,
                    [&](hexhex_lagrange_mesh& made, const hexhex::ExtractOptions& given,
                        hexhex::Context& used, hexhex::ExtractStatistics& filled) {
                      made.mesh = hexhex::extractLagrange(Used(map, "map")->view, order, given,
                                                          used, &filled);
                    });
}

hexhex_status hexhex_extractor_extract_lagrange(hexhex_extractor* extractor, int order,
                                                const hexhex_extract_options* options,
                                                hexhex_context* context,
                                                hexhex_lagrange_mesh** mesh,
                                                hexhex_statistics* statistics,
                                                hexhex_error* error) {
  using namespace hexhex::c;
  return runExtract(
      options, context, mesh, statistics, error,
      [&](hexhex_lagrange_mesh& made, const hexhex::ExtractOptions& given, hexhex::Context& used,
          hexhex::ExtractStatistics& filled) {
        made.mesh =
            Used(extractor, "extractor")->extractor.extractLagrange(order, given, used, &filled);
      });
}

void hexhex_lagrange_mesh_destroy(hexhex_lagrange_mesh* mesh) { hexhex::c::destroy(mesh); }

hexhex_status hexhex_lagrange_mesh_copy(const hexhex_lagrange_arrays* arrays,
                                        hexhex_lagrange_mesh** mesh, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const hexhex_lagrange_arrays given =
        readStruct(&require(arrays, "arrays"), HEXHEX_LAGRANGE_ARRAYS_INIT, "arrays");
    require(mesh, "mesh");
    requireSizes(given);
    auto handle = std::make_unique<hexhex_lagrange_mesh>();
    hexhex::LagrangeMesh& made = handle->mesh;
    made.order = given.order;
    made.vertexCount = given.vertex_count;
    made.points = copied<decltype(made.points)>(given.points, given.point_count, "points");
    made.nodes =
        copied<decltype(made.nodes)>(given.nodes, given.cell_count * made.nodesPerCell(), "nodes");
    copyBesides(given, given.point_count, made);
    made.straightenedCells = copied<std::vector<hexhex::Index>>(
        given.straightened_cells, given.straightened_cell_count, "straightened_cells");
    *mesh = enter(std::move(handle));
  });
}

hexhex_status hexhex_lagrange_mesh_read(const char* file, hexhex_context* context,
                                        hexhex_lagrange_mesh** mesh, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    require(mesh, "mesh");
    ContextOrDefault used(context);
    auto handle = std::make_unique<hexhex_lagrange_mesh>();
    handle->mesh = hexhex::readLagrangeMesh(&require(file, "file"), *used);
    *mesh = enter(std::move(handle));
  });
}

hexhex_status hexhex_file_holds_lagrange(const char* file, hexhex_context* context, int* holds,
                                         hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    require(holds, "holds");
    ContextOrDefault used(context);
    *holds = hexhex::holdsLagrangeCells(&require(file, "file"), *used) ? 1 : 0;
  });
}

hexhex_status hexhex_lagrange_mesh_get_arrays(const hexhex_lagrange_mesh* mesh,
                                              hexhex_lagrange_arrays* arrays, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const Used used(mesh, "mesh");
    const hexhex::LagrangeMesh& m = used->mesh;
    const hexhex_lagrange_arrays result = {
        .size = sizeof(hexhex_lagrange_arrays),
        .order = m.order,
        .points = flat<double>(m.points),
        .point_count = m.points.size(),
        .vertex_count = static_cast<std::size_t>(m.vertexCount),
        .nodes = flat<std::uint32_t>(m.nodes),
        .cell_count = m.cellCount(),
        .generator_tet = flat<std::uint32_t>(m.generatorTet),
        .generator_corners = flat<std::uint8_t>(m.generatorCorners),
        .feature_vertices = flat<hexhex_feature_vertex>(m.features.vertices),
        .feature_vertex_count = m.features.vertices.size(),
        .feature_edges = flat<hexhex_feature_edge>(m.features.edges),
        .feature_edge_count = m.features.edges.size(),
        .feature_quads = flat<hexhex_feature_quad>(m.features.quads),
        .feature_quad_count = m.features.quads.size(),
        .regions = flat<std::int32_t>(m.regions),
        .straightened_cells = flat<std::uint32_t>(m.straightenedCells),
        .straightened_cell_count = m.straightenedCells.size()};
    writeStruct(result, require(arrays, "arrays"), "arrays");
  });
}

hexhex_status hexhex_lagrange_mesh_take(hexhex_lagrange_mesh* mesh, hexhex_mesh_array array,
                                        hexhex_buffer** buffer, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    require(buffer, "buffer");
    const Used used(mesh, "mesh");
    hexhex::LagrangeMesh& own = used->mesh;
    *buffer = enter(takeArray(own, own.nodes, array));
  });
}

hexhex_status hexhex_lagrange_mesh_straight(const hexhex_lagrange_mesh* mesh,
                                            hexhex_mesh** straight, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    require(straight, "straight");
    auto handle = std::make_unique<hexhex_mesh>();
    const Used used(mesh, "mesh");
    handle->own = hexhex::straightMesh(used->mesh);
    handle->repaired = used->repaired;
    *straight = enter(std::move(handle));
  });
}

hexhex_status hexhex_lagrange_mesh_quality(const hexhex_lagrange_mesh* mesh,
                                           hexhex_context* context, double* scaled_jacobians,
                                           hexhex_quality* quality, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    ContextOrDefault used(context);
    writeQuality(hexhex::scaledJacobians(Used(mesh, "mesh")->mesh, *used), scaled_jacobians,
                 quality);
  });
}

hexhex_status hexhex_lagrange_mesh_certify(const hexhex_lagrange_mesh* mesh,
                                           hexhex_context* context, uint8_t* validity,
                                           double* scaled_jacobians,
                                           hexhex_certificate* certificate, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    ContextOrDefault used(context);
    writeCertificate(hexhex::certify(Used(mesh, "mesh")->mesh, *used), validity, scaled_jacobians,
                     certificate);
  });
}

hexhex_status hexhex_lagrange_mesh_write(const hexhex_lagrange_mesh* mesh, const char* file,
                                         const hexhex_write_options* options,
                                         hexhex_context* context, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const Used handle(mesh, "mesh");
    const hexhex::LagrangeMesh& given = handle->mesh;
    ContextOrDefault used(context);
    hexhex::writeLagrangeMesh(given, &require(file, "file"),
                              writeOptions(options, given.cellCount()), *used);
  });
}
