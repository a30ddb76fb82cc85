#include <optional>

#include <hexhex/error.hpp>
#include <hexhex/improve.hpp>

#include "options.hpp"

namespace hexhex::c {

void writeReport(const ImproveReport& r, hexhex_improve_report* out) {
  if (out == nullptr) return;
  const hexhex_improve_report result = {
      .size = sizeof(hexhex_improve_report),
      .not_positive_before = r.before.refuted + r.before.undecided,
      .not_positive_after = r.notPositive.size(),
      .minimum_before = r.before.quality.minimum,
      .minimum_after = r.after.quality.minimum,
      .mean_before = r.before.quality.mean,
      .mean_after = r.after.quality.mean,
      .diagonal = r.diagonal,
      .from_mesh_before = r.distanceBefore.fromMesh,
      .from_surface_before = r.distanceBefore.fromSurface,
      .from_mesh_after = r.distanceAfter.fromMesh,
      .from_surface_after = r.distanceAfter.fromSurface,
      .far_cells_before = r.farCellsBefore,
      .far_cells_after = r.farCells.size(),
      .free_vertices = r.vertices[0],
      .patch_vertices = r.vertices[1],
      .curve_vertices = r.vertices[2],
      .fixed_vertices = r.vertices[3],
      .moved_vertices = r.movedVertices,
      .largest_move = r.largestMove,
      .mean_move = r.meanMove,
      .off_surface = r.offSurface,
      .seconds = r.seconds,
      .inner_distance_before = r.innerDistanceBefore,
      .inner_distance_after = r.innerDistanceAfter,
      .tagged_vertices = r.taggedVertices,
      .boundary_vertices = r.boundaryVertices,
      .off_creases = r.offCreases,
      .added_cells = r.addedCells,
      .curve_length = r.curveLength,
      .curves_followed = r.curvesFollowed,
      .snapped_curves = r.snappedCurves,
      .cannot_be_positive = r.cannotBePositive.size(),
      .paired_vertices = r.pairedVertices,
      .worst_cell = r.worst.cell,
      .worst_held_by = static_cast<hexhex_cell_holder>(r.worst.holder),
      .worst_tagged = r.worst.isTagged ? 1 : 0,
      .worst_vertex = r.worst.vertex,
      .worst_angle = r.worst.angle};
  writeStruct(result, *out, "report");
}

ImproveOptions improveOptions(const hexhex_improve_options* options, const char** surface) {
  const hexhex_improve_options o = readStruct(options, HEXHEX_IMPROVE_OPTIONS_INIT, "options");
  if (o.pillow < HEXHEX_PILLOW_NEVER || o.pillow > HEXHEX_PILLOW_ALWAYS) {
    throw Error(ErrorCode::InvalidArgument, "There is no such mode of pillows.");
  }
  if (o.surface != nullptr && surface == nullptr) {
    throw Error(ErrorCode::InvalidArgument,
                "Options of improvement name a surface, but that of a map or of tets is the one to "
                "keep. Leave out one of the two.");
  }
  if (surface != nullptr) *surface = o.surface;
  return {.target = o.target,
          .passes = o.passes,
          .fixBoundary = o.fix_boundary != 0,
          .featureAngle = o.feature_angle,
          .slack = o.slack,
          .pillow = static_cast<PillowMode>(o.pillow),
          .snapCurves = o.snap_curves != 0};
}

}  // namespace hexhex::c

namespace {

/// @param meshOf  the mesh of a handle
template <class Handle, class MeshOf>
hexhex_status improveMesh(Handle* mesh, const hexhex_map* map,
                          const hexhex_improve_options* options, hexhex_context* context,
                          hexhex_improve_report* report, hexhex_error* error,
                          const MeshOf& meshOf) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const Used used(mesh, "mesh");
    std::optional<Used<const hexhex_map>> given;
    if (map != nullptr) given.emplace(map, "map");
    const char* surface = nullptr;
    const hexhex::ImproveOptions chosen = improveOptions(options, given ? nullptr : &surface);
    requireStruct(report, "report");
    ContextOrDefault working(context);
    auto& improved = meshOf(*used);
    const auto improve = [&] {
      if (given) return hexhex::improve(improved, (*given)->view, chosen, *working);
      if (surface == nullptr) return hexhex::improve(improved, chosen, *working);
      const hexhex::TriangleMesh onto = hexhex::readSurfaceOf(surface, *working);
      return hexhex::improve(improved, onto, chosen, *working);
    };
    writeReport(improve(), report);
  });
}

}  // namespace

hexhex_status hexhex_mesh_improve(hexhex_mesh* mesh, const hexhex_map* map,
                                  const hexhex_improve_options* options, hexhex_context* context,
                                  hexhex_improve_report* report, hexhex_error* error) {
  return improveMesh(mesh, map, options, context, report, error,
                     [](hexhex_mesh& handle) -> hexhex::HexMesh& { return handle.own; });
}

hexhex_status hexhex_lagrange_mesh_improve(hexhex_lagrange_mesh* mesh, const hexhex_map* map,
                                           const hexhex_improve_options* options,
                                           hexhex_context* context, hexhex_improve_report* report,
                                           hexhex_error* error) {
  return improveMesh(
      mesh, map, options, context, report, error,
      [](hexhex_lagrange_mesh& handle) -> hexhex::LagrangeMesh& { return handle.mesh; });
}
