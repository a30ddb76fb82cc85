#include <algorithm>
#include <string>
#include <utility>

#include <hexhex/io.hpp>
#include <hexhex/quality.hpp>
#include <hexhex/survey.hpp>

#include "handles.hpp"

using hexhex::Error;
using hexhex::ErrorCode;

namespace {

static_assert(sizeof(hexhex::Hex) == 8 * sizeof(std::uint32_t));

template <class T, class Scalar>
hexhex::Array<T> copied(const Scalar* data, std::size_t count, const char* argument) {
  if (count != 0 && data == nullptr) hexhex::c::throwNull(argument);
  const T* const elements = reinterpret_cast<const T*>(data);
  return {elements, elements + count};
}

/// A pointer to the scalars of an array; NULL if it is empty.
template <class Scalar, class T>
const Scalar* flat(const hexhex::Array<T>& array) {
  return array.empty() ? nullptr : reinterpret_cast<const Scalar*>(array.data());
}

void give(hexhex::HexMesh&& mesh, hexhex_mesh** out) {
  *out = std::make_unique<hexhex_mesh>(hexhex_mesh{std::move(mesh)}).release();
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

void writeQuality(const hexhex::QualitySummary& summary, hexhex_quality& out) {
  hexhex_quality result = {
      sizeof(hexhex_quality), summary.minimum, summary.mean, summary.notPositive, {}};
  std::copy(summary.histogram.begin(), summary.histogram.end(), result.histogram);
  hexhex::c::writeStruct(result, out, "quality");
}

}  // namespace

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
    give(std::move(result), mesh);
  });
}

hexhex_status hexhex_mesh_read(const char* file, hexhex_context* context, hexhex_mesh** mesh,
                               hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    require(mesh, "mesh");
    ContextOrDefault used(context);
    give(hexhex::readHexMesh(&require(file, "file"), *used), mesh);
  });
}

hexhex_status hexhex_mesh_write(const hexhex_mesh* mesh, const char* file, const char* format,
                                hexhex_context* context, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    hexhex::WriteOptions options;
    if (format != nullptr) options.format = format;
    ContextOrDefault used(context);
    hexhex::writeHexMesh(require(mesh, "mesh").mesh, &require(file, "file"), options, *used);
  });
}

hexhex_status hexhex_mesh_get_arrays(const hexhex_mesh* mesh, hexhex_mesh_arrays* arrays,
                                     hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const hexhex::HexMesh& m = require(mesh, "mesh").mesh;
    const hexhex_mesh_arrays result = {sizeof(hexhex_mesh_arrays),
                                       flat<double>(m.points),
                                       m.points.size(),
                                       flat<std::uint32_t>(m.cells),
                                       m.cells.size(),
                                       flat<std::uint32_t>(m.generatorTet),
                                       flat<std::uint8_t>(m.generatorCorners)};
    writeStruct(result, require(arrays, "arrays"), "arrays");
  });
}

hexhex_status hexhex_mesh_take(hexhex_mesh* mesh, hexhex_mesh_array array, hexhex_buffer** buffer,
                               hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    require(buffer, "buffer");
    *buffer = take(require(mesh, "mesh").mesh, array).release();
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

hexhex_status hexhex_mesh_survey(const hexhex_mesh* mesh, hexhex_context* context,
                                 hexhex_survey* survey, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    ContextOrDefault used(context);
    writeSurvey(hexhex::survey(require(mesh, "mesh").mesh, *used), survey);
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
    const auto jacobians = hexhex::scaledJacobians(require(mesh, "mesh").mesh, *used);
    if (scaled_jacobians != nullptr) {
      std::copy(jacobians.begin(), jacobians.end(), scaled_jacobians);
    }
    if (quality != nullptr) writeQuality(hexhex::summarize(jacobians), *quality);
  });
}
