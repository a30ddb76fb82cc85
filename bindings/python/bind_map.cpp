// Maps: arrays of the caller, and maps in the library's own arrays; generated ones.
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>

#include <hexhex/error.hpp>
#include <hexhex/io.hpp>
#include <hexhex/samples.hpp>

#include "border.hpp"

using namespace nanobind::literals;

namespace hexhex::python {
namespace {

/// The entry of this name in a table of kinds.
template <class Table>
auto kindNamed(const Table& table, const std::string& name, const char* what) {
  for (const auto& entry : table) {
    if (entry.name == name) return entry.kind;
  }
  throw Error(ErrorCode::InvalidArgument,
              std::string("There is no kind of ") + what + " called \"" + name + "\".");
}

TetMap generateMap(const std::string& kind, int cells, int refine, int valence,
                   const std::string& charts, double jitter, double onLattice, double noise,
                   double offset, std::uint64_t seed, bool features, int defects,
                   const std::string& defectKind) {
  SampleOptions options;
  options.cells = cells;
  options.refine = refine;
  options.valence = valence;
  if (charts == "blocks") options.charts = ChartStyle::Blocks;
  if (charts == "random") options.charts = ChartStyle::Random;
  options.jitter = jitter;
  options.onLattice = onLattice;
  options.noise = noise;
  options.offset = offset;
  options.seed = seed;
  options.features = features;
  options.defects = defects;
  options.defectKind = kindNamed(defectKinds(), defectKind, "defect");
  const SampleKind sample = kindNamed(sampleKinds(), kind, "map");
  return run(0, {}, [&](Context& /*context*/) { return generateSample(sample, options).map; });
}

TetMap pairOf(const InPoints& points, const InTets& tets, const InPoints& polycubePoints,
              const InTets& polycubeTets, int threads) {
  const auto meshOf = [](const InPoints& p, const InTets& t) {
    const auto vertices = elements<Vec3>(p);
    const auto corners = elements<Tet>(t);
    return TetMesh{{vertices.begin(), vertices.end()}, {corners.begin(), corners.end()}};
  };
  return run(threads, {}, [&](Context& context) {
    return mapFromPair(meshOf(points, tets), meshOf(polycubePoints, polycubeTets), context);
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
             In<std::int32_t, 3> edgeValences, In<std::int8_t, 4> rotations) {
            new (self) ArrayMap{
                std::move(points),          std::move(tets),         std::move(igm),
                std::move(featureVertices), std::move(featureEdges), std::move(featureFaces),
                std::move(regions),         std::move(edgeValences), std::move(rotations)};
          },
          "points"_a.noconvert(), "tets"_a.noconvert(), "igm"_a.noconvert(),
          "feature_vertices"_a.noconvert(), "feature_edges"_a.noconvert(),
          "feature_faces"_a.noconvert(), "regions"_a.noconvert(), "edge_valences"_a.noconvert(),
          "rotations"_a.noconvert());

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
  module.def("map_from_pair", &pairOf, "points"_a.noconvert(), "tets"_a.noconvert(),
             "polycube_points"_a.noconvert(), "polycube_tets"_a.noconvert(), "threads"_a);
}

}  // namespace hexhex::python
