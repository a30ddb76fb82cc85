#include <string>

#include <hexhex/io.hpp>
#include <hexhex/samples.hpp>

#include "handles.hpp"

using hexhex::Error;
using hexhex::ErrorCode;

namespace {

// C sees the arrays as flat ones.
static_assert(sizeof(hexhex::Vec3) == 3 * sizeof(double));
static_assert(sizeof(hexhex::Tet) == 4 * sizeof(std::uint32_t));
static_assert(sizeof(hexhex::TetParameters) == 12 * sizeof(double));
static_assert(sizeof(std::array<std::int8_t, 4>) == 4);
static_assert(sizeof(hexhex::EdgeValence) == sizeof(hexhex_edge_valence));

/// `count` elements of T in the caller's flat array.
template <class T, class Scalar>
std::span<const T> borrowed(const Scalar* data, std::size_t count, const char* argument) {
  if (count != 0 && data == nullptr) hexhex::c::throwNull(argument);
  return {reinterpret_cast<const T*>(data), count};
}

hexhex::SampleKind kindNamed(const char* kind) {
  for (const hexhex::SampleKindName& entry : hexhex::sampleKinds()) {
    if (entry.name == kind) return entry.kind;
  }
  throw Error(ErrorCode::InvalidArgument, std::string("There is no kind of map called \"") + kind +
                                              "\". Choose one of those in hexhex.h.");
}

hexhex::SampleOptions sampleOptions(const hexhex_sample_options* given) {
  const hexhex_sample_options options =
      hexhex::c::readStruct(given, HEXHEX_SAMPLE_OPTIONS_INIT, "options");
  if (options.charts < HEXHEX_CHARTS_ALIGNED || options.charts > HEXHEX_CHARTS_RANDOM) {
    throw Error(ErrorCode::InvalidArgument, "There is no such style of charts.");
  }
  return {.cells = options.cells,
          .refine = options.refine,
          .valence = options.valence,
          .charts = static_cast<hexhex::ChartStyle>(options.charts),
          .jitter = options.jitter,
          .onLattice = options.on_lattice,
          .noise = options.noise,
          .offset = options.offset,
          .seed = options.seed};
}

void give(hexhex::TetMap&& map, hexhex_map** out) {
  auto handle = std::make_unique<hexhex_map>();
  handle->owned = std::move(map);
  handle->view = handle->owned;
  *out = handle.release();
}

/// For the writer, which wants a map of its own.
hexhex::TetMap copied(const hexhex::TetMapView& view) {
  return {.points = {view.points.begin(), view.points.end()},
          .tets = {view.tets.begin(), view.tets.end()},
          .parameters = {view.parameters.begin(), view.parameters.end()},
          .edgeValences = {view.edgeValences.begin(), view.edgeValences.end()},
          .rotations = {view.rotations.begin(), view.rotations.end()}};
}

}  // namespace

hexhex_status hexhex_map_borrow(const hexhex_map_arrays* arrays, hexhex_map** map,
                                hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const hexhex_map_arrays given =
        readStruct(&require(arrays, "arrays"), HEXHEX_MAP_ARRAYS_INIT, "arrays");
    require(map, "map");
    auto handle = std::make_unique<hexhex_map>();
    handle->view = {
        borrowed<hexhex::Vec3>(given.points, given.point_count, "points"),
        borrowed<hexhex::Tet>(given.tets, given.tet_count, "tets"),
        borrowed<hexhex::TetParameters>(given.parameters, given.tet_count, "parameters")};
    handle->view.edgeValences = borrowed<hexhex::EdgeValence>(
        given.edge_valences, given.edge_valence_count, "edge_valences");
    if (given.rotations != nullptr) {
      handle->view.rotations =
          borrowed<std::array<std::int8_t, 4>>(given.rotations, given.tet_count, "rotations");
    }
    *map = handle.release();
  });
}

hexhex_status hexhex_map_read(const char* file, hexhex_context* context, hexhex_map** map,
                              hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    require(map, "map");
    ContextOrDefault used(context);
    give(hexhex::readMap(&require(file, "file"), *used), map);
  });
}

hexhex_status hexhex_map_write(const hexhex_map* map, const char* file, hexhex_context* context,
                               hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const hexhex_map& given = require(map, "map");
    ContextOrDefault used(context);
    const bool own = given.view.tets.data() == given.owned.tets.data();
    hexhex::writeMap(own ? given.owned : copied(given.view), &require(file, "file"), *used);
  });
}

hexhex_status hexhex_map_generate(const char* kind, const hexhex_sample_options* options,
                                  hexhex_map** map, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    require(map, "map");
    give(hexhex::generateSample(kindNamed(&require(kind, "kind")), sampleOptions(options)).map,
         map);
  });
}

hexhex_status hexhex_map_get_arrays(const hexhex_map* map, hexhex_map_arrays* arrays,
                                    hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const hexhex::TetMapView& view = require(map, "map").view;
    const hexhex_map_arrays result = {
        sizeof(hexhex_map_arrays),
        reinterpret_cast<const double*>(view.points.data()),
        view.points.size(),
        reinterpret_cast<const std::uint32_t*>(view.tets.data()),
        view.tets.size(),
        reinterpret_cast<const double*>(view.parameters.data()),
        reinterpret_cast<const hexhex_edge_valence*>(view.edgeValences.data()),
        view.edgeValences.size(),
        reinterpret_cast<const std::int8_t*>(view.rotations.data())};
    writeStruct(result, require(arrays, "arrays"), "arrays");
  });
}

void hexhex_map_destroy(hexhex_map* map) { delete map; }
