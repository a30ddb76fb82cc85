#include <hexhex/io.hpp>
#include <hexhex/quantize.hpp>

#include "options.hpp"

namespace {

// C sees the arrays as flat ones.
static_assert(sizeof(hexhex::Vec3) == 3 * sizeof(double));
static_assert(sizeof(hexhex::Tet) == 4 * sizeof(std::uint32_t));
static_assert(sizeof(hexhex::TetParameters) == 12 * sizeof(double));
static_assert(sizeof(std::array<std::int8_t, 4>) == 4);
static_assert(sizeof(hexhex::EdgeValence) == sizeof(hexhex_edge_valence));
static_assert(sizeof(hexhex::FeatureVertex) == sizeof(hexhex_feature_vertex));
static_assert(sizeof(hexhex::FeatureEdge) == sizeof(hexhex_feature_edge));
static_assert(sizeof(hexhex::FeatureFace) == sizeof(hexhex_feature_face));

hexhex::TetMap owned(const hexhex::TetMapView& view) {
  return {.points = {view.points.begin(), view.points.end()},
          .tets = {view.tets.begin(), view.tets.end()},
          .parameters = {view.parameters.begin(), view.parameters.end()},
          .edgeValences = {view.edgeValences.begin(), view.edgeValences.end()},
          .rotations = {view.rotations.begin(), view.rotations.end()},
          .features = view.features.copy(),
          .regions = {view.regions.begin(), view.regions.end()}};
}

hexhex::FeaturesView featuresOf(const hexhex_map_arrays& given) {
  using hexhex::c::borrowed;
  return {
      borrowed<hexhex::FeatureVertex>(given.feature_vertices, given.feature_vertex_count,
                                      "feature_vertices"),
      borrowed<hexhex::FeatureEdge>(given.feature_edges, given.feature_edge_count, "feature_edges"),
      borrowed<hexhex::FeatureFace>(given.feature_faces, given.feature_face_count,
                                    "feature_faces")};
}

/// With names, which a view does not own.
hexhex::Features namedFeatures(const hexhex_map_arrays& given) {
  hexhex::Features copy = featuresOf(given).copy();
  copy.names = hexhex::c::namesOf(given.tag_names, given.tag_name_count);
  return copy;
}

hexhex::TetMapView viewOf(const hexhex_map_arrays& given) {
  using hexhex::c::borrowed;
  hexhex::TetMapView view(
      borrowed<hexhex::Vec3>(given.points, given.point_count, "points"),
      borrowed<hexhex::Tet>(given.tets, given.tet_count, "tets"),
      borrowed<hexhex::TetParameters>(given.parameters, given.tet_count, "parameters"));
  view.edgeValences =
      borrowed<hexhex::EdgeValence>(given.edge_valences, given.edge_valence_count, "edge_valences");
  if (given.rotations != nullptr) {
    view.rotations =
        borrowed<std::array<std::int8_t, 4>>(given.rotations, given.tet_count, "rotations");
  }
  view.features = featuresOf(given);
  if (given.regions != nullptr) view.regions = {given.regions, given.tet_count};
  return view;
}

}  // namespace

namespace hexhex::c {

void give(std::shared_ptr<const TetMap> map, hexhex_map** out) {
  auto handle = std::make_unique<hexhex_map>();
  handle->view = *map;
  handle->owned = std::move(map);
  *out = enter(std::move(handle));
}

void give(TetMap&& map, hexhex_map** out) {
  give(std::make_shared<const TetMap>(std::move(map)), out);
}

TetMesh tetMeshOf(const hexhex_map_arrays* arrays, const char* argument) {
  const hexhex_map_arrays given =
      readStruct(&require(arrays, argument), HEXHEX_MAP_ARRAYS_INIT, argument);
  const auto points = borrowed<Vec3>(given.points, given.point_count, "points");
  const auto tets = borrowed<Tet>(given.tets, given.tet_count, "tets");
  const std::size_t regions = given.regions == nullptr ? 0 : given.tet_count;
  return {.points = {points.begin(), points.end()},
          .tets = {tets.begin(), tets.end()},
          .features = namedFeatures(given),
          .regions = {given.regions, given.regions + regions}};
}

TetMap copyOf(const hexhex_map& map) { return map.owned ? *map.owned : owned(map.view); }

}  // namespace hexhex::c

hexhex_status hexhex_map_borrow(const hexhex_map_arrays* arrays, hexhex_map** map,
                                hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const hexhex_map_arrays given =
        readStruct(&require(arrays, "arrays"), HEXHEX_MAP_ARRAYS_INIT, "arrays");
    require(map, "map");
    auto handle = std::make_unique<hexhex_map>();
    handle->view = viewOf(given);
    handle->given = namesOf(given.tag_names, given.tag_name_count);
    handle->view.features.names = handle->given;
    *map = enter(std::move(handle));
  });
}

hexhex_status hexhex_map_copy(const hexhex_map_arrays* arrays, hexhex_map** map,
                              hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const hexhex_map_arrays given =
        readStruct(&require(arrays, "arrays"), HEXHEX_MAP_ARRAYS_INIT, "arrays");
    require(map, "map");
    hexhex::TetMap copy = owned(viewOf(given));
    copy.features.names = namesOf(given.tag_names, given.tag_name_count);
    give(std::move(copy), map);
  });
}

hexhex_status hexhex_map_from_pair(const hexhex_map_arrays* tets, const hexhex_map_arrays* polycube,
                                   hexhex_context* context, hexhex_map** map, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    require(map, "map");
    ContextOrDefault used(context);
    give(hexhex::mapFromPair(tetMeshOf(tets, "tets"), tetMeshOf(polycube, "polycube"), *used), map);
  });
}

hexhex_status hexhex_map_from_flags(const hexhex_map_arrays* tets, const int8_t* flags,
                                    hexhex_context* context, hexhex_map** map,
                                    hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    require(map, "map");
    const hexhex::TetMesh mesh = tetMeshOf(tets, "tets");
    ContextOrDefault used(context);
    give(hexhex::mapFromFlags(mesh, borrowed<hexhex::FaceFlags>(flags, mesh.tets.size(), "flags"),
                              *used),
         map);
  });
}

hexhex_status hexhex_map_get_arrays(const hexhex_map* map, hexhex_map_arrays* arrays,
                                    hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const Used used(map, "map");
    const hexhex::TetMapView& view = used->view;
    hexhex_map_arrays result = HEXHEX_MAP_ARRAYS_INIT;
    result.points = flat<double>(view.points);
    result.point_count = view.points.size();
    result.tets = flat<std::uint32_t>(view.tets);
    result.tet_count = view.tets.size();
    result.parameters = flat<double>(view.parameters);
    result.edge_valences = flat<hexhex_edge_valence>(view.edgeValences);
    result.edge_valence_count = view.edgeValences.size();
    result.rotations = flat<std::int8_t>(view.rotations);
    result.feature_vertices = flat<hexhex_feature_vertex>(view.features.vertices);
    result.feature_vertex_count = view.features.vertices.size();
    result.feature_edges = flat<hexhex_feature_edge>(view.features.edges);
    result.feature_edge_count = view.features.edges.size();
    result.feature_faces = flat<hexhex_feature_face>(view.features.faces);
    result.feature_face_count = view.features.faces.size();
    result.regions = flat<std::int32_t>(view.regions);
    const std::span names = used->names.of(view.features.names);
    result.tag_names = flat<hexhex_tag_name>(names);
    result.tag_name_count = names.size();
    writeStruct(result, require(arrays, "arrays"), "arrays");
  });
}

void hexhex_map_destroy(hexhex_map* map) { hexhex::c::destroy(map); }
