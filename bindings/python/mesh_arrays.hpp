// The arrays that meshes have, straight or of higher order.
#pragma once

#include "border.hpp"

namespace hexhex::python {

/// Arrays of the caller beside the cells.
struct GivenArrays {
  const InPoints& points;
  const In1<Index>& generatorTet;
  const In1<CornerSet>& generatorCorners;
  const In<std::int32_t, 2>& featureVertices;
  const In<std::int32_t, 3>& featureEdges;
  const In<std::int32_t, 5>& featureQuads;
  const In1<std::int32_t>& regions;
  const std::vector<NameRow>& names;

  template <class Mesh>
  void copyTo(Mesh& mesh) const {
    assign(mesh.points, elements<Vec3>(points));
    assign(mesh.generatorTet, elements<Index>(generatorTet));
    assign(mesh.generatorCorners, elements<CornerSet>(generatorCorners));
    assign(mesh.features.vertices, elements<FeatureVertex>(featureVertices));
    assign(mesh.features.edges, elements<FeatureEdge>(featureEdges));
    assign(mesh.features.quads, elements<FeatureQuad>(featureQuads));
    assign(mesh.regions, elements<std::int32_t>(regions));
    mesh.features.names = namesOf(names);
  }
};

/// Defines properties that are views on the arrays beside the cells, and keep the mesh alive.
template <class Mesh>
void defineArrays(nb::class_<Mesh>& binding) {
  binding
      .def_prop_ro("points",
                   [](nb::handle self) {
                     auto& points = unwrapped<Mesh>(self).points;
                     return viewOn<double, 2>(points, self, {points.size(), 3});
                   })
      .def_prop_ro("generator_tet",
                   [](nb::handle self) {
                     auto& tets = unwrapped<Mesh>(self).generatorTet;
                     return viewOn<Index, 1>(tets, self, {tets.size()});
                   })
      .def_prop_ro("generator_corners",
                   [](nb::handle self) {
                     auto& corners = unwrapped<Mesh>(self).generatorCorners;
                     return viewOn<CornerSet, 1>(corners, self, {corners.size()});
                   })
      .def_prop_ro("feature_vertices",
                   [](nb::handle self) {
                     auto& list = unwrapped<Mesh>(self).features.vertices;
                     return viewOn<std::int32_t, 2>(list, self, {list.size(), 2});
                   })
      .def_prop_ro("feature_edges",
                   [](nb::handle self) {
                     auto& list = unwrapped<Mesh>(self).features.edges;
                     return viewOn<std::int32_t, 2>(list, self, {list.size(), 3});
                   })
      .def_prop_ro("feature_quads",
                   [](nb::handle self) {
                     auto& list = unwrapped<Mesh>(self).features.quads;
                     return viewOn<std::int32_t, 2>(list, self, {list.size(), 5});
                   })
      .def_prop_ro("tag_names", [](const Mesh& self) { return rowsOf(self.features.names); })
      .def_prop_ro("regions", [](nb::handle self) {
        auto& regions = unwrapped<Mesh>(self).regions;
        return viewOn<std::int32_t, 1>(regions, self, {regions.size()});
      });
}

}  // namespace hexhex::python
