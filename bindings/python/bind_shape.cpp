// Maps and meshes of tets that have no map.
#include <nanobind/stl/string.h>

#include <hexhex/fill.hpp>
#include <hexhex/mesh.hpp>
#include <hexhex/shape.hpp>

#include "border.hpp"

using namespace nanobind::literals;

namespace hexhex::python {
namespace {

const char* nameOf(ShapeMethod method) {
  return method == ShapeMethod::Frames ? "frames" : "polycube";
}

Dict asDict(const ShapeReport& r) {
  Dict d = fieldsOf(r);
  d.update(fieldsOf(r.labels));
  d["method"] = nameOf(r.method);
  d["rotation"] = ownedArray(r.rotation);
  d["worst"] = r.distortion.worst;
  d["median"] = r.distortion.median;
  return d;
}

/// What WayReport of the package has, in its order.
nb::list asList(const std::vector<WayReport>& ways) {
  nb::list list;
  for (const WayReport& way : ways) {
    list.append(nb::make_tuple(nameOf(way.method), way.hasMesh, way.refusal, way.isCertified,
                               way.minimum, way.distance, way.curvesFollowed, way.merit));
  }
  return list;
}

/// @return tets, how they were filled or None, and warnings
nb::tuple partOfFile(const std::string& file, const FillOptions& options, int threads,
                     const Progress& progress) {
  FilledPart part =
      run(threads, progress, [&](Context& context) { return readPart(file, options, context); });
  nb::object report = nb::none();
  if (part.report) report = fieldsOf(*part.report);
  nb::list warnings;
  for (const std::string& warning : part.warnings) warnings.append(warning);
  return nb::make_tuple(std::move(part.tets), report, warnings);
}

nb::tuple mapOfTets(const TetMesh& tets, const ShapeOptions& options, int threads,
                    const Progress& progress) {
  ShapedMap made =
      run(threads, progress, [&](Context& context) { return mapFromTets(tets, options, context); });
  return nb::make_tuple(std::move(made.map), asDict(made.report));
}

nb::tuple meshOfTets(const TetMesh& tets, const ShapeOptions& shape, double cells,
                     double edgeLength, const ImproveOptions& improvement, int threads,
                     const Progress& progress) {
  const MeshOptions options = {
      .shape = shape,
      .quantize = {.cells = cells, .edgeLength = edgeLength, .densify = true},
      .improve = improvement};
  std::vector<StageTime> stages;
  MeshedPart part = run(
      threads, progress, [&](Context& context) { return meshFromTets(tets, options, context); },
      &stages);
  return nb::make_tuple(std::move(part.mesh), std::move(part.map), asDict(part.shape),
                        python::asDict(part.quantization), python::asList(part.verification),
                        asTuple(std::move(part.improvement)), asList(part.ways), part.whyThisWay,
                        part.tagsReleased, part.missingCurves, python::rowsOf(part.missingGroups),
                        python::asList(stages));
}

}  // namespace

void bindShape(nb::module_& module) {
  nb::enum_<ShapeMethod>(module, "ShapeMethod")
      .value("auto", ShapeMethod::Auto)
      .value("polycube", ShapeMethod::Polycube)
      .value("frames", ShapeMethod::Frames);
  nb::class_<ShapeOptions>(module, "ShapeOptions")
      .def(
          "__init__",
          [](ShapeOptions* self, ShapeMethod method, double featureAngle, std::uint64_t seed) {
            new (self) ShapeOptions{method, featureAngle, seed};
          },
          "method"_a, "feature_angle"_a, "seed"_a);
  nb::class_<TetMesh>(module, "TetMesh")
      .def(
          "__init__",
          [](TetMesh* self, const InPoints& points, const InTets& tets) {
            new (self) TetMesh(tetMeshOf(points, tets));
          },
          "points"_a.noconvert(), "tets"_a.noconvert());
  nb::enum_<Mesher>(module, "Mesher")
      .value("auto", Mesher::Auto)
      .value("tetwild", Mesher::TetWild)
      .value("netgen", Mesher::Netgen)
      .value("gmsh", Mesher::Gmsh)
      .value("tetgen", Mesher::TetGen);
  nb::class_<FillOptions>(module, "FillOptions")
      .def(
          "__init__",
          [](FillOptions* self, Mesher mesher, double tetSize, double cells, double featureAngle) {
            new (self) FillOptions{mesher, tetSize, cells, featureAngle};
          },
          "mesher"_a, "tet_size"_a, "cells"_a, "feature_angle"_a);
  module.def("read_part", &partOfFile, "file"_a, "options"_a, "threads"_a, "progress"_a.none());
  module.def("map_from_tets", &mapOfTets, "tets"_a, "options"_a, "threads"_a, "progress"_a.none());
  module.def("mesh_from_tets", &meshOfTets, "tets"_a, "shape"_a, "cells"_a, "edge_length"_a,
             "improvement"_a, "threads"_a, "progress"_a.none());
}

}  // namespace hexhex::python
