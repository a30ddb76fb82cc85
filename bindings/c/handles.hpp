// What the opaque handles are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
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
#include <hexhex/summary.hpp>
#include <hexhex/types.hpp>
#include <hexhex/verify.hpp>

#include "guard.hpp"
#include "live_handle.hpp"

namespace hexhex::c {

/// Names as C sees them: of a handle, made once they are asked for.
class Names {
 public:
  /// @param names  the same each time
  std::span<const hexhex_tag_name> of(std::span<const TagName> names) const {
    std::call_once(once_, [&] {
      names_.assign(names.begin(), names.end());  // a mesh that is improved moves its own
      for (const TagName& known : names_) {
        list_.push_back({known.dimension, known.tag, known.name.c_str()});
      }
    });
    return list_;
  }

 private:
  mutable std::once_flag once_;
  mutable std::vector<TagName> names_;
  mutable std::vector<hexhex_tag_name> list_;
};

}  // namespace hexhex::c

struct hexhex_context : hexhex::c::HandleMemory {
  hexhex_context(int threads, hexhex_progress progress, void* user);
  hexhex::Context context;
  hexhex::RepairedMap repaired = {};  ///< of the last extraction in pieces
};

struct hexhex_map : hexhex::c::HandleMemory {
  std::shared_ptr<const hexhex::TetMap> owned;  ///< null if the arrays are the caller's
  hexhex::TetMapView view;
  std::shared_ptr<const hexhex::SampleAnswer> answer;  ///< null if it was not generated
  std::vector<hexhex::TagName> given;                  ///< with the caller's arrays
  hexhex::c::Names names;
};

struct hexhex_map_structure : hexhex::c::HandleMemory {
  std::vector<hexhex_chart_jump> chartJumps;
  std::vector<hexhex_singular_tet_edge> singularEdges;
  std::size_t defects = 0;
};

struct hexhex_mesh : hexhex::c::HandleMemory {
  hexhex::HexMesh own;
  /// This one instead, which belongs to another handle, and so does this handle.
  std::shared_ptr<const hexhex::HexMesh> lent = nullptr;
  [[nodiscard]] const hexhex::HexMesh& mesh() const noexcept { return lent ? *lent : own; }
  hexhex::RepairedMap repaired = {};  ///< of the extraction that made it
  hexhex::c::Names names;
};

struct hexhex_buffer : hexhex::c::HandleMemory {
  std::variant<hexhex::Array<hexhex::Vec3>, hexhex::Array<hexhex::Hex>,
               hexhex::Array<hexhex::Index>, hexhex::Array<hexhex::CornerSet>,
               hexhex::Array<std::int32_t>, std::vector<hexhex::FeatureVertex>,
               std::vector<hexhex::FeatureEdge>, std::vector<hexhex::FeatureQuad>,
               std::vector<hexhex_singular_edge>>
      array;
};

struct hexhex_extractor : hexhex::c::HandleMemory {
  hexhex_extractor(const hexhex_map* given, const hexhex::ExtractorOptions& options,
                   hexhex::Context& used)
      : map(given, "map"), extractor(map->view, options, used) {}
  hexhex::c::Used<const hexhex_map> map;  ///< which is there as long as this
  hexhex::Extractor extractor;
};

struct hexhex_check_report : hexhex::c::HandleMemory {
  hexhex::CheckReport report;
};

struct hexhex_verify_report : hexhex::c::HandleMemory {
  hexhex::VerifyReport report;
};

struct hexhex_repair_report : hexhex::c::HandleMemory {
  hexhex::RepairReport report;
};

struct hexhex_holes : hexhex::c::HandleMemory {
  std::vector<hexhex::Hole> holes;
  std::uint64_t invalidTets = 0;
  double missingCells = 0;
  std::uint64_t faceConflicts = 0;
};

struct hexhex_piecewise_mesh : hexhex::c::HandleMemory {
  hexhex_piecewise_mesh() = default;
  ~hexhex_piecewise_mesh() { hexhex::c::destroy(straight); }
  hexhex_piecewise_mesh(const hexhex_piecewise_mesh&) = delete;
  hexhex_piecewise_mesh& operator=(const hexhex_piecewise_mesh&) = delete;
  /// Makes the handle of the mesh in it, for the caller to see.
  void take(hexhex::PiecewiseLinearMesh&& made);
  std::shared_ptr<const hexhex::PiecewiseLinearMesh> piecewise;
  hexhex_mesh* straight = nullptr;
};

struct hexhex_lagrange_mesh : hexhex::c::HandleMemory {
  hexhex::LagrangeMesh mesh;
  hexhex::RepairedMap repaired = {};
};

struct hexhex_mesh_writer : hexhex::c::HandleMemory {
  /// @param context  or null; it is there as long as this
  explicit hexhex_mesh_writer(hexhex_context* context) {
    if (context != nullptr) given.emplace(context, "context", hexhex::c::Use::Look);
  }
  [[nodiscard]] hexhex::Context& context() { return given ? (*given)->context : own; }
  std::optional<hexhex::c::Used<hexhex_context>> given;
  hexhex::Context own;
  std::unique_ptr<hexhex::MeshSink> sink;
  hexhex::SummarySink* summary = nullptr;  ///< the sink, if it has no file
  bool ended = false;
};

namespace hexhex::c {

/// The caller's context, or one with defaults.
class ContextOrDefault {
 public:
  explicit ContextOrDefault(hexhex_context* given) {
    if (given != nullptr) given_.emplace(given, "context");
  }
  Context& operator*() noexcept { return given_ ? (*given_)->context : own_; }
  /// For hexhex_context_get_repair(): emptied, for what the next extraction in pieces repairs.
  RepairedMap& repaired() noexcept { return (given_ ? (*given_)->repaired : repaired_) = {}; }

 private:
  std::optional<Used<hexhex_context>> given_;
  Context own_;
  RepairedMap repaired_;
};

/// Refuses a number of elements that no memory can have.
template <class T>
void requireCount(std::size_t count, const char* argument) {
  if (count > static_cast<std::size_t>(PTRDIFF_MAX) / sizeof(T)) throwCount(argument, count);
}

/// A pointer to the scalars of an array; NULL if it is empty.
template <class Scalar, class List>
const Scalar* flat(const List& array) {
  return array.empty() ? nullptr : reinterpret_cast<const Scalar*>(array.data());
}

/// A copy of `count` elements of T in the caller's flat array.
template <class List, class Scalar>
List copied(const Scalar* data, std::size_t count, const char* argument) {
  if (count != 0 && data == nullptr) throwNull(argument);
  requireCount<typename List::value_type>(count, argument);
  const auto* const first = reinterpret_cast<const typename List::value_type*>(data);
  return {first, first + count};
}

/// `count` elements of T in the caller's flat array.
template <class T, class Scalar>
std::span<const T> borrowed(const Scalar* data, std::size_t count, const char* argument) {
  if (count != 0 && data == nullptr) throwNull(argument);
  requireCount<T>(count, argument);
  return {reinterpret_cast<const T*>(data), count};
}

/// The caller's names of tags.
[[nodiscard]] std::vector<TagName> namesOf(const hexhex_tag_name* names, std::size_t count);

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

void writeSummary(const MeshSummary& summary, hexhex_mesh_summary* out);
/// @param scaledJacobians, out  may be null
void writeQuality(const Array<double>& values, double* scaledJacobians, hexhex_quality* out);

/// What hexhex_mesh_certify() fills; null pointers are left out.
void writeCertificate(const Certificate& certificate, std::uint8_t* validity,
                      double* scaledJacobians, hexhex_certificate* out);

}  // namespace hexhex::c
