// Curved meshes: arcs and patches, and cells of higher order.
#include <nanobind/stl/string.h>

#include <hexhex/curved.hpp>

#include "mesh_arrays.hpp"

using namespace nanobind::literals;

namespace hexhex::python {
namespace {

nb::tuple extractPieces(const ArrayMap& map, bool patches, const Options& options, int threads,
                        const Progress& progress) {
  const auto parts = patches ? PiecewiseLinearParts::ArcsAndPatches : PiecewiseLinearParts::Arcs;
  return runNoted(threads, progress, [&](Context& context, ExtractStatistics& statistics) {
    return extractPiecewiseLinear(map.view(), parts, options.get(), context, &statistics);
  });
}

nb::tuple extractOrder(const ArrayMap& map, int order, const Options& options, int threads,
                       const Progress& progress) {
  return runNoted(threads, progress, [&](Context& context, ExtractStatistics& statistics) {
    return extractLagrange(map.view(), order, options.get(), context, &statistics);
  });
}

/// Views by name, which keep the mesh alive.
Dict arcsOf(nb::handle self) {
  Arcs& a = unwrapped<PiecewiseLinearMesh>(self).arcs;
  Dict d;
  d["ends"] = viewOn<Index, 2>(a.ends, self, {a.ends.size(), 2});
  d["point_begin"] = viewOn<std::uint64_t, 1>(a.pointBegin, self, {a.pointBegin.size()});
  d["points"] = viewOn<double, 2>(a.points, self, {a.points.size(), 3});
  d["parameters"] = viewOn<double, 1>(a.parameters, self, {a.parameters.size()});
  d["generator_tet"] = viewOn<Index, 1>(a.generatorTet, self, {a.generatorTet.size()});
  d["generator_corners"] =
      viewOn<CornerSet, 1>(a.generatorCorners, self, {a.generatorCorners.size()});
  d["segment_tet"] = viewOn<Index, 1>(a.segmentTet, self, {a.segmentTet.size()});
  d["segment_corners"] = viewOn<CornerSet, 1>(a.segmentCorners, self, {a.segmentCorners.size()});
  return d;
}

Dict patchesOf(nb::handle self) {
  Patches& p = unwrapped<PiecewiseLinearMesh>(self).patches;
  Dict d;
  d["vertices"] = viewOn<Index, 2>(p.vertices, self, {p.vertices.size(), 4});
  d["arcs"] = viewOn<Index, 2>(p.arcs, self, {p.arcs.size(), 4});
  d["reversed_arcs"] = viewOn<std::uint8_t, 1>(p.reversedArcs, self, {p.reversedArcs.size()});
  d["polygon_begin"] = viewOn<std::uint64_t, 1>(p.polygonBegin, self, {p.polygonBegin.size()});
  d["corner_begin"] = viewOn<std::uint64_t, 1>(p.cornerBegin, self, {p.cornerBegin.size()});
  d["polygon_tet"] = viewOn<Index, 1>(p.polygonTet, self, {p.polygonTet.size()});
  d["polygon_corners"] = viewOn<CornerSet, 1>(p.polygonCorners, self, {p.polygonCorners.size()});
  d["corners"] = viewOn<Index, 1>(p.corners, self, {p.corners.size()});
  d["parameters"] = viewOn<double, 2>(p.parameters, self, {p.parameters.size(), 2});
  d["points"] = viewOn<double, 2>(p.points, self, {p.points.size(), 3});
  d["generator_tet"] = viewOn<Index, 1>(p.generatorTet, self, {p.generatorTet.size()});
  d["generator_corners"] =
      viewOn<CornerSet, 1>(p.generatorCorners, self, {p.generatorCorners.size()});
  return d;
}

/// An array of a dict as rows of a list of the library.
template <class Array, class List>
void take(List& list, const nb::dict& arrays, const char* name) {
  using Element = typename List::value_type;
  const Array array = nb::cast<Array>(arrays[name]);
  assign(list, elements<Element>(array));
}

/// The inverse of arcsOf() and patchesOf(): what was pickled.
PiecewiseLinearMesh piecewiseOf(const HexMesh& mesh, const nb::dict& arcs,
                                const nb::dict& patches) {
  PiecewiseLinearMesh all;
  all.mesh = mesh;
  Arcs& a = all.arcs;
  take<In<Index, 2>>(a.ends, arcs, "ends");
  take<In1<std::uint64_t>>(a.pointBegin, arcs, "point_begin");
  take<InPoints>(a.points, arcs, "points");
  take<In1<double>>(a.parameters, arcs, "parameters");
  take<In1<Index>>(a.generatorTet, arcs, "generator_tet");
  take<In1<CornerSet>>(a.generatorCorners, arcs, "generator_corners");
  take<In1<Index>>(a.segmentTet, arcs, "segment_tet");
  take<In1<CornerSet>>(a.segmentCorners, arcs, "segment_corners");
  Patches& p = all.patches;
  take<In<Index, 4>>(p.vertices, patches, "vertices");
  take<In<Index, 4>>(p.arcs, patches, "arcs");
  take<In1<std::uint8_t>>(p.reversedArcs, patches, "reversed_arcs");
  take<In1<std::uint64_t>>(p.polygonBegin, patches, "polygon_begin");
  take<In1<std::uint64_t>>(p.cornerBegin, patches, "corner_begin");
  take<In1<Index>>(p.polygonTet, patches, "polygon_tet");
  take<In1<CornerSet>>(p.polygonCorners, patches, "polygon_corners");
  take<In1<Index>>(p.corners, patches, "corners");
  take<In<double, 2>>(p.parameters, patches, "parameters");
  take<InPoints>(p.points, patches, "points");
  take<In1<Index>>(p.generatorTet, patches, "generator_tet");
  take<In1<CornerSet>>(p.generatorCorners, patches, "generator_corners");
  return all;
}

}  // namespace

void bindCurved(nb::module_& module) {
  nb::class_<PiecewiseLinearMesh>(module, "PiecewiseMesh")
      .def(
          "__init__",
          [](PiecewiseLinearMesh* self, const HexMesh& mesh, const nb::dict& arcs,
             const nb::dict& patches) {
            new (self) PiecewiseLinearMesh(piecewiseOf(mesh, arcs, patches));
          },
          "mesh"_a, "arcs"_a, "patches"_a)
      .def_prop_ro(
          "mesh", [](PiecewiseLinearMesh& self) -> HexMesh& { return self.mesh; },
          nb::rv_policy::reference_internal)
      .def_prop_ro("arcs", &arcsOf)
      .def_prop_ro("patches", &patchesOf);

  nb::class_<LagrangeMesh> binding(module, "LagrangeMesh");
  binding
      .def(
          "__init__",
          [](LagrangeMesh* self, int order, const InPoints& points, const In<Index, -1>& nodes,
             std::uint64_t vertexCount, const In1<Index>& generatorTet,
             const In1<CornerSet>& generatorCorners, const In<std::int32_t, 2>& vertices,
             const In<std::int32_t, 3>& edges, const In<std::int32_t, 5>& quads,
             const In1<std::int32_t>& regions) {
            LagrangeMesh mesh;
            mesh.order = order;
            mesh.vertexCount = vertexCount;
            assign(mesh.nodes, std::span<const Index>(nodes.data(), nodes.size()));
            GivenArrays{points, generatorTet, generatorCorners, vertices, edges, quads, regions}
                .copyTo(mesh);
            new (self) LagrangeMesh(std::move(mesh));
          },
          "order"_a, "points"_a.noconvert(), "nodes"_a.noconvert(), "vertex_count"_a,
          "generator_tet"_a.noconvert(), "generator_corners"_a.noconvert(),
          "feature_vertices"_a.noconvert(), "feature_edges"_a.noconvert(),
          "feature_quads"_a.noconvert(), "regions"_a.noconvert())
      .def_prop_ro("order", [](const LagrangeMesh& self) { return self.order; })
      .def_prop_ro("vertex_count", [](const LagrangeMesh& self) { return self.vertexCount; })
      .def_prop_ro(
          "nodes",
          [](nb::handle self) {
            auto& mesh = unwrapped<LagrangeMesh>(self);
            return viewOn<Index, 2>(mesh.nodes, self, {mesh.cellCount(), mesh.nodesPerCell()});
          })
      .def("straight", [](const LagrangeMesh& self) { return straightMesh(self); });
  defineArrays(binding);

  module.def("extract_piecewise", &extractPieces, "map"_a, "patches"_a, "options"_a, "threads"_a,
             "progress"_a.none());
  module.def("extract_lagrange", &extractOrder, "map"_a, "order"_a, "options"_a, "threads"_a,
             "progress"_a.none());
  module.def(
      "certify",
      [](const LagrangeMesh& mesh, int threads, const Progress& progress) {
        return asTuple(
            run(threads, progress, [&](Context& context) { return certify(mesh, context); }));
      },
      "mesh"_a, "threads"_a, "progress"_a.none());
  module.def(
      "write_arcs",
      [](const PiecewiseLinearMesh& mesh, const ArrayMap* map, const std::string& file, int threads,
         const Progress& progress) {
        run(threads, progress, [&](Context& context) {
          map != nullptr ? writeArcs(mesh, map->view(), file, context)
                         : writeArcs(mesh, file, context);
        });
      },
      "mesh"_a, "map"_a.none(), "file"_a, "threads"_a, "progress"_a.none());
  module.def(
      "write_patches",
      [](const PiecewiseLinearMesh& mesh, const ArrayMap* map, const std::string& file, int threads,
         const Progress& progress) {
        run(threads, progress, [&](Context& context) {
          map != nullptr ? writePatches(mesh, map->view(), file, context)
                         : writePatches(mesh, file, context);
        });
      },
      "mesh"_a, "map"_a.none(), "file"_a, "threads"_a, "progress"_a.none());
  module.def(
      "write_lagrange",
      [](const LagrangeMesh& mesh, const std::string& file, const std::string& format,
         double patchAngle, const In1<double>& scaledJacobians, int threads,
         const Progress& progress) {
        WriteOptions writing;
        writing.format = format;
        writing.patchAngle = patchAngle;
        writing.scaledJacobians = elements<double>(scaledJacobians);
        run(threads, progress,
            [&](Context& context) { writeLagrangeMesh(mesh, file, writing, context); });
      },
      "mesh"_a, "file"_a, "format"_a, "patch_angle"_a, "scaled_jacobians"_a.noconvert(),
      "threads"_a, "progress"_a.none());
  module.def(
      "read_lagrange",
      [](const std::string& file, int threads, const Progress& progress) {
        return run(threads, progress,
                   [&](Context& context) { return readLagrangeMesh(file, context); });
      },
      "file"_a, "threads"_a, "progress"_a.none());
  module.def(
      "holds_lagrange",
      [](const std::string& file) {
        return run(0, {}, [&](Context& context) { return holdsLagrangeCells(file, context); });
      },
      "file"_a);
}

}  // namespace hexhex::python
