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
  return advising(map, threads, [&] {
    return runNoted(threads, progress, [&](Context& context, Notes& notes) {
      return extractPiecewiseLinear(map.view(), parts, options.get(notes.repaired), context,
                                    &notes.statistics);
    });
  });
}

nb::tuple extractOrder(const ArrayMap& map, int order, const Options& options, int threads,
                       const Progress& progress) {
  return advising(map, threads, [&] {
    return runNoted(threads, progress, [&](Context& context, Notes& notes) {
      return extractLagrange(map.view(), order, options.get(notes.repaired), context,
                             &notes.statistics);
    });
  });
}

/// Calls visit(name, list) for all lists.
template <class Visit>
void visitLists(Arcs& arcs, const Visit& visit) {
  visit("ends", arcs.ends);
  visit("point_begin", arcs.pointBegin);
  visit("points", arcs.points);
  visit("parameters", arcs.parameters);
  visit("generator_tet", arcs.generatorTet);
  visit("generator_corners", arcs.generatorCorners);
  visit("segment_tet", arcs.segmentTet);
  visit("segment_corners", arcs.segmentCorners);
}

template <class Visit>
void visitLists(Patches& patches, const Visit& visit) {
  visit("vertices", patches.vertices);
  visit("arcs", patches.arcs);
  visit("reversed_arcs", patches.reversedArcs);
  visit("polygon_begin", patches.polygonBegin);
  visit("corner_begin", patches.cornerBegin);
  visit("polygon_tet", patches.polygonTet);
  visit("polygon_corners", patches.polygonCorners);
  visit("corners", patches.corners);
  visit("parameters", patches.parameters);
  visit("points", patches.points);
  visit("generator_tet", patches.generatorTet);
  visit("generator_corners", patches.generatorCorners);
}

/// Views on lists by name, which keep their mesh alive.
Dict viewsOf(auto& lists, nb::handle mesh) {
  Dict d;
  visitLists(lists, [&](const char* name, auto& list) { d[name] = viewOn(list, mesh); });
  return d;
}

/// The inverse: what was pickled.
void takeLists(auto& lists, const nb::dict& arrays) {
  visitLists(lists, [&](const char* name, auto& list) {
    using Element = typename std::decay_t<decltype(list)>::value_type;
    using Given = nb::ndarray<const typename Row<Element>::Scalar, nb::c_contig, nb::device::cpu>;
    const auto given = nb::cast<Given>(arrays[name]);
    constexpr auto& kRow = Row<Element>::kShape;
    bool fits = given.ndim() == 1 + kRow.size();
    for (std::size_t i = 0; fits && i < kRow.size(); ++i) fits = given.shape(i + 1) == kRow[i];
    if (!fits) {
      throw Error(ErrorCode::InvalidArgument,
                  std::string("The array ") + name + " has a wrong shape.");
    }
    assign(list, elements<Element>(given));
  });
}

}  // namespace

void bindCurved(nb::module_& module) {
  nb::class_<PiecewiseLinearMesh>(module, "PiecewiseMesh")
      .def(
          "__init__",
          [](PiecewiseLinearMesh* self, const HexMesh& mesh, const nb::dict& arcs,
             const nb::dict& patches) {
            PiecewiseLinearMesh taken{mesh, {}, {}};
            takeLists(taken.arcs, arcs);
            takeLists(taken.patches, patches);
            new (self) PiecewiseLinearMesh(std::move(taken));
          },
          "mesh"_a, "arcs"_a, "patches"_a)
      .def_prop_ro(
          "mesh", [](PiecewiseLinearMesh& self) -> HexMesh& { return self.mesh; },
          nb::rv_policy::reference_internal)
      .def_prop_ro(
          "arcs",
          [](nb::handle self) { return viewsOf(unwrapped<PiecewiseLinearMesh>(self).arcs, self); })
      .def_prop_ro("patches", [](nb::handle self) {
        return viewsOf(unwrapped<PiecewiseLinearMesh>(self).patches, self);
      });

  nb::class_<LagrangeMesh> binding(module, "LagrangeMesh");
  binding
      .def(
          "__init__",
          [](LagrangeMesh* self, int order, const InPoints& points, const In<Index, -1>& nodes,
             std::uint64_t vertexCount, const In1<Index>& generatorTet,
             const In1<CornerSet>& generatorCorners, const In<std::int32_t, 2>& vertices,
             const In<std::int32_t, 3>& edges, const In<std::int32_t, 5>& quads,
             const In1<std::int32_t>& regions, const std::vector<NameRow>& names,
             const In1<Index>& straightenedCells) {
            LagrangeMesh mesh;
            mesh.order = order;
            mesh.vertexCount = vertexCount;
            assign(mesh.nodes, std::span<const Index>(nodes.data(), nodes.size()));
            GivenArrays{points, generatorTet, generatorCorners, vertices,
                        edges,  quads,        regions,          names}
                .copyTo(mesh);
            assign(mesh.straightenedCells, elements<Index>(straightenedCells));
            new (self) LagrangeMesh(std::move(mesh));
          },
          "order"_a, "points"_a.noconvert(), "nodes"_a.noconvert(), "vertex_count"_a,
          "generator_tet"_a.noconvert(), "generator_corners"_a.noconvert(),
          "feature_vertices"_a.noconvert(), "feature_edges"_a.noconvert(),
          "feature_quads"_a.noconvert(), "regions"_a.noconvert(), "tag_names"_a,
          "straightened_cells"_a.noconvert())
      .def_prop_ro("order", [](const LagrangeMesh& self) { return self.order; })
      .def_prop_ro("vertex_count", [](const LagrangeMesh& self) { return self.vertexCount; })
      .def_prop_ro(
          "nodes",
          [](nb::handle self) {
            auto& mesh = unwrapped<LagrangeMesh>(self);
            return viewOn<Index, 2>(mesh.nodes, self, {mesh.cellCount(), mesh.nodesPerCell()});
          })
      .def("straight", [](const LagrangeMesh& self) { return straightMesh(self); });
  defineView(binding, "straightened_cells", &LagrangeMesh::straightenedCells);
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
