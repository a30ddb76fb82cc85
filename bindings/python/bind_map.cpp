// Maps: arrays of the caller, and maps in the library's own arrays; generated ones.
#include <nanobind/stl/map.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>

#include <hexhex/error.hpp>
#include <hexhex/io.hpp>
#include <hexhex/map_structure.hpp>
#include <hexhex/quantize.hpp>
#include <hexhex/samples.hpp>

#include "border.hpp"

using namespace nanobind::literals;

namespace hexhex::python {
namespace {

/// The entry of this name in a table of kinds or styles.
/// @param what  of it, before its name, e.g. "style of charts"
template <class Table>
auto kindNamed(const Table& table, const std::string& name, const char* what) {
  for (const auto& entry : table) {
    if (entry.name == name) return entry.kind;
  }
  std::string known;
  for (const auto& entry : table) {
    known += (known.empty() ? "" : ", ") + std::string(entry.name);
  }
  throw Error(ErrorCode::InvalidArgument, std::string("There is no ") + what + " \"" + name +
                                              "\". Choose one of " + known + ".");
}

Dict answerAsDict(const SampleAnswer& answer) {
  Dict d = fieldsOf(answer.expected);
  d["vertices"] = answer.vertices;
  d["tagged_vertices"] = nb::cast(answer.features.vertices);
  d["tagged_edges"] = nb::cast(answer.features.edges);
  d["tagged_quads"] = nb::cast(answer.features.quads);
  d["regions"] = answer.features.regions;
  return d;
}

nb::tuple generateMap(const std::string& kind, int cells, int refine, int valence,
                      const std::string& charts, double jitter, double onLattice, double noise,
                      double offset, std::uint64_t seed, bool features, int defects,
                      const std::string& defectKind) {
  SampleOptions options;
  options.cells = cells;
  options.refine = refine;
  options.valence = valence;
  options.charts = kindNamed(chartStyles(), charts, "style of charts");
  options.jitter = jitter;
  options.onLattice = onLattice;
  options.noise = noise;
  options.offset = offset;
  options.seed = seed;
  options.features = features;
  options.defects = defects;
  options.defectKind = kindNamed(defectKinds(), defectKind, "kind of defect called");
  const SampleKind sample = kindNamed(sampleKinds(), kind, "kind of map called");
  Sample made = run(0, {}, [&](Context& /*context*/) { return generateSample(sample, options); });
  return nb::make_tuple(std::move(made.map), answerAsDict(made.answer));
}

nb::list kindsOfMaps() {
  nb::list kinds;
  for (const SampleKindName& entry : sampleKinds()) {
    kinds.append(nb::make_tuple(std::string(entry.name), std::string(entry.description)));
  }
  return kinds;
}

nb::list kindsOfDefects() {
  nb::list kinds;
  for (const DefectKindName& entry : defectKinds()) kinds.append(std::string(entry.name));
  return kinds;
}

/// Arrays of jumps and edges, and the defects.
nb::tuple mapStructureOf(const ArrayMap& map, double tolerance, int threads,
                         const Progress& progress) {
  const MapStructure s = run(threads, progress, [&](Context& context) {
    return findMapStructure(map.view(), tolerance, context);
  });
  std::vector<std::array<Index, 2>> tets;
  std::vector<std::array<Index, 3>> vertices;
  std::vector<std::array<std::array<std::int8_t, 3>, 3>> rotations;
  std::vector<Vec3> translations;
  for (const ChartJump& jump : s.chartJumps) {
    tets.push_back(jump.tets);
    vertices.push_back(jump.vertices);
    rotations.push_back(jump.rotation);
    translations.push_back(jump.translation);
  }
  std::vector<std::array<Index, 2>> ends;
  std::vector<std::int32_t> valences;
  std::vector<std::uint8_t> boundary;
  for (const SingularTetEdge& edge : s.singularEdges) {
    ends.push_back({edge.vertex0, edge.vertex1});
    valences.push_back(edge.valence);
    boundary.push_back(edge.boundary ? 1 : 0);
  }
  return nb::make_tuple(ownedArray(std::move(tets)), ownedArray(std::move(vertices)),
                        ownedArray(std::move(rotations)), ownedArray(std::move(translations)),
                        ownedArray(std::move(ends)), ownedArray(std::move(valences)),
                        ownedArray(std::move(boundary)), asList(s.defects));
}

TetMap mapOfFlags(const InPoints& points, const InTets& tets, const In<std::int8_t, 4>& flags,
                  int threads, const Progress& progress) {
  return run(threads, progress, [&](Context& context) {
    return mapFromFlags(tetMeshOf(points, tets), elements<FaceFlags>(flags), context);
  });
}

TetMap pairOf(const InPoints& points, const InTets& tets, const InPoints& polycubePoints,
              const InTets& polycubeTets, int threads) {
  return run(threads, {}, [&](Context& context) {
    return mapFromPair(tetMeshOf(points, tets), tetMeshOf(polycubePoints, polycubeTets), context);
  });
}

}  // namespace

void bindMap(nb::module_& module) {
  nb::class_<ArrayMap>(module, "MapArrays", "The arrays of a map, borrowed.")
      .def(
          "__init__",
          [](ArrayMap* self, InPoints points, InTets tets, InIgm igm,
             In<std::int32_t, 2> featureVertices, In<std::int32_t, 3> featureEdges,
             In<std::int32_t, 4> featureFaces, In1<std::int32_t> regions,
             In<std::int32_t, 3> edgeValences, In<std::int8_t, 4> rotations,
             const std::vector<NameRow>& names) {
            new (self) ArrayMap{std::move(points),       std::move(tets),
                                std::move(igm),          std::move(featureVertices),
                                std::move(featureEdges), std::move(featureFaces),
                                std::move(regions),      std::move(edgeValences),
                                std::move(rotations),    namesOf(names)};
          },
          "points"_a.noconvert(), "tets"_a.noconvert(), "igm"_a.noconvert(),
          "feature_vertices"_a.noconvert(), "feature_edges"_a.noconvert(),
          "feature_faces"_a.noconvert(), "regions"_a.noconvert(), "edge_valences"_a.noconvert(),
          "rotations"_a.noconvert(), "tag_names"_a);

  nb::class_<TetMap> binding(module, "Map", "A map in the library's own arrays.");
  defineView(binding, "points", &TetMap::points);
  defineView(binding, "tets", &TetMap::tets);
  defineView(binding, "igm", &TetMap::parameters);
  defineView(
      binding, "feature_vertices", [](TetMap & m) -> auto& { return m.features.vertices; });
  defineView(
      binding, "feature_edges", [](TetMap & m) -> auto& { return m.features.edges; });
  defineView(
      binding, "feature_faces", [](TetMap & m) -> auto& { return m.features.faces; });
  defineView(binding, "regions", &TetMap::regions);
  defineView(binding, "edge_valences", &TetMap::edgeValences);
  defineView(binding, "rotations", &TetMap::rotations);
  binding.def_prop_ro("tag_names", [](const TetMap& self) { return rowsOf(self.features.names); });

  module.def("generate", &generateMap, "kind"_a, "cells"_a, "refine"_a, "valence"_a, "charts"_a,
             "jitter"_a, "on_lattice"_a, "noise"_a, "offset"_a, "seed"_a, "features"_a, "defects"_a,
             "defect_kind"_a);
  module.def("sample_kinds", &kindsOfMaps);
  module.def("defect_kinds", &kindsOfDefects);
  module.def("map_structure", &mapStructureOf, "map"_a, "tolerance"_a, "threads"_a,
             "progress"_a.none());
  module.def("map_from_pair", &pairOf, "points"_a.noconvert(), "tets"_a.noconvert(),
             "polycube_points"_a.noconvert(), "polycube_tets"_a.noconvert(), "threads"_a);
  module.def("map_from_flags", &mapOfFlags, "points"_a.noconvert(), "tets"_a.noconvert(),
             "flags"_a.noconvert(), "threads"_a, "progress"_a.none());
}

}  // namespace hexhex::python
