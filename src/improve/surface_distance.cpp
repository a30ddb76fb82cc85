#include <algorithm>
#include <limits>
#include <vector>

#include <base/parallel.hpp>
#include <base/vector3.hpp>
#include <improve/surface_distance.hpp>

namespace hexhex::improvement {

namespace {

constexpr std::size_t kSurfaceDistanceGrain = 256;

Vec3 centreOf(std::span<const Vec3> corners) {
  Vec3 sum{};
  for (const Vec3& corner : corners) sum = plus(sum, corner);
  for (double& x : sum) x /= static_cast<double>(corners.size());
  return sum;
}

std::array<Vec3, 4> cornersOf(const Array<Vec3>& points, const Quad& quad) {
  return {points[quad[0]], points[quad[1]], points[quad[2]], points[quad[3]]};
}

/// Four triangles for each.
TriangleTree treeOf(const Array<Vec3>& points, std::span<const Quad> quads) {
  std::vector<std::array<Vec3, 3>> triangles;
  triangles.reserve(4 * quads.size());
  for (const Quad& quad : quads) {
    const std::array<Vec3, 4> corners = cornersOf(points, quad);
    const Vec3 centre = centreOf(corners);
    for (std::size_t i = 0; i < 4; ++i) {
      triangles.push_back({corners[i], corners[(i + 1) % 4], centre});
    }
  }
  return TriangleTree(triangles);
}

TriangleTree treeOf(const ReferenceSurface& surface, std::size_t begin, std::size_t end) {
  std::vector<std::array<Vec3, 3>> triangles;
  triangles.reserve(end - begin);
  for (std::size_t t = begin; t < end; ++t) {
    triangles.push_back(surface.triangle(static_cast<Index>(t)));
  }
  return TriangleTree(triangles);
}

/// Of vertices, centres and middles of edges; edges are those of two quads in most cases, and one
/// of these asks.
double distanceOf(const Array<Vec3>& points, const Quad& quad, const TriangleTree& tree) {
  const std::array<Vec3, 4> corners = cornersOf(points, quad);
  double largest = tree.nearest(centreOf(corners)).distance;
  for (std::size_t i = 0; i < 4; ++i) {
    largest = std::max(largest, tree.nearest(corners[i]).distance);
    const std::size_t next = (i + 1) % 4;
    if (quad[i] > quad[next]) continue;
    const std::array<Vec3, 2> ends = {corners[i], corners[next]};
    largest = std::max(largest, tree.nearest(centreOf(ends)).distance);
  }
  return largest;
}

/// In diagonals.
std::vector<double> distancesOf(const Array<Vec3>& points, std::span<const Quad> quads,
                                const TriangleTree& tree, double diagonal, Stage& stage) {
  std::vector<double> distances(quads.size());
  parallelFor(stage, quads.size(), kSurfaceDistanceGrain,
              [&](std::size_t q) { distances[q] = distanceOf(points, quads[q], tree) / diagonal; });
  return distances;
}

double largestOf(std::span<const double> distances) {
  return distances.empty() ? 0 : *std::max_element(distances.begin(), distances.end());
}

}  // namespace

double diagonalOf(const ReferenceSurface& surface) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Vec3 low = {kInfinity, kInfinity, kInfinity};
  Vec3 high = {-kInfinity, -kInfinity, -kInfinity};
  for (Index t = 0; t < surface.triangleCount(); ++t) {
    for (const Vec3& corner : surface.triangle(t)) {
      for (std::size_t k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], corner[k]);
        high[k] = std::max(high[k], corner[k]);
      }
    }
  }
  return length(minus(high, low));
}

TriangleTree treeOf(const ReferenceSurface& surface) {
  return treeOf(surface, 0, surface.boundaryCount());
}

std::vector<Index> BoundaryDistance::quadsBeyond(double limit) const {
  std::vector<Index> quads;
  for (Index q = 0; q < ofQuads.size(); ++q) {
    if (ofQuads[q] > limit) quads.push_back(q);
  }
  return quads;
}

BoundaryDistance distanceBetween(const Array<Vec3>& points, std::span<const Quad> quads,
                                 const ReferenceSurface& surface, const TriangleTree& tree,
                                 double diagonal, Stage& stage) {
  BoundaryDistance distance;
  distance.ofQuads = distancesOf(points, quads, tree, diagonal, stage);
  distance.largest.fromMesh = largestOf(distance.ofQuads);
  distance.fromQuads = distance.ofQuads;

  struct FromSurface {
    std::size_t quad;
    double distance;
  };
  const TriangleTree ofMesh = treeOf(points, quads);
  const std::vector<FromSurface> found = collectFromBlocks<FromSurface>(
      stage, surface.boundaryCount(), kSurfaceDistanceGrain,
      [&](std::size_t begin, std::size_t end, std::vector<FromSurface>& list) {
        for (std::size_t t = begin; t < end; ++t) {
          const std::array<Vec3, 3> corners = surface.triangle(static_cast<Index>(t));
          for (const Vec3& point : {corners[0], corners[1], corners[2], centreOf(corners)}) {
            const TriangleTree::Nearest nearest = ofMesh.nearest(point);
            list.push_back({nearest.triangle / 4, nearest.distance / diagonal});
          }
        }
      });
  for (const FromSurface& sample : found) {
    double& ofQuad = distance.ofQuads[sample.quad];
    ofQuad = std::max(ofQuad, sample.distance);
    distance.largest.fromSurface = std::max(distance.largest.fromSurface, sample.distance);
  }
  return distance;
}

double innerDistance(const Array<Vec3>& points, std::span<const Quad> quads,
                     const ReferenceSurface& surface, double diagonal, Stage& stage) {
  if (quads.empty() || surface.boundaryCount() == surface.triangleCount()) return 0;
  const TriangleTree tree = treeOf(surface, surface.boundaryCount(), surface.triangleCount());
  return largestOf(distancesOf(points, quads, tree, diagonal, stage));
}

}  // namespace hexhex::improvement
