// Arcs and patches.
#include <utility>

#include <hexhex/curved.hpp>

#include "options.hpp"

namespace {

hexhex::PiecewiseLinearParts partsOf(int patches) {
  return patches != 0 ? hexhex::PiecewiseLinearParts::ArcsAndPatches
                      : hexhex::PiecewiseLinearParts::Arcs;
}

/// Calls write(map) with the map that a mesh was made of: the caller's, unless it had to be
/// repaired.
template <class Write>
void withExtractedMap(const hexhex_piecewise_mesh& mesh, const hexhex_map* map,
                      const Write& write) {
  const hexhex::c::Used given(map, "map");
  const auto& repaired = mesh.straight->repaired.map;
  write(repaired ? hexhex::TetMapView(*repaired) : given->view);
}

}  // namespace

void hexhex_piecewise_mesh::take(hexhex::PiecewiseLinearMesh&& made) {
  piecewise = std::make_shared<const hexhex::PiecewiseLinearMesh>(std::move(made));
  auto lent = std::make_unique<hexhex_mesh>();
  lent->lent = {piecewise, &piecewise->mesh};
  straight = hexhex::c::enter(std::move(lent));
}

hexhex_status hexhex_extract_piecewise(const hexhex_map* map, int patches,
                                       const hexhex_extract_options* options,
                                       hexhex_context* context, hexhex_piecewise_mesh** mesh,
                                       hexhex_statistics* statistics, hexhex_error* error) {
  using namespace hexhex::c;
  return runExtract(options, context, mesh, statistics, error,
                    [&](hexhex_piecewise_mesh& made, const hexhex::ExtractOptions& given,
                        hexhex::Context& used, hexhex::ExtractStatistics& filled) {
                      made.take(hexhex::extractPiecewiseLinear(
                          Used(map, "map")->view, partsOf(patches), given, used, &filled));
                    });
}

hexhex_status hexhex_extractor_extract_piecewise(hexhex_extractor* extractor, int patches,
                                                 const hexhex_extract_options* options,
                                                 hexhex_context* context,
                                                 hexhex_piecewise_mesh** mesh,
                                                 hexhex_statistics* statistics,
                                                 hexhex_error* error) {
  using namespace hexhex::c;
  return runExtract(
      options, context, mesh, statistics, error,
      [&](hexhex_piecewise_mesh& made, const hexhex::ExtractOptions& given, hexhex::Context& used,
          hexhex::ExtractStatistics& filled) {
        made.take(Used(extractor, "extractor")
                      ->extractor.extractPiecewiseLinear(partsOf(patches), given, used, &filled));
      });
}

void hexhex_piecewise_mesh_destroy(hexhex_piecewise_mesh* mesh) { hexhex::c::destroy(mesh); }

const hexhex_mesh* hexhex_piecewise_mesh_straight(const hexhex_piecewise_mesh* mesh) {
  const hexhex::c::Used used(mesh, std::nothrow, hexhex::c::Use::Look);
  return used ? used->straight : nullptr;
}

hexhex_status hexhex_piecewise_mesh_get_arcs(const hexhex_piecewise_mesh* mesh,
                                             hexhex_arc_arrays* arrays, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const Used used(mesh, "mesh");
    const hexhex::Arcs& arcs = used->piecewise->arcs;
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
    const Used used(mesh, "mesh");
    const hexhex::Patches& p = used->piecewise->patches;
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
    hexhex::writeArcs(*Used(mesh, "mesh")->piecewise, &require(file, "file"), *used);
  });
}

hexhex_status hexhex_piecewise_mesh_write_patches(const hexhex_piecewise_mesh* mesh,
                                                  const char* file, hexhex_context* context,
                                                  hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    ContextOrDefault used(context);
    hexhex::writePatches(*Used(mesh, "mesh")->piecewise, &require(file, "file"), *used);
  });
}

hexhex_status hexhex_piecewise_mesh_write_arcs_with_map(const hexhex_piecewise_mesh* mesh,
                                                        const hexhex_map* map, const char* file,
                                                        hexhex_context* context,
                                                        hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const Used given(mesh, "mesh");
    ContextOrDefault used(context);
    withExtractedMap(*given, map, [&](const hexhex::TetMapView& extracted) {
      hexhex::writeArcs(*given->piecewise, extracted, &require(file, "file"), *used);
    });
  });
}

hexhex_status hexhex_piecewise_mesh_write_patches_with_map(const hexhex_piecewise_mesh* mesh,
                                                           const hexhex_map* map, const char* file,
                                                           hexhex_context* context,
                                                           hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const Used given(mesh, "mesh");
    ContextOrDefault used(context);
    withExtractedMap(*given, map, [&](const hexhex::TetMapView& extracted) {
      hexhex::writePatches(*given->piecewise, extracted, &require(file, "file"), *used);
    });
  });
}
