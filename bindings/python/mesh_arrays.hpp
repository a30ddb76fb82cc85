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
  defineView(binding, "points", &Mesh::points);
  defineView(binding, "generator_tet", &Mesh::generatorTet);
  defineView(binding, "generator_corners", &Mesh::generatorCorners);
  defineView(
      binding, "feature_vertices", [](Mesh & m) -> auto& { return m.features.vertices; });
  defineView(
      binding, "feature_edges", [](Mesh & m) -> auto& { return m.features.edges; });
  defineView(
      binding, "feature_quads", [](Mesh & m) -> auto& { return m.features.quads; });
  defineView(binding, "regions", &Mesh::regions);
  binding.def_prop_ro("tag_names", [](const Mesh& self) { return rowsOf(self.features.names); });
}

}  // namespace hexhex::python
