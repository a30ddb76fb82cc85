#include <algorithm>
#include <utility>

#include <hexhex/curved.hpp>

#include "options.hpp"

using hexhex::Error;
using hexhex::ErrorCode;

namespace {

/// The map that a mesh was made of: the caller's, unless it had to be repaired.
hexhex::TetMapView extractedMap(const hexhex_piecewise_mesh& mesh, const hexhex_map* map) {
  const hexhex::TetMapView& given = hexhex::c::require(map, "map").view;
  return mesh.straight.repairedMap ? hexhex::TetMapView(*mesh.straight.repairedMap) : given;
}

}  // namespace

hexhex_status hexhex_extract_piecewise(const hexhex_map* map, int patches,
                                       const hexhex_extract_options* options,
                                       hexhex_context* context, hexhex_piecewise_mesh** mesh,
                                       hexhex_statistics* statistics, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    require(mesh, "mesh");
    ContextOrDefault used(context);
    hexhex::ExtractStatistics filled;
    auto handle = std::make_unique<hexhex_piecewise_mesh>();
    handle->piecewise =
        hexhex::extractPiecewiseLinear(require(map, "map").view,
                                       patches != 0 ? hexhex::PiecewiseLinearParts::ArcsAndPatches
                                                    : hexhex::PiecewiseLinearParts::Arcs,
                                       extractOptions(options), *used, &filled);
    writeStatistics(filled, statistics);
    handle->straight.lent = &handle->piecewise.mesh;
    handle->straight.repair = std::move(filled.repair);
    handle->straight.repairedMap = std::move(filled.repairedMap);
    *mesh = handle.release();
  });
}

void hexhex_piecewise_mesh_destroy(hexhex_piecewise_mesh* mesh) { delete mesh; }

const hexhex_mesh* hexhex_piecewise_mesh_straight(const hexhex_piecewise_mesh* mesh) {
  return mesh != nullptr ? &mesh->straight : nullptr;
}

hexhex_status hexhex_piecewise_mesh_get_arcs(const hexhex_piecewise_mesh* mesh,
                                             hexhex_arc_arrays* arrays, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const hexhex::Arcs& arcs = require(mesh, "mesh").piecewise.arcs;
    const hexhex_arc_arrays result = {
        .size = sizeof(hexhex_arc_arrays),
        .arc_count = arcs.count(),
        .ends = flat<std::uint32_t>(arcs.ends),
        .point_begin = flat<std::uint64_t>(arcs.pointBegin),
        .point_count = arcs.points.size(),
        .points = flat<double>(arcs.points),
        .parameters = flat<double>(arcs.parameters),
        .generator_tet = flat<std::uint32_t>(arcs.generatorTet),
        .generator_corners = flat<std::uint8_t>(arcs.generatorCorners),
        .segment_count = arcs.segmentTet.size(),
        .segment_tet = flat<std::uint32_t>(arcs.segmentTet),
        .segment_corners = flat<std::uint8_t>(arcs.segmentCorners)};
    writeStruct(result, require(arrays, "arrays"), "arrays");
  });
}

hexhex_status hexhex_piecewise_mesh_get_patches(const hexhex_piecewise_mesh* mesh,
                                                hexhex_patch_arrays* arrays, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const hexhex::Patches& p = require(mesh, "mesh").piecewise.patches;
    const hexhex_patch_arrays result = {
        .size = sizeof(hexhex_patch_arrays),
        .face_count = p.count(),
        .vertices = flat<std::uint32_t>(p.vertices),
        .arcs = flat<std::uint32_t>(p.arcs),
        .reversed_arcs = flat<std::uint8_t>(p.reversedArcs),
        .polygon_begin = flat<std::uint64_t>(p.polygonBegin),
        .polygon_count = p.polygonTet.size(),
        .corner_begin = flat<std::uint64_t>(p.cornerBegin),
        .polygon_tet = flat<std::uint32_t>(p.polygonTet),
        .polygon_corners = flat<std::uint8_t>(p.polygonCorners),
        .corner_count = p.corners.size(),
        .corners = flat<std::uint32_t>(p.corners),
        .parameters = flat<double>(p.parameters),
        .point_count = p.points.size(),
        .points = flat<double>(p.points),
        .generator_tet = flat<std::uint32_t>(p.generatorTet),
        .generator_corners = flat<std::uint8_t>(p.generatorCorners)};
    writeStruct(result, require(arrays, "arrays"), "arrays");
  });
}

hexhex_status hexhex_piecewise_mesh_write_arcs(const hexhex_piecewise_mesh* mesh, const char* file,
                                               hexhex_context* context, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    ContextOrDefault used(context);
    hexhex::writeArcs(require(mesh, "mesh").piecewise, &require(file, "file"), *used);
  });
}

hexhex_status hexhex_piecewise_mesh_write_patches(const hexhex_piecewise_mesh* mesh,
                                                  const char* file, hexhex_context* context,
                                                  hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    ContextOrDefault used(context);
    hexhex::writePatches(require(mesh, "mesh").piecewise, &require(file, "file"), *used);
  });
}

hexhex_status hexhex_piecewise_mesh_write_arcs_with_map(const hexhex_piecewise_mesh* mesh,
                                                        const hexhex_map* map, const char* file,
                                                        hexhex_context* context,
                                                        hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const hexhex_piecewise_mesh& given = require(mesh, "mesh");
    ContextOrDefault used(context);
    hexhex::writeArcs(given.piecewise, extractedMap(given, map), &require(file, "file"), *used);
  });
}

hexhex_status hexhex_piecewise_mesh_write_patches_with_map(const hexhex_piecewise_mesh* mesh,
                                                           const hexhex_map* map, const char* file,
                                                           hexhex_context* context,
                                                           hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const hexhex_piecewise_mesh& given = require(mesh, "mesh");
    ContextOrDefault used(context);
    hexhex::writePatches(given.piecewise, extractedMap(given, map), &require(file, "file"), *used);
  });
}

hexhex_status hexhex_extract_lagrange(const hexhex_map* map, int order,
                                      const hexhex_extract_options* options,
                                      hexhex_context* context, hexhex_lagrange_mesh** mesh,
                                      hexhex_statistics* statistics, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    require(mesh, "mesh");
    ContextOrDefault used(context);
    hexhex::ExtractStatistics filled;
    auto handle = std::make_unique<hexhex_lagrange_mesh>();
    handle->mesh = hexhex::extractLagrange(require(map, "map").view, order, extractOptions(options),
                                           *used, &filled);
    writeStatistics(filled, statistics);
    *mesh = handle.release();
  });
}

void hexhex_lagrange_mesh_destroy(hexhex_lagrange_mesh* mesh) { delete mesh; }

hexhex_status hexhex_lagrange_mesh_get_arrays(const hexhex_lagrange_mesh* mesh,
                                              hexhex_lagrange_arrays* arrays, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const hexhex::LagrangeMesh& m = require(mesh, "mesh").mesh;
    const hexhex_lagrange_arrays result = {
        .size = sizeof(hexhex_lagrange_arrays),
        .order = m.order,
        .points = flat<double>(m.points),
        .point_count = m.points.size(),
        .vertex_count = m.vertexCount,
        .nodes = flat<std::uint32_t>(m.nodes),
        .cell_count = m.cellCount(),
        .generator_tet = flat<std::uint32_t>(m.generatorTet),
        .generator_corners = flat<std::uint8_t>(m.generatorCorners)};
    writeStruct(result, require(arrays, "arrays"), "arrays");
  });
}

hexhex_status hexhex_lagrange_mesh_take(hexhex_lagrange_mesh* mesh, hexhex_mesh_array array,
                                        hexhex_buffer** buffer, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    require(buffer, "buffer");
    hexhex::LagrangeMesh& m = require(mesh, "mesh").mesh;
    auto made = std::make_unique<hexhex_buffer>();
    if (array == HEXHEX_POINTS) {
      made->array = std::exchange(m.points, {});
    } else if (array == HEXHEX_CELLS) {
      made->array = std::exchange(m.nodes, {});
    } else if (array == HEXHEX_GENERATOR_TET) {
      made->array = std::exchange(m.generatorTet, {});
    } else if (array == HEXHEX_GENERATOR_CORNERS) {
      made->array = std::exchange(m.generatorCorners, {});
    } else {
      throw Error(ErrorCode::InvalidArgument,
                  "Of a mesh of higher order, points, cells and generators can be taken.");
    }
    *buffer = made.release();
  });
}

hexhex_status hexhex_lagrange_mesh_straight(const hexhex_lagrange_mesh* mesh,
                                            hexhex_mesh** straight, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    require(straight, "straight");
    give(hexhex::straightMesh(require(mesh, "mesh").mesh), straight);
  });
}

hexhex_status hexhex_lagrange_mesh_quality(const hexhex_lagrange_mesh* mesh,
                                           hexhex_context* context, double* scaled_jacobians,
                                           hexhex_quality* quality, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    ContextOrDefault used(context);
    const auto jacobians = hexhex::scaledJacobians(require(mesh, "mesh").mesh, *used);
    if (scaled_jacobians != nullptr) {
      std::copy(jacobians.begin(), jacobians.end(), scaled_jacobians);
    }
    if (quality != nullptr) writeQuality(hexhex::summarize(jacobians), *quality);
  });
}

hexhex_status hexhex_lagrange_mesh_write(const hexhex_lagrange_mesh* mesh, const char* file,
                                         const hexhex_write_options* options,
                                         hexhex_context* context, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const hexhex::LagrangeMesh& given = require(mesh, "mesh").mesh;
    ContextOrDefault used(context);
    hexhex::writeLagrangeMesh(given, &require(file, "file"),
                              writeOptions(options, given.cellCount()), *used);
  });
}
