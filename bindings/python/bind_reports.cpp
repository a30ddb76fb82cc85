// What a map is, and whether a mesh agrees with it.
#include <string>
#include <vector>

#include <nanobind/stl/map.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <hexhex/check.hpp>

#include "border.hpp"

using namespace nanobind::literals;

namespace hexhex::python {

Dict asDict(const Expectation& e) {
  Dict d;
  d["cells"] = e.cells;
  d["boundary_quads"] = e.boundaryQuads;
  d["inner_singular_edges"] = nb::cast(e.innerSingularEdges);
  d["boundary_singular_edges"] = nb::cast(e.boundarySingularEdges);
  d["euler_characteristic"] = e.eulerCharacteristic;
  d["components"] = e.components;
  d["boundary_components"] = e.boundaryComponents;
  return d;
}

nb::list asList(const std::vector<Defect>& defects) {
  nb::list list;
  for (const Defect& defect : defects) {
    nb::list worst;
    for (const Defect::Occurrence& occurrence : defect.worst) {
      worst.append(nb::make_tuple(toString(occurrence.place), occurrence.place.index,
                                  occurrence.place.second, occurrence.amount));
    }
    list.append(
        nb::make_tuple(std::string(name(defect.code)), defect.sentence, defect.count, worst));
  }
  return list;
}

nb::list asList(const VerifyReport& report) {
  nb::list rows;
  for (const VerifyItem& item : report.items) {
    rows.append(nb::make_tuple(item.name, item.expected, item.found, item.passed));
  }
  return rows;
}

namespace {

Dict asDict(const CheckReport& r) {
  Dict d;
  d["points"] = r.points;
  d["tets"] = r.tets;
  d["edges"] = r.edges;
  d["faces"] = r.faces;
  d["boundary_faces"] = r.boundaryFaces;
  d["inner_faces"] = r.innerFaces;
  d["chart_jumps"] = r.chartJumps;
  d["isolated_vertices"] = r.isolatedVertices;
  d["tets_inverted_in_space"] = r.tetsInvertedInSpace;
  d["mirrored"] = r.mirrored;
  d["corners_reversed"] = r.cornersReversed;
  d["max_transition_residual"] = r.maxTransitionResidual;
  d["max_displacement"] = r.maxDisplacement;
  d["inner_singular_tet_edges"] = nb::cast(r.innerSingularTetEdges);
  d["boundary_singular_tet_edges"] = nb::cast(r.boundarySingularTetEdges);
  d["singular_nodes"] = r.singularNodes;
  d["boundary_genus"] = nb::cast(r.boundaryGenus);
  d["defects"] = asList(r.defects);
  d["expected"] = r.valid() ? nb::object(python::asDict(r.expected)) : nb::none();
  return d;
}

nb::list verifyMesh(const ArrayMap& map, const HexMesh& mesh, int scale, double tolerance,
                    int digits, int threads, const Progress& progress) {
  return asList(run(threads, progress, [&](Context& context) {
    return verify(map.view(), mesh, {.scale = scale, .tolerance = tolerance, .digits = digits},
                  context);
  }));
}

}  // namespace

void bindReports(nb::module_& module) {
  module.def(
      "check",
      [](const ArrayMap& map, double tolerance, int scale, int threads, const Progress& progress) {
        return asDict(run(threads, progress, [&](Context& context) {
          return check(map.view(), {.tolerance = tolerance, .scale = scale}, context);
        }));
      },
      "map"_a, "tolerance"_a, "scale"_a, "threads"_a, "progress"_a.none());
  module.def("verify", &verifyMesh, "map"_a, "mesh"_a, "scale"_a, "tolerance"_a, "digits"_a,
             "threads"_a, "progress"_a.none());
}

}  // namespace hexhex::python
