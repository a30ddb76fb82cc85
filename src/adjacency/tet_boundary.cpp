// The boundary of a tetrahedral mesh as a surface of triangles.

#include <adjacency/corner_range.hpp>
#include <adjacency/tet_topology.hpp>

#include <hexhex/error.hpp>
#include <hexhex/fill.hpp>

#include <base/stage.hpp>

namespace hexhex {

TriangleMesh boundaryOf(const TetMesh& tets, Context& context) {
  Stage stage(context, "boundary");
  TetMapView view;
  view.points = tets.points;
  view.tets = tets.tets;
  adjacency::requireCornersInRange(view, stage);
  const auto topology = adjacency::manifoldTopology(tets.tets, tets.points.size(), stage);
  if (!topology) {
    throw Error(ErrorCode::NonManifoldFace,
                "The tets are no manifold: a triangle belongs to more than two of them, or to two "
                "on the same side. Correct them, or give a surface of triangles.");
  }
  TriangleMesh surface;
  surface.points.assign(tets.points.begin(), tets.points.end());
  for (adjacency::HalfFace face = 0; face < 4 * tets.tets.size(); ++face) {
    if (topology->mate[face] != kNone) continue;
    const auto v = adjacency::faceVertices(tets.tets[adjacency::tetOf(face)], face % 4);
    surface.triangles.push_back({v[0], v[2], v[1]});  // facing outwards
  }
  return surface;
}

}  // namespace hexhex
