#include <algorithm>
#include <cmath>
#include <limits>

#include <base/vector3.hpp>
#include <improve/vertex_mover.hpp>
#include <mesh/cell_measures.hpp>

namespace hexhex {

void VertexMover::collect(Index vertex, bool bezier) {
  terms_.clear();
  Index previous = kNone;
  for (const Index cell : around_(vertex)) {
    if (cell == previous) continue;
    previous = cell;
    std::array<Vec3, 8> corners;
    std::size_t moving = 0;
    for (std::size_t place = 0; place < 8; ++place) {
      const Index corner = mesh_.cells[cell][kVtkCorner[place]];
      corners[place] = mesh_.points[corner];
      if (corner == vertex) moving = place;
    }
    (bezier ? addBezierTerms : addCornerTerms)(corners, moving, boxes_[cell], terms_);
  }
}

double VertexMover::sizeAt(Index vertex) const {
  double size = std::numeric_limits<double>::infinity();
  for (const Index cell : around_(vertex)) {
    for (const float edge : boxes_[cell]) size = std::min<double>(size, edge);
  }
  return size;
}

VertexMover::StarQuality VertexMover::qualityAt(Index vertex) const {
  static const MeasureCells measure = measuresOfCells().back();
  StarQuality quality;
  const std::span<const Index> star = around_(vertex);
  CellMeasures measures;
  std::array<Hex, CellMeasures::kMost> cells;
  for (std::size_t begin = 0; begin < star.size(); begin += CellMeasures::kMost) {
    const std::size_t n = std::min(CellMeasures::kMost, star.size() - begin);
    for (std::size_t i = 0; i < n; ++i) cells[i] = mesh_.cells[star[begin + i]];
    measure(mesh_.points.data(), std::span(cells).first(n), measures);
    for (std::size_t i = 0; i < n; ++i) {
      const bool certified = measures.inRange[i] != 0 && measures.least[i] > measures.errorOf(i);
      quality.certified = quality.certified && certified;
      quality.scaled = std::min(quality.scaled, measures.scaled[i]);
    }
  }
  return quality;
}

double VertexMover::chordErrorAt(Index vertex) const {
  const ReferenceSurface& surface = places_.surface;
  double error = 0;
  const auto add = [&error](const Vec3& point, const SurfacePlace& nearest) {
    error = std::max(error, length(minus(point, nearest.point)));
  };
  for (const Index cell : around_(vertex)) {
    for (std::size_t face = 0; face < kHexFaces.size(); ++face) {
      if ((boundary_[cell] >> face & 1U) == 0) continue;
      const Quad quad = faceVertices(mesh_.cells[cell], face);
      const auto at =
          static_cast<std::size_t>(std::find(quad.begin(), quad.end(), vertex) - quad.begin());
      if (at == quad.size()) continue;
      Vec3 centre{};
      for (const Index v : quad) centre = plus(centre, times(0.25, mesh_.points[v]));
      const auto* const start = std::find_if(quad.begin(), quad.end(), [&](Index v) {
        return places_.freedom[v] == Freedom::OnPatch;
      });
      if (start != quad.end()) add(centre, surface.onPatch(centre, places_.simplex[*start]));
      if (places_.freedom[vertex] != Freedom::OnCurve) continue;
      for (const Index other : {quad[(at + 1) % 4], quad[(at + 3) % 4]}) {
        // Other edges lead away from the curve.
        const Vec3& end = mesh_.points[other];
        const SurfacePlace place = surface.onCurve(end, places_.simplex[vertex]);
        if (length(minus(place.point, end)) > chord_) continue;
        const Vec3 middle = times(0.5, plus(end, mesh_.points[vertex]));
        add(middle, surface.onCurve(middle, place.simplex));
      }
    }
  }
  return error;
}

double VertexMover::untangle(Index vertex) {
  if (!mover_.canMove(vertex)) return 0;
  collect(vertex, true);
  return mover_.descend(vertex, terms_, PointMover::untangling(terms_), [] { return true; }) /
         sizeAt(vertex);
}

double VertexMover::smooth(Index vertex, int power, double floor) {
  if (!mover_.canMove(vertex)) return 0;
  const StarQuality before = qualityAt(vertex);
  if (!before.certified) return 0;
  collect(vertex, false);
  const double least = std::min(before.scaled, floor);
  const bool bounded = places_.freedom[vertex] != Freedom::Free;
  const double farthest = bounded ? std::max(chord_, chordErrorAt(vertex)) : 0;
  const double moved = mover_.descend(vertex, terms_, EnergyKind{power, 0, 0}, [&] {
    const StarQuality after = qualityAt(vertex);
    return after.certified && after.scaled >= least &&
           (!bounded || chordErrorAt(vertex) <= farthest);
  });
  return moved / sizeAt(vertex);
}

}  // namespace hexhex
