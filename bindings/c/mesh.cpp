#include <algorithm>
#include <string>
#include <utility>

#include <hexhex/patches.hpp>
#include <hexhex/quality.hpp>
#include <hexhex/structure.hpp>
#include <hexhex/survey.hpp>

#include "handles.hpp"

using hexhex::Error;
using hexhex::ErrorCode;

namespace {

static_assert(sizeof(hexhex::Hex) == 8 * sizeof(std::uint32_t));
static_assert(sizeof(hexhex::FeatureQuad) == sizeof(hexhex_feature_quad));

template <class T, class List = hexhex::Array<T>, class Scalar>
List copied(const Scalar* data, std::size_t count, const char* argument) {
  const auto elements = hexhex::c::borrowed<T>(data, count, argument);
  return {elements.begin(), elements.end()};
}
template <class T, class Scalar>
std::vector<T> copiedTags(const Scalar* data, std::size_t count, const char* argument) {
  return copied<T, std::vector<T>>(data, count, argument);
}

std::unique_ptr<hexhex_buffer> take(hexhex::HexMesh& mesh, hexhex_mesh_array array) {
  auto buffer = std::make_unique<hexhex_buffer>();
  switch (array) {
    case HEXHEX_POINTS:
      buffer->array = std::exchange(mesh.points, {});
      return buffer;
    case HEXHEX_CELLS:
      buffer->array = std::exchange(mesh.cells, {});
      return buffer;
    case HEXHEX_GENERATOR_TET:
      buffer->array = std::exchange(mesh.generatorTet, {});
      return buffer;
    case HEXHEX_GENERATOR_CORNERS:
      buffer->array = std::exchange(mesh.generatorCorners, {});
      return buffer;
    case HEXHEX_REGIONS:
      buffer->array = std::exchange(mesh.regions, {});
      return buffer;
    case HEXHEX_FEATURE_VERTICES:
      buffer->array = std::exchange(mesh.features.vertices, {});
      return buffer;
    case HEXHEX_FEATURE_EDGES:
      buffer->array = std::exchange(mesh.features.edges, {});
      return buffer;
    case HEXHEX_FEATURE_QUADS:
      buffer->array = std::exchange(mesh.features.quads, {});
      return buffer;
  }
  throw Error(ErrorCode::InvalidArgument, "A mesh has no such array.");
}

void writeSurvey(const hexhex::MeshSurvey& survey, hexhex_survey* out) {
  hexhex_survey result = {sizeof(hexhex_survey), survey.points,      survey.cells, {}, {},
                          survey.pointChecksum,  survey.cellChecksum};
  std::copy(survey.lower.begin(), survey.lower.end(), result.lower);
  std::copy(survey.upper.begin(), survey.upper.end(), result.upper);
  hexhex::c::writeStruct(result, hexhex::c::require(out, "survey"), "survey");
}

std::vector<hexhex_singular_edge> singularEdges(const hexhex::MeshStructure& structure) {
  std::vector<hexhex_singular_edge> edges;
  edges.reserve(structure.singularEdges.size());
  for (const hexhex::SingularHexEdge& edge : structure.singularEdges) {
    edges.push_back({{edge.vertex0, edge.vertex1}, edge.valence, edge.boundary ? 1U : 0U});
  }
  return edges;
}

}  // namespace

namespace hexhex::c {

void give(HexMesh&& mesh, hexhex_mesh** out) {
  auto handle = std::make_unique<hexhex_mesh>();
  handle->own = std::move(mesh);
  *out = handle.release();
}

void writeQuality(const QualitySummary& summary, hexhex_quality& out) {
  hexhex_quality result = {
      sizeof(hexhex_quality), summary.minimum, summary.mean, summary.notPositive, {}};
  std::copy(summary.histogram.begin(), summary.histogram.end(), result.histogram);
  writeStruct(result, out, "quality");
}

}  // namespace hexhex::c

hexhex_status hexhex_mesh_copy(const hexhex_mesh_arrays* arrays, hexhex_mesh** mesh,
                               hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const hexhex_mesh_arrays given =
        readStruct(&require(arrays, "arrays"), HEXHEX_MESH_ARRAYS_INIT, "arrays");
    require(mesh, "mesh");
    hexhex::HexMesh result;
    result.points = copied<hexhex::Vec3>(given.points, given.point_count, "points");
    result.cells = copied<hexhex::Hex>(given.cells, given.cell_count, "cells");
    if (given.generator_tet != nullptr && given.generator_corners != nullptr) {
      result.generatorTet =
          copied<hexhex::Index>(given.generator_tet, given.point_count, "generator_tet");
      result.generatorCorners = copied<hexhex::CornerSet>(given.generator_corners,
                                                          given.point_count, "generator_corners");
    }
    result.features = {.vertices = copiedTags<hexhex::FeatureVertex>(
                           given.feature_vertices, given.feature_vertex_count, "feature_vertices"),
                       .edges = copiedTags<hexhex::FeatureEdge>(
                           given.feature_edges, given.feature_edge_count, "feature_edges"),
                       .quads = copiedTags<hexhex::FeatureQuad>(
                           given.feature_quads, given.feature_quad_count, "feature_quads")};
    if (given.regions != nullptr) {
      result.regions = copied<std::int32_t>(given.regions, given.cell_count, "regions");
    }
    give(std::move(result), mesh);
  });
}

hexhex_status hexhex_mesh_get_arrays(const hexhex_mesh* mesh, hexhex_mesh_arrays* arrays,
                                     hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const hexhex::HexMesh& m = require(mesh, "mesh").mesh();
    hexhex_mesh_arrays result = HEXHEX_MESH_ARRAYS_INIT;
    result.points = flat<double>(m.points);
    result.point_count = m.points.size();
    result.cells = flat<std::uint32_t>(m.cells);
    result.cell_count = m.cells.size();
    result.generator_tet = flat<std::uint32_t>(m.generatorTet);
    result.generator_corners = flat<std::uint8_t>(m.generatorCorners);
    result.feature_vertices = flat<hexhex_feature_vertex>(m.features.vertices);
    result.feature_vertex_count = m.features.vertices.size();
    result.feature_edges = flat<hexhex_feature_edge>(m.features.edges);
    result.feature_edge_count = m.features.edges.size();
    result.feature_quads = flat<hexhex_feature_quad>(m.features.quads);
    result.feature_quad_count = m.features.quads.size();
    result.regions = flat<std::int32_t>(m.regions);
    writeStruct(result, require(arrays, "arrays"), "arrays");
  });
}

hexhex_status hexhex_mesh_take(hexhex_mesh* mesh, hexhex_mesh_array array, hexhex_buffer** buffer,
                               hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    require(buffer, "buffer");
    *buffer = take(require(mesh, "mesh").own, array).release();
  });
}

void* hexhex_buffer_data(hexhex_buffer* buffer) {
  if (buffer == nullptr) return nullptr;
  return std::visit([](auto& array) -> void* { return array.empty() ? nullptr : array.data(); },
                    buffer->array);
}

size_t hexhex_buffer_bytes(const hexhex_buffer* buffer) {
  if (buffer == nullptr) return 0;
  return std::visit([](const auto& array) { return array.size() * sizeof(array[0]); },
                    buffer->array);
}

void hexhex_buffer_destroy(hexhex_buffer* buffer) { delete buffer; }

void hexhex_mesh_destroy(hexhex_mesh* mesh) { delete mesh; }

hexhex_status hexhex_mesh_boundary_patches(const hexhex_mesh* mesh, double angle,
                                           hexhex_context* context, hexhex_buffer** quads,
                                           hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    require(quads, "quads");
    ContextOrDefault used(context);
    auto buffer = std::make_unique<hexhex_buffer>();
    buffer->array = hexhex::boundaryPatches(require(mesh, "mesh").mesh(), angle, *used);
    *quads = buffer.release();
  });
}

hexhex_status hexhex_mesh_structure(const hexhex_mesh* mesh, hexhex_context* context,
                                    hexhex_structure* structure, hexhex_buffer** singular_edges,
                                    hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    ContextOrDefault used(context);
    const auto found = hexhex::findStructure(require(mesh, "mesh").mesh(), *used);
    auto buffer = std::make_unique<hexhex_buffer>();
    if (singular_edges != nullptr) buffer->array = singularEdges(found);
    if (structure != nullptr) {
      const hexhex_structure result = {
          sizeof(hexhex_structure), found.faces,      found.edges,
          found.boundaryQuads,      found.components, found.boundaryComponents,
          found.eulerCharacteristic};
      writeStruct(result, *structure, "structure");
    }
    if (singular_edges != nullptr) *singular_edges = buffer.release();
  });
}

hexhex_status hexhex_mesh_survey(const hexhex_mesh* mesh, hexhex_context* context,
                                 hexhex_survey* survey, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    ContextOrDefault used(context);
    writeSurvey(hexhex::survey(require(mesh, "mesh").mesh(), *used), survey);
  });
}

hexhex_status hexhex_file_survey(const char* file, hexhex_context* context, hexhex_survey* survey,
                                 hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    ContextOrDefault used(context);
    writeSurvey(hexhex::surveyFile(&require(file, "file"), *used), survey);
  });
}

double hexhex_scaled_jacobian(const double corners[24]) {
  std::array<hexhex::Vec3, 8> points{};
  for (std::size_t i = 0; i < 24; ++i) points[i / 3][i % 3] = corners[i];
  return hexhex::scaledJacobian(points);
}

hexhex_status hexhex_mesh_quality(const hexhex_mesh* mesh, hexhex_context* context,
                                  double* scaled_jacobians, hexhex_quality* quality,
                                  hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    ContextOrDefault used(context);
    const auto jacobians = hexhex::scaledJacobians(require(mesh, "mesh").mesh(), *used);
    if (scaled_jacobians != nullptr) {
      std::copy(jacobians.begin(), jacobians.end(), scaled_jacobians);
    }
    if (quality != nullptr) writeQuality(hexhex::summarize(jacobians), *quality);
  });
}
