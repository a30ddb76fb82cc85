#include <improve/creases.hpp>

namespace hexhex::improvement {

LooseVertices::LooseVertices(VertexPlaces& places, std::span<const Index> vertices,
                             const Array<Vec3>& points)
    : places_(places) {
  for (const Index v : vertices) {
    const Held held{v, places.freedom[v], places.simplex[v], points[v]};
    if (!places.surface.isCrease(held.freedom, held.simplex)) continue;
    held_.push_back(held);
    places.simplex[v] = places.surface.triangleAt(held.freedom, held.simplex, held.point);
    places.freedom[v] = Freedom::OnPatch;
    places.isLoose[v] = 1;
  }
}

std::vector<Index> LooseVertices::holdUnmoved(const Array<Vec3>& points) {
  std::vector<Index> moved;
  for (const Held& held : held_) {
    const Index v = held.vertex;
    if (points[v] != held.point) {
      moved.push_back(v);
      continue;
    }
    places_.freedom[v] = held.freedom;
    places_.simplex[v] = held.simplex;
    places_.isLoose[v] = 0;
  }
  return moved;
}

}  // namespace hexhex::improvement
