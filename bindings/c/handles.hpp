// What the opaque handles are.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <hexhex/check.hpp>
#include <hexhex/context.hpp>
#include <hexhex/curved.hpp>
#include <hexhex/extractor.hpp>
#include <hexhex/partial.hpp>
#include <hexhex/quality.hpp>
#include <hexhex/repair.hpp>
#include <hexhex/samples.hpp>
#include <hexhex/stream.hpp>
#include <hexhex/structure.hpp>
#include <hexhex/survey.hpp>
#include <hexhex/types.hpp>
#include <hexhex/verify.hpp>

#include "guard.hpp"

namespace hexhex::c {

/// What an extraction did to the map before.
struct Repaired {
  RepairReport report = {};
  std::shared_ptr<const TetMap> map = nullptr;  ///< null if nothing was repaired
};

}  // namespace hexhex::c

struct hexhex_context {
  hexhex_context(int threads, hexhex_progress progress, void* user);
  hexhex::Context context;
  std::atomic<bool> busy{false};
  hexhex::c::Repaired repaired = {};  ///< of the last extraction in pieces
};

struct hexhex_map {
  std::shared_ptr<const hexhex::TetMap> owned;  ///< null if the arrays are the caller's
  hexhex::TetMapView view;
  std::shared_ptr<const hexhex::SampleAnswer> answer;  ///< null if it was not generated
};

struct hexhex_map_structure {
  std::vector<hexhex_chart_jump> chartJumps;
  std::vector<hexhex_singular_tet_edge> singularEdges;
  std::size_t defects = 0;
};

struct hexhex_mesh {
  hexhex::HexMesh own;
  const hexhex::HexMesh* lent = nullptr;  ///< this one instead, which belongs to another handle
  [[nodiscard]] const hexhex::HexMesh& mesh() const noexcept { return lent ? *lent : own; }
  hexhex::c::Repaired repaired = {};  ///< of the extraction that made it
};

struct hexhex_buffer {
  std::variant<hexhex::Array<hexhex::Vec3>, hexhex::Array<hexhex::Hex>,
               hexhex::Array<hexhex::Index>, hexhex::Array<hexhex::CornerSet>,
               hexhex::Array<std::int32_t>, std::vector<hexhex::FeatureVertex>,
               std::vector<hexhex::FeatureEdge>, std::vector<hexhex::FeatureQuad>,
               std::vector<hexhex_singular_edge>>
      array;
};

struct hexhex_extractor {
  hexhex::Extractor extractor;
  std::atomic<bool> busy{false};
};

struct hexhex_check_report {
  hexhex::CheckReport report;
};

struct hexhex_verify_report {
  hexhex::VerifyReport report;
};

struct hexhex_repair_report {
  hexhex::RepairReport report;
};

struct hexhex_holes {
  std::vector<hexhex::Hole> holes;
  std::uint64_t invalidTets = 0;
  double missingCells = 0;
  std::uint64_t faceConflicts = 0;
};

struct hexhex_piecewise_mesh {
  hexhex::PiecewiseLinearMesh piecewise;
  hexhex_mesh straight;  ///< the mesh in it, for the caller to see
};

struct hexhex_lagrange_mesh {
  hexhex::LagrangeMesh mesh;
  hexhex::c::Repaired repaired = {};
};

struct hexhex_mesh_writer {
  hexhex::Context own;
  std::unique_ptr<hexhex::MeshSink> sink;
  hexhex::SurveySink* survey = nullptr;  ///< the sink, if it has no file
  bool ended = false;
};

namespace hexhex::c {

/// The caller's extractor, which serves one call at a time.
class OccupiedExtractor {
 public:
  explicit OccupiedExtractor(hexhex_extractor* given) : given_(require(given, "extractor")) {
    if (given_.busy.exchange(true)) throwBusy("extractor");
  }
  ~OccupiedExtractor() { given_.busy.store(false); }
  OccupiedExtractor(const OccupiedExtractor&) = delete;
  OccupiedExtractor& operator=(const OccupiedExtractor&) = delete;
  Extractor* operator->() noexcept { return &given_.extractor; }

 private:
  hexhex_extractor& given_;
};

/// The caller's context, or one with defaults.
class ContextOrDefault {
 public:
  explicit ContextOrDefault(hexhex_context* given) : given_(given) {
    if (given_ != nullptr && given_->busy.exchange(true)) throwBusy("context");
  }
  ~ContextOrDefault() {
    if (given_ != nullptr) given_->busy.store(false);
  }
  ContextOrDefault(const ContextOrDefault&) = delete;
  ContextOrDefault& operator=(const ContextOrDefault&) = delete;
  Context& operator*() noexcept { return given_ != nullptr ? given_->context : own_; }
  /// For hexhex_context_get_repair().
  void keep(Repaired&& repaired) noexcept {
    if (given_ != nullptr) given_->repaired = std::move(repaired);
  }

 private:
  hexhex_context* given_;
  Context own_;
};

/// A pointer to the scalars of an array; NULL if it is empty.
template <class Scalar, class List>
const Scalar* flat(const List& array) {
  return array.empty() ? nullptr : reinterpret_cast<const Scalar*>(array.data());
}

/// A copy of `count` elements of T in the caller's flat array.
template <class List, class Scalar>
List copied(const Scalar* data, std::size_t count, const char* argument) {
  if (count != 0 && data == nullptr) throwNull(argument);
  const auto* const first = reinterpret_cast<const typename List::value_type*>(data);
  return {first, first + count};
}

/// `count` elements of T in the caller's flat array.
template <class T, class Scalar>
std::span<const T> borrowed(const Scalar* data, std::size_t count, const char* argument) {
  if (count != 0 && data == nullptr) throwNull(argument);
  return {reinterpret_cast<const T*>(data), count};
}

/// Generators, tags and regions of the caller's arrays, which both kinds of meshes have.
/// @param count  of points or nodes
template <class Arrays, class Mesh>
void copyBesides(const Arrays& given, std::size_t count, Mesh& mesh) {
  if (given.generator_tet != nullptr && given.generator_corners != nullptr) {
    mesh.generatorTet =
        copied<decltype(mesh.generatorTet)>(given.generator_tet, count, "generator_tet");
    mesh.generatorCorners = copied<decltype(mesh.generatorCorners)>(given.generator_corners, count,
                                                                    "generator_corners");
  }
  mesh.features = {.vertices = copied<decltype(mesh.features.vertices)>(
                       given.feature_vertices, given.feature_vertex_count, "feature_vertices"),
                   .edges = copied<decltype(mesh.features.edges)>(
                       given.feature_edges, given.feature_edge_count, "feature_edges"),
                   .quads = copied<decltype(mesh.features.quads)>(
                       given.feature_quads, given.feature_quad_count, "feature_quads")};
  if (given.regions != nullptr) {
    mesh.regions = copied<decltype(mesh.regions)>(given.regions, given.cell_count, "regions");
  }
}

/// Takes one array of a mesh of either kind.
template <class Mesh, class Cells>
std::unique_ptr<hexhex_buffer> takeArray(Mesh& mesh, Cells& cells, hexhex_mesh_array array) {
  auto buffer = std::make_unique<hexhex_buffer>();
  const auto took = [&buffer](auto& list) {
    buffer->array = std::exchange(list, {});
    return std::move(buffer);
  };
  switch (array) {
    case HEXHEX_POINTS:
      return took(mesh.points);
    case HEXHEX_CELLS:
      return took(cells);
    case HEXHEX_GENERATOR_TET:
      return took(mesh.generatorTet);
    case HEXHEX_GENERATOR_CORNERS:
      return took(mesh.generatorCorners);
    case HEXHEX_REGIONS:
      return took(mesh.regions);
    case HEXHEX_FEATURE_VERTICES:
      return took(mesh.features.vertices);
    case HEXHEX_FEATURE_EDGES:
      return took(mesh.features.edges);
    case HEXHEX_FEATURE_QUADS:
      return took(mesh.features.quads);
  }
  throw Error(ErrorCode::InvalidArgument, "A mesh has no such array.");
}

/// Element i of a report's list.
template <class List>
const auto& at(const List& list, std::size_t i, const char* what) {
  if (i >= list.size()) {
    throw Error(ErrorCode::InvalidArgument, "There are " + std::to_string(list.size()) + " " +
                                                what + "; there is no number " + std::to_string(i) +
                                                ".");
  }
  return list[i];
}

/// Makes a handle of a map.
void give(std::shared_ptr<const TetMap> map, hexhex_map** out);
void give(TetMap&& map, hexhex_map** out);
void give(HexMesh&& mesh, hexhex_mesh** out);
[[nodiscard]] TetMap copyOf(const hexhex_map& map);

void writeSurvey(const MeshSurvey& survey, hexhex_survey* out);
void writeQuality(const QualitySummary& summary, hexhex_quality& out);

}  // namespace hexhex::c
