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
  Dict d;
  d["method"] = nameOf(r.method);
  d["rotation"] = ownedArray<double, 2>(std::array(r.rotation), {3, 3});
  d["charts"] = r.labels.charts;
  d["corners"] = r.labels.corners;
  d["bad_loops"] = r.labels.badLoops;
  d["bad_corners"] = r.labels.badCorners;
  d["opposite_edges"] = r.labels.oppositeEdges;
  d["turning_points"] = r.labels.turningPoints;
  d["wrong_turns"] = r.labels.wrongTurns;
  d["flat_charts"] = r.labels.flatCharts;
  d["deviation"] = r.labels.deviation;
  d["label_moves"] = r.labelMoves;
  d["added_tets"] = r.addedTets;
  d["feature_edges"] = r.featureEdges;
  d["tagged_edges"] = r.taggedEdges;
  d["inner_faces"] = r.innerFaces;
  d["aligned_faces"] = r.alignedFaces;
  d["aligned_area"] = r.alignedArea;
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

Dict asDict(const FillReport& r) {
  Dict d;
  d["mesher"] = r.mesher;
  d["tet_size"] = r.tetSize;
  d["tets"] = r.tets;
  d["triangles"] = r.triangles;
  d["bodies"] = r.bodies;
  d["voids"] = r.voids;
  d["volume"] = r.volume;
  d["filled_volume"] = r.filledVolume;
  return d;
}

/// @return tets, and how they were filled or None
nb::tuple partOfFile(const std::string& file, const FillOptions& options, int threads,
                     const Progress& progress) {
  FilledPart part =
      run(threads, progress, [&](Context& context) { return readPart(file, options, context); });
  nb::object report = nb::none();
  if (part.report) report = asDict(*part.report);
  return nb::make_tuple(std::move(part.tets), report);
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
                        part.tagsReleased, part.missingCurves, python::asList(stages));
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
