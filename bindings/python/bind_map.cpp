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
  Dict d = asDict(answer.expected);
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
  const std::size_t jumps = s.chartJumps.size();
  std::vector<std::array<Index, 2>> tets(jumps);
  std::vector<std::array<Index, 3>> vertices(jumps);
  std::vector<std::array<std::array<std::int8_t, 3>, 3>> rotations(jumps);
  std::vector<Vec3> translations(jumps);
  for (std::size_t j = 0; j < jumps; ++j) {
    tets[j] = s.chartJumps[j].tets;
    vertices[j] = s.chartJumps[j].vertices;
    rotations[j] = s.chartJumps[j].rotation;
    translations[j] = s.chartJumps[j].translation;
  }
  const std::size_t edges = s.singularEdges.size();
  std::vector<std::array<Index, 2>> ends(edges);
  std::vector<std::int32_t> valences(edges);
  std::vector<std::uint8_t> boundary(edges);
  for (std::size_t e = 0; e < edges; ++e) {
    ends[e] = {s.singularEdges[e].vertex0, s.singularEdges[e].vertex1};
    valences[e] = s.singularEdges[e].valence;
    boundary[e] = s.singularEdges[e].boundary ? 1 : 0;
  }
  return nb::make_tuple(ownedArray<Index, 2>(std::move(tets), {jumps, 2}),
                        ownedArray<Index, 2>(std::move(vertices), {jumps, 3}),
                        ownedArray<std::int8_t, 3>(std::move(rotations), {jumps, 3, 3}),
                        ownedArray<double, 2>(std::move(translations), {jumps, 3}),
                        ownedArray<Index, 2>(std::move(ends), {edges, 2}),
                        ownedArray<std::int32_t, 1>(std::move(valences), {edges}),
                        ownedArray<std::uint8_t, 1>(std::move(boundary), {edges}),
                        asList(s.defects));
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

  nb::class_<TetMap>(module, "Map", "A map in the library's own arrays.")
      .def_prop_ro("points",
                   [](nb::handle self) {
                     auto& points = unwrapped<TetMap>(self).points;
                     return viewOn<double, 2>(points, self, {points.size(), 3});
                   })
      .def_prop_ro("tets",
                   [](nb::handle self) {
                     auto& tets = unwrapped<TetMap>(self).tets;
                     return viewOn<Index, 2>(tets, self, {tets.size(), 4});
                   })
      .def_prop_ro("igm",
                   [](nb::handle self) {
                     auto& igm = unwrapped<TetMap>(self).parameters;
                     return viewOn<double, 3>(igm, self, {igm.size(), 4, 3});
                   })
      .def_prop_ro("feature_vertices",
                   [](nb::handle self) {
                     auto& list = unwrapped<TetMap>(self).features.vertices;
                     return viewOn<std::int32_t, 2>(list, self, {list.size(), 2});
                   })
      .def_prop_ro("feature_edges",
                   [](nb::handle self) {
                     auto& list = unwrapped<TetMap>(self).features.edges;
                     return viewOn<std::int32_t, 2>(list, self, {list.size(), 3});
                   })
      .def_prop_ro("feature_faces",
                   [](nb::handle self) {
                     auto& list = unwrapped<TetMap>(self).features.faces;
                     return viewOn<std::int32_t, 2>(list, self, {list.size(), 4});
                   })
      .def_prop_ro("tag_names", [](const TetMap& self) { return rowsOf(self.features.names); })
      .def_prop_ro("regions",
                   [](nb::handle self) {
                     auto& regions = unwrapped<TetMap>(self).regions;
                     return viewOn<std::int32_t, 1>(regions, self, {regions.size()});
                   })
      .def_prop_ro("edge_valences",
                   [](nb::handle self) {
                     auto& list = unwrapped<TetMap>(self).edgeValences;
                     return viewOn<std::int32_t, 2>(list, self, {list.size(), 3});
                   })
      .def_prop_ro("rotations", [](nb::handle self) {
        auto& list = unwrapped<TetMap>(self).rotations;
        return viewOn<std::int8_t, 2>(list, self, {list.size(), 4});
      });

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
