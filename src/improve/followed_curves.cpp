#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include <adjacency/cell_faces.hpp>

#include <base/parallel.hpp>
#include <base/sorted.hpp>
#include <base/vector3.hpp>
#include <improve/followed_curves.hpp>
#include <improve/surface_distance.hpp>

namespace hexhex::improvement {

namespace {

constexpr std::size_t kFollowedCurvesGrain = 1024;

/// Maximum distance of an edge from a curve of which it is a chord, relative to its length.
constexpr double kChordHeight = 0.1;
/// Edges at more than 45 degrees to the curve cross it.
constexpr double kAlong = 0.70710678;

/// Samples: midpoints of the thirds of a segment.
constexpr std::array<double, 3> kSamples = {1.0 / 6, 3.0 / 6, 5.0 / 6};

bool isOnCurve(Freedom freedom) { return freedom == Freedom::OnCurve || freedom == Freedom::Fixed; }

/// Edges of cells with both ends on curves or at corners.
std::vector<std::array<Index, 2>> edgesOnCurves(const HexMesh& mesh, const VertexPlaces& places) {
  std::vector<std::array<Index, 2>> edges;
  for (const Hex& cell : mesh.cells) {
    for (const auto& [a, b] : adjacency::kHexEdges) {
      if (!isOnCurve(places.freedom[cell[a]]) || !isOnCurve(places.freedom[cell[b]])) continue;
      edges.push_back(ascending(cell[a], cell[b]));
    }
  }
  sortUnique(edges);
  return edges;
}

}  // namespace

FollowedCurves followedCurves(const HexMesh& mesh, const VertexPlaces& places,
                              const ReferenceSurface& surface, double tolerance, Stage& stage) {
  if (surface.segmentCount() == 0) return {};
  const std::vector<std::array<Index, 2>> edges = edgesOnCurves(mesh, places);
  std::vector<std::array<Vec3, 3>> ends;
  ends.reserve(edges.size());
  for (const auto& [a, b] : edges) ends.push_back({mesh.points[a], mesh.points[b], mesh.points[b]});
  const TriangleTree tree(ends);
  std::vector<double> followed(surface.segmentCount(), 0);
  parallelFor(stage, followed.size(), kFollowedCurvesGrain, [&](std::size_t s) {
    const auto [begin, end] = surface.segment(static_cast<Index>(s));
    const Vec3 step = minus(end, begin);
    for (const double share : kSamples) {
      if (edges.empty()) break;
      const TriangleTree::Nearest nearest = tree.nearest(plus(begin, times(share, step)));
      const Vec3 edge = minus(ends[nearest.triangle][1], ends[nearest.triangle][0]);
      if (nearest.distance > std::max(tolerance, kChordHeight * length(edge))) continue;
      if (std::abs(cosineBetween(edge, step)) >= kAlong) followed[s] += length(step) / 3;
    }
  });
  FollowedCurves result;
  double sum = 0;
  for (std::size_t s = 0; s < followed.size(); ++s) {
    const auto [begin, end] = surface.segment(static_cast<Index>(s));
    result.length += length(minus(end, begin));
    sum += followed[s];
  }
  if (result.length > 0) result.share = std::min(1.0, sum / result.length);
  return result;
}

}  // namespace hexhex::improvement
