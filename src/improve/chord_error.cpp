#include <algorithm>
#include <array>

#include <base/vector3.hpp>
#include <improve/chord_error.hpp>
#include <improve/vertex_energy.hpp>

namespace hexhex::improvement {

double ChordError::at(Index vertex) const {
  const ReferenceSurface& surface = places.surface;
  double error = 0;
  const auto add = [&error](const Vec3& point, const SurfacePlace& nearest) {
    error = std::max(error, length(minus(point, nearest.point)));
  };
  for (const Index cell : around(vertex)) {
    for (std::size_t face = 0; face < adjacency::kHexFaces.size(); ++face) {
      if ((boundary[cell] >> face & 1U) == 0) continue;
      const Quad quad = adjacency::faceVertices(mesh.cells[cell], face);
      const auto at =
          static_cast<std::size_t>(std::find(quad.begin(), quad.end(), vertex) - quad.begin());
      if (at == quad.size()) continue;
      Vec3 centre{};
      for (const Index v : quad) centre = plus(centre, times(0.25, mesh.points[v]));
      const auto* const start = std::find_if(
          quad.begin(), quad.end(), [&](Index v) { return places.freedom[v] == Freedom::OnPatch; });
      if (start != quad.end()) add(centre, places.nearest(*start, centre));
      if (places.freedom[vertex] != Freedom::OnCurve) continue;
      for (const Index other : {quad[(at + 1) % 4], quad[(at + 3) % 4]}) {
        // Other edges lead away from the curve.
        const Vec3& end = mesh.points[other];
        const SurfacePlace place = surface.onCurve(end, places.simplex[vertex]);
        if (length(minus(place.point, end)) > chord) continue;
        const Vec3 middle = times(0.5, plus(end, mesh.points[vertex]));
        add(middle, surface.onCurve(middle, place.simplex));
      }
    }
  }
  return error;
}

}  // namespace hexhex::improvement
