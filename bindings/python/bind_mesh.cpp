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
#include <hexhex/summary.hpp>

#include "mesh_arrays.hpp"
#include "piece_taker.hpp"

using namespace nanobind::literals;

namespace hexhex::python {
namespace {

Dict asDict(const MeshSummary& s) {
  Dict d;
  d["points"] = s.points;
  d["cells"] = s.cells;
  d["lower"] = nb::make_tuple(s.lower[0], s.lower[1], s.lower[2]);
  d["upper"] = nb::make_tuple(s.upper[0], s.upper[1], s.upper[2]);
  d["point_checksum"] = s.pointChecksum;
  d["cell_checksum"] = s.cellChecksum;
  return d;
}

/// A sink that adds up.
class PySummary : public PieceTaker {
 public:
  PySummary() { sink_ = std::make_unique<SummarySink>(context_); }
  [[nodiscard]] const MeshSummary& result() const {
    return static_cast<const SummarySink&>(*sink_).result();
  }
};

/// Vertices, valence, on the boundary, and the counts.
nb::tuple meshStructureOf(const HexMesh& mesh, int threads, const Progress& progress) {
  const MeshStructure s =
      run(threads, progress, [&](Context& context) { return findStructure(mesh, context); });
  std::vector<std::array<Index, 4>> rows;  // two vertices, valence, boundary
  for (const SingularHexEdge& edge : s.singularEdges) {
    rows.push_back({edge.vertex0, edge.vertex1, edge.valence, edge.boundary ? 1U : 0U});
  }
  Dict d;
  d["faces"] = s.faces;
  d["edges"] = s.edges;
  d["boundary_quads"] = s.boundaryQuads;
  d["components"] = s.components;
  d["boundary_components"] = s.boundaryComponents;
  d["euler_characteristic"] = s.eulerCharacteristic;
  return nb::make_tuple(ownedArray(std::move(rows)), d);
}

/// (name, tag, quads, area, centre, normal) of each.
nb::list namedPatchesOf(const HexMesh& mesh, double angle, int threads) {
  nb::list list;
  for (NamedPatch& patch :
       run(threads, {}, [&](Context& context) { return namedPatches(mesh, angle, context); })) {
    list.append(nb::make_tuple(patch.name, patch.tag, ownedArray(std::move(patch.quads)),
                               patch.area, patch.centre, patch.normal));
  }
  return list;
}

nb::tuple baseComplexOf(const HexMesh& mesh, int threads, const Progress& progress) {
  BaseComplex found =
      run(threads, progress, [&](Context& context) { return findBaseComplex(mesh, context); });
  std::vector<std::array<std::uint64_t, 4>> blocks;
  for (const MeshBlock& block : found.blocks) {
    blocks.push_back({block.size[0], block.size[1], block.size[2], block.cells});
  }
  nb::list curves;
  for (SingularCurve& curve : found.curves) {
    curves.append(
        nb::make_tuple(ownedArray(std::move(curve.vertices)), curve.valence, curve.boundary));
  }
  nb::list irregular;
  for (IrregularVertices& type : found.irregular) {
    irregular.append(nb::make_tuple(type.boundary, type.innerValences, type.boundaryValences,
                                    ownedArray(std::move(type.vertices))));
  }
  return nb::make_tuple(ownedArray(std::move(found.cellSheets)), found.sheets,
                        ownedArray(std::move(found.cellChords)), found.chords,
                        ownedArray(std::move(found.cellBlocks)), ownedArray(std::move(blocks)),
                        curves, irregular);
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
  return nb::make_tuple(ownedArray(std::move(certificate.scaledJacobians)), s.minimum, s.mean,
                        s.notPositive, histogram, ownedArray(std::move(certificate.validity)),
                        certificate.positive, certificate.refuted, certificate.undecided,
                        certificate.minimum, worst);
}

void bindMesh(nb::module_& module) {
  nb::class_<HexMesh> binding(module, "Mesh", "A mesh in the library's own arrays.");
  binding.def(
      "__init__",
      [](HexMesh* self, const InPoints& points, const InCells& cells,
         const In1<Index>& generatorTet, const In1<CornerSet>& generatorCorners,
         const In<std::int32_t, 2>& vertices, const In<std::int32_t, 3>& edges,
         const In<std::int32_t, 5>& quads, const In1<std::int32_t>& regions,
         const std::vector<NameRow>& names) {
        HexMesh mesh;
        assign(mesh.cells, elements<Hex>(cells));
        GivenArrays{points, generatorTet, generatorCorners, vertices, edges, quads, regions, names}
            .copyTo(mesh);
        new (self) HexMesh(std::move(mesh));
      },
      "points"_a.noconvert(), "cells"_a.noconvert(), "generator_tet"_a.noconvert(),
      "generator_corners"_a.noconvert(), "feature_vertices"_a.noconvert(),
      "feature_edges"_a.noconvert(), "feature_quads"_a.noconvert(), "regions"_a.noconvert(),
      "tag_names"_a);
  defineView(binding, "cells", &HexMesh::cells);
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
      "summarize",
      [](const HexMesh& mesh, int threads, const Progress& progress) {
        return asDict(
            run(threads, progress, [&](Context& context) { return summarize(mesh, context); }));
      },
      "mesh"_a, "threads"_a, "progress"_a.none());
  module.def(
      "summarize_file",
      [](const std::string& file, const std::string& format, int threads,
         const Progress& progress) {
        return asDict(run(threads, progress, [&](Context& context) {
          return summarizeFile(file, {.format = format}, context);
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

  definePieces(nb::class_<PySummary>(module, "SummarySink")
                   .def(nb::init<>())
                   .def("result", [](const PySummary& self) { return asDict(self.result()); }));
}

}  // namespace hexhex::python
