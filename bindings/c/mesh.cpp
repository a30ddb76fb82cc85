#include <algorithm>
#include <string>
#include <utility>

#include <hexhex/patches.hpp>
#include <hexhex/quality.hpp>
#include <hexhex/structure.hpp>
#include <hexhex/summary.hpp>

#include "options.hpp"

using hexhex::Error;
using hexhex::ErrorCode;

namespace {

static_assert(sizeof(hexhex::Hex) == 8 * sizeof(std::uint32_t));
static_assert(sizeof(hexhex::FeatureQuad) == sizeof(hexhex_feature_quad));

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
  *out = enter(std::move(handle));
}

std::vector<TagName> namesOf(const hexhex_tag_name* names, std::size_t count) {
  std::vector<TagName> list;
  for (const hexhex_tag_name& known : borrowed<hexhex_tag_name>(names, count, "tag_names")) {
    list.push_back({known.dimension, known.tag, &require(known.name, "a name of tag_names")});
  }
  return list;
}

void writeSummary(const MeshSummary& summary, hexhex_mesh_summary* out) {
  hexhex_mesh_summary result = {
      sizeof(hexhex_mesh_summary), summary.points,      summary.cells, {}, {},
      summary.pointChecksum,       summary.cellChecksum};
  std::copy(summary.lower.begin(), summary.lower.end(), result.lower);
  std::copy(summary.upper.begin(), summary.upper.end(), result.upper);
  writeStruct(result, require(out, "summary"), "summary");
}

void writeQuality(const Array<double>& values, double* scaledJacobians, hexhex_quality* out) {
  if (scaledJacobians != nullptr) std::copy(values.begin(), values.end(), scaledJacobians);
  if (out == nullptr) return;
  const QualitySummary summary = summarize(values);
  hexhex_quality result = {
      sizeof(hexhex_quality), summary.minimum, summary.mean, summary.notPositive, {}};
  std::copy(summary.histogram.begin(), summary.histogram.end(), result.histogram);
  writeStruct(result, *out, "quality");
}

void writeCertificate(const Certificate& certificate, std::uint8_t* validity,
                      double* scaledJacobians, hexhex_certificate* out) {
  hexhex_certificate result = HEXHEX_CERTIFICATE_INIT;
  result.positive = certificate.positive;
  result.refuted = certificate.refuted;
  result.undecided = certificate.undecided;
  result.minimum = certificate.minimum;
  for (const RefutedCell& bad : certificate.worst) {
    hexhex_refuted_cell& cell = result.worst[result.worst_count++];
    cell.cell = bad.cell;
    std::copy(bad.place.begin(), bad.place.end(), cell.place);
    std::copy(bad.position.begin(), bad.position.end(), cell.position);
    cell.scaled_jacobian = bad.scaledJacobian;
  }
  if (out != nullptr) writeStruct(result, *out, "certificate");
  if (validity != nullptr) {
    std::transform(certificate.validity.begin(), certificate.validity.end(), validity,
                   [](Validity each) { return static_cast<std::uint8_t>(each); });
  }
  if (scaledJacobians != nullptr) {
    std::copy(certificate.scaledJacobians.begin(), certificate.scaledJacobians.end(),
              scaledJacobians);
  }
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
    result.points = copied<decltype(result.points)>(given.points, given.point_count, "points");
    result.cells = copied<decltype(result.cells)>(given.cells, given.cell_count, "cells");
    copyBesides(given, given.point_count, result);
    result.features.names = namesOf(given.tag_names, given.tag_name_count);
    give(std::move(result), mesh);
  });
}

hexhex_status hexhex_mesh_get_arrays(const hexhex_mesh* mesh, hexhex_mesh_arrays* arrays,
                                     hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const Used used(mesh, "mesh");
    const hexhex::HexMesh& m = used->mesh();
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
    const std::span names = used->names.of(m.features.names);
    result.tag_names = flat<hexhex_tag_name>(names);
    result.tag_name_count = names.size();
    writeStruct(result, require(arrays, "arrays"), "arrays");
  });
}

hexhex_status hexhex_mesh_take(hexhex_mesh* mesh, hexhex_mesh_array array, hexhex_buffer** buffer,
                               hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    require(buffer, "buffer");
    const Used used(mesh, "mesh");
    hexhex::HexMesh& own = used->own;
    *buffer = enter(takeArray(own, own.cells, array));
  });
}

void* hexhex_buffer_data(hexhex_buffer* buffer) {
  const hexhex::c::Used used(buffer, std::nothrow, hexhex::c::Use::Read);
  if (!used) return nullptr;
  return std::visit([](auto& array) -> void* { return array.empty() ? nullptr : array.data(); },
                    used->array);
}

size_t hexhex_buffer_bytes(const hexhex_buffer* buffer) {
  const hexhex::c::Used used(buffer, std::nothrow);
  if (!used) return 0;
  return std::visit([](const auto& array) { return array.size() * sizeof(array[0]); }, used->array);
}

void hexhex_buffer_destroy(hexhex_buffer* buffer) { hexhex::c::destroy(buffer); }

void hexhex_mesh_destroy(hexhex_mesh* mesh) {
  using namespace hexhex::c;
  const Used used(mesh, std::nothrow, Use::Look);
  if (used && used->lent == nullptr) destroy(mesh);
}

hexhex_status hexhex_mesh_boundary_patches(const hexhex_mesh* mesh, double angle,
                                           hexhex_context* context, hexhex_buffer** quads,
                                           hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    require(quads, "quads");
    ContextOrDefault used(context);
    auto buffer = std::make_unique<hexhex_buffer>();
    buffer->array = hexhex::boundaryPatches(Used(mesh, "mesh")->mesh(), angle, *used);
    *quads = enter(std::move(buffer));
  });
}

hexhex_status hexhex_mesh_structure(const hexhex_mesh* mesh, hexhex_context* context,
                                    hexhex_structure* structure, hexhex_buffer** singular_edges,
                                    hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    ContextOrDefault used(context);
    const auto found = hexhex::findStructure(Used(mesh, "mesh")->mesh(), *used);
    auto buffer = std::make_unique<hexhex_buffer>();
    if (singular_edges != nullptr) buffer->array = singularEdges(found);
    if (structure != nullptr) {
      const hexhex_structure result = {
          sizeof(hexhex_structure), found.faces,      found.edges,
          found.boundaryQuads,      found.components, found.boundaryComponents,
          found.eulerCharacteristic};
      writeStruct(result, *structure, "structure");
    }
    if (singular_edges != nullptr) *singular_edges = enter(std::move(buffer));
  });
}

hexhex_status hexhex_summarize_mesh(const hexhex_mesh* mesh, hexhex_context* context,
                                    hexhex_mesh_summary* summary, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    ContextOrDefault used(context);
    writeSummary(hexhex::summarize(Used(mesh, "mesh")->mesh(), *used), summary);
  });
}

hexhex_status hexhex_summarize_file(const char* file, const hexhex_read_options* options,
                                    hexhex_context* context, hexhex_mesh_summary* summary,
                                    hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    ContextOrDefault used(context);
    writeSummary(hexhex::summarizeFile(&require(file, "file"), readOptions(options), *used),
                 summary);
  });
}

int hexhex_generator_kind(uint8_t corners) {
  constexpr std::uint8_t kWholeTet = 15;
  if (corners == 0 || corners > kWholeTet) return -1;
  return static_cast<int>(hexhex::generatorKind(corners));
}

double hexhex_scaled_jacobian(const double corners[24]) {
  if (corners == nullptr) return 0;
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
    writeQuality(hexhex::scaledJacobians(Used(mesh, "mesh")->mesh(), *used), scaled_jacobians,
                 quality);
  });
}

hexhex_status hexhex_mesh_certify(const hexhex_mesh* mesh, hexhex_context* context,
                                  uint8_t* validity, double* scaled_jacobians,
                                  hexhex_certificate* certificate, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    ContextOrDefault used(context);
    writeCertificate(hexhex::certify(Used(mesh, "mesh")->mesh(), *used), validity, scaled_jacobians,
                     certificate);
  });
}

hexhex_status hexhex_summarize_quality(const double* values, size_t count, hexhex_quality* quality,
                                       hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const auto given = copied<hexhex::Array<double>>(values, count, "values");
    writeQuality(given, nullptr, &require(quality, "quality"));
  });
}
