// Meshes whose cells are positive, and better.
#include <optional>
#include <string>
#include <utility>

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <hexhex/improve.hpp>

#include "border.hpp"

using namespace nanobind::literals;

namespace hexhex::python {

nb::tuple asTuple(ImproveReport&& report) {
  Dict d = fieldsOf(report);
  d["not_positive"] = ownedArray(std::move(report.notPositive));
  d["far_cells"] = ownedArray(std::move(report.farCells));
  d["from_mesh_before"] = report.distanceBefore.fromMesh;
  d["from_surface_before"] = report.distanceBefore.fromSurface;
  d["from_mesh_after"] = report.distanceAfter.fromMesh;
  d["from_surface_after"] = report.distanceAfter.fromSurface;
  d["free_vertices"] = report.vertices[0];
  d["patch_vertices"] = report.vertices[1];
  d["curve_vertices"] = report.vertices[2];
  d["fixed_vertices"] = report.vertices[3];
  d["tagged_vertices"] = report.taggedVertices;
  d["boundary_vertices"] = report.boundaryVertices;
  d["paired_vertices"] = report.pairedVertices;
  d["cannot_be_positive"] = ownedArray(std::move(report.cannotBePositive));
  d["worst_cell"] = report.worst.cell;
  d["worst_held_by"] = static_cast<int>(report.worst.holder);
  d["worst_tagged"] = report.worst.isTagged;
  d["worst_vertex"] = report.worst.vertex;
  d["worst_angle"] = report.worst.angle;
  return nb::make_tuple(asTuple(std::move(report.before)), asTuple(std::move(report.after)), d);
}

namespace {

/// A mesh that is moved, straight or curved, of a copy of one that others may hold.
template <class AnyMesh>
nb::tuple improveMesh(const AnyMesh& mesh, const ArrayMap* map,
                      const std::optional<std::string>& surface, const ImproveOptions& options,
                      int threads, const Progress& progress) {
  AnyMesh moved;
  ImproveReport report = run(threads, progress, [&](Context& context) {
    moved = mesh;
    if (surface) return improve(moved, readSurfaceOf(*surface, context), options, context);
    return map != nullptr ? improve(moved, map->view(), options, context)
                          : improve(moved, options, context);
  });
  return nb::make_tuple(std::move(moved), asTuple(std::move(report)));
}

}  // namespace

void bindImprove(nb::module_& module) {
  nb::enum_<PillowMode>(module, "PillowMode")
      .value("never", PillowMode::Never)
      .value("auto", PillowMode::Auto)
      .value("always", PillowMode::Always);
  nb::class_<ImproveOptions>(module, "ImproveOptions")
      .def(
          "__init__",
          [](ImproveOptions* self, double target, int passes, bool fixBoundary, double featureAngle,
             double slack, PillowMode pillow, bool snapCurves) {
            new (self) ImproveOptions{target, passes, fixBoundary, featureAngle,
                                      slack,  pillow, snapCurves};
          },
          "target"_a, "passes"_a, "fix_boundary"_a, "feature_angle"_a, "slack"_a, "pillow"_a,
          "snap_curves"_a);
  const auto define = [&module](auto function) {
    module.def("improve", function, "mesh"_a, "map"_a.none(), "surface"_a.none(), "options"_a,
               "threads"_a, "progress"_a.none());
  };
  define(&improveMesh<HexMesh>);
  define(&improveMesh<LagrangeMesh>);
}

}  // namespace hexhex::python
