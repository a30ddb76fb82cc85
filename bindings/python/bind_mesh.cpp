// Hexahedral meshes, and what they are: quality, structure, patches, sums.
#include <algorithm>

#include <nanobind/stl/array.h>
#include <nanobind/stl/string.h>

#include <hexhex/base_complex.hpp>
#include <hexhex/curved.hpp>
#include <hexhex/error.hpp>
#include <hexhex/patches.hpp>
#include <hexhex/quality.hpp>
#include <hexhex/structure.hpp>
#include <hexhex/survey.hpp>

#include "mesh_arrays.hpp"

using namespace nanobind::literals;

namespace hexhex::python {
namespace {

Dict asDict(const MeshSurvey& s) {
  Dict d;
  d["points"] = s.points;
  d["cells"] = s.cells;
  d["lower"] = nb::make_tuple(s.lower[0], s.lower[1], s.lower[2]);
  d["upper"] = nb::make_tuple(s.upper[0], s.upper[1], s.upper[2]);
  d["point_checksum"] = s.pointChecksum;
  d["cell_checksum"] = s.cellChecksum;
  return d;
}

/// A sink that adds up, with the context that it wants.
class PySurvey {
 public:
  void begin(std::uint64_t points, std::uint64_t cells) { sink_.begin(points, cells); }
  void points(std::uint64_t first, const InPoints& points) {
    sink_.points({first, elements<Vec3>(points), {}, {}});
  }
  void cells(std::uint64_t first, const InCells& cells) {
    sink_.cells(first, elements<Hex>(cells));
  }
  void cells64(std::uint64_t first, const In<std::uint64_t, 8>& cells) {
    sink_.cells(first, elements<Hex64>(cells));
  }
  void end() { sink_.end(); }
  [[nodiscard]] const MeshSurvey& result() const { return sink_.result(); }

 private:
  Context context_;
  SurveySink sink_{context_};
};

/// Vertices, valence, on the boundary, and the counts.
nb::tuple meshStructureOf(const HexMesh& mesh, int threads, const Progress& progress) {
  const MeshStructure s =
      run(threads, progress, [&](Context& context) { return findStructure(mesh, context); });
  const std::size_t n = s.singularEdges.size();
  std::vector<Quad> rows(n);  // two vertices, valence, boundary
  for (std::size_t e = 0; e < n; ++e) {
    const SingularHexEdge& edge = s.singularEdges[e];
    rows[e] = {edge.vertex0, edge.vertex1, edge.valence, edge.boundary ? 1U : 0U};
  }
  Dict d;
  d["faces"] = s.faces;
  d["edges"] = s.edges;
  d["boundary_quads"] = s.boundaryQuads;
  d["components"] = s.components;
  d["boundary_components"] = s.boundaryComponents;
  d["euler_characteristic"] = s.eulerCharacteristic;
  return nb::make_tuple(ownedArray<Index, 2>(std::move(rows), {n, 4}), d);
}

/// (name, tag, quads, area, centre, normal) of each.
nb::list namedPatchesOf(const HexMesh& mesh, double angle, int threads) {
  nb::list list;
  for (NamedPatch& patch :
       run(threads, {}, [&](Context& context) { return namedPatches(mesh, angle, context); })) {
    const std::size_t n = patch.quads.size();
    list.append(nb::make_tuple(patch.name, patch.tag,
                               ownedArray<Index, 2>(std::move(patch.quads), {n, 4}), patch.area,
                               patch.centre, patch.normal));
  }
  return list;
}

nb::tuple baseComplexOf(const HexMesh& mesh, int threads, const Progress& progress) {
  BaseComplex found =
      run(threads, progress, [&](Context& context) { return findBaseComplex(mesh, context); });
  const std::size_t n = mesh.cells.size();
  std::vector<std::array<std::uint64_t, 4>> blocks;
  for (const MeshBlock& block : found.blocks) {
    blocks.push_back({block.size[0], block.size[1], block.size[2], block.cells});
  }
  nb::list curves;
  for (SingularCurve& curve : found.curves) {
    const std::size_t length = curve.vertices.size();
    curves.append(nb::make_tuple(ownedArray<Index, 1>(std::move(curve.vertices), {length}),
                                 curve.valence, curve.boundary));
  }
  nb::list irregular;
  for (IrregularVertices& type : found.irregular) {
    const std::size_t count = type.vertices.size();
    irregular.append(nb::make_tuple(type.boundary, type.innerValences, type.boundaryValences,
                                    ownedArray<Index, 1>(std::move(type.vertices), {count})));
  }
  const std::size_t count = blocks.size();
  return nb::make_tuple(ownedArray<Index, 2>(std::move(found.cellSheets), {n, 3}), found.sheets,
                        ownedArray<Index, 2>(std::move(found.cellChords), {n, 3}), found.chords,
                        ownedArray<Index, 1>(std::move(found.cellBlocks), {n}),
                        ownedArray<std::uint64_t, 2>(std::move(blocks), {count, 4}), curves,
                        irregular);
}

}  // namespace

nb::tuple asTuple(Certificate&& certificate) {
  const QualitySummary& s = certificate.quality;
  nb::list histogram;
  for (const std::uint64_t count : s.histogram) histogram.append(count);
  const auto point = [](const Vec3& p) { return nb::make_tuple(p[0], p[1], p[2]); };
  nb::list worst;
  for (const RefutedCell& bad : certificate.worst) {
    worst.append(
        nb::make_tuple(bad.cell, point(bad.place), point(bad.position), bad.scaledJacobian));
  }
  const std::size_t n = certificate.validity.size();
  return nb::make_tuple(
      ownedArray<double, 1>(std::move(certificate.scaledJacobians), {n}), s.minimum, s.mean,
      s.notPositive, histogram, ownedArray<std::uint8_t, 1>(std::move(certificate.validity), {n}),
      certificate.positive, certificate.refuted, certificate.undecided, certificate.minimum, worst);
}

void bindMesh(nb::module_& module) {
  nb::class_<HexMesh> binding(module, "Mesh", "A mesh in the library's own arrays.");
  binding
      .def(
          "__init__",
          [](HexMesh* self, const InPoints& points, const InCells& cells,
             const In1<Index>& generatorTet, const In1<CornerSet>& generatorCorners,
             const In<std::int32_t, 2>& vertices, const In<std::int32_t, 3>& edges,
             const In<std::int32_t, 5>& quads, const In1<std::int32_t>& regions,
             const std::vector<NameRow>& names) {
            HexMesh mesh;
            assign(mesh.cells, elements<Hex>(cells));
            GivenArrays{points, generatorTet, generatorCorners, vertices,
                        edges,  quads,        regions,          names}
                .copyTo(mesh);
            new (self) HexMesh(std::move(mesh));
          },
          "points"_a.noconvert(), "cells"_a.noconvert(), "generator_tet"_a.noconvert(),
          "generator_corners"_a.noconvert(), "feature_vertices"_a.noconvert(),
          "feature_edges"_a.noconvert(), "feature_quads"_a.noconvert(), "regions"_a.noconvert(),
          "tag_names"_a)
      .def_prop_ro("cells", [](nb::handle self) {
        auto& cells = unwrapped<HexMesh>(self).cells;
        return viewOn<Index, 2>(cells, self, {cells.size(), 8});
      });
  defineArrays(binding);

  module.def(
      "certify",
      [](const HexMesh& mesh, int threads, const Progress& progress) {
        return asTuple(
            run(threads, progress, [&](Context& context) { return certify(mesh, context); }));
      },
      "mesh"_a, "threads"_a, "progress"_a.none());
  module.def("structure", &meshStructureOf, "mesh"_a, "threads"_a, "progress"_a.none());
  module.def("named_patches", &namedPatchesOf, "mesh"_a, "angle"_a, "threads"_a);
  module.def("base_complex", &baseComplexOf, "mesh"_a, "threads"_a, "progress"_a.none());
  module.def(
      "survey",
      [](const HexMesh& mesh, int threads, const Progress& progress) {
        return asDict(
            run(threads, progress, [&](Context& context) { return survey(mesh, context); }));
      },
      "mesh"_a, "threads"_a, "progress"_a.none());
  module.def(
      "survey_file",
      [](const std::string& file, const std::string& format, int threads,
         const Progress& progress) {
        return asDict(run(threads, progress, [&](Context& context) {
          return surveyFile(file, {.format = format}, context);
        }));
      },
      "file"_a, "format"_a, "threads"_a, "progress"_a.none());
  module.def(
      "scaled_jacobian",
      [](const In<double, 3>& corners) {
        std::array<Vec3, 8> points{};
        const auto given = elements<Vec3>(corners);
        if (given.size() != points.size()) {
          throw Error(ErrorCode::InvalidArgument, "A hexahedron has eight corners.");
        }
        std::copy(given.begin(), given.end(), points.begin());
        return scaledJacobian(points);
      },
      "corners"_a.noconvert());

  const nb::call_guard<nb::gil_scoped_release> released;
  nb::class_<PySurvey>(module, "SurveySink")
      .def(nb::init<>())
      .def("begin", &PySurvey::begin, "points"_a, "cells"_a, released)
      .def("points", &PySurvey::points, "first"_a, "points"_a.noconvert(), released)
      .def("cells", &PySurvey::cells, "first"_a, "cells"_a.noconvert(), released)
      .def("cells64", &PySurvey::cells64, "first"_a, "cells"_a.noconvert(), released)
      .def("end", &PySurvey::end, released)
      .def("result", [](const PySurvey& self) { return asDict(self.result()); });
}

}  // namespace hexhex::python
