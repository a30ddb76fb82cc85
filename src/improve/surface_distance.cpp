#include <algorithm>
#include <limits>
#include <vector>

#include <base/parallel.hpp>
#include <base/vector3.hpp>
#include <improve/surface_distance.hpp>

namespace hexhex {

namespace {

constexpr std::size_t kGrain = 256;

Vec3 centreOf(std::span<const Vec3> corners) {
  Vec3 sum{};
  for (const Vec3& corner : corners) sum = plus(sum, corner);
  for (double& x : sum) x /= static_cast<double>(corners.size());
  return sum;
}

/// The largest of distances of samples.
template <class Samples>
double largestDistance(const TriangleTree& tree, std::size_t n, const Samples& samplesOf,
                       Stage& stage) {
  std::vector<double> largest(blockCount(n, kGrain));
  parallelBlocks(stage, n, kGrain, [&](std::size_t begin, std::size_t end, std::size_t block) {
    for (std::size_t i = begin; i < end; ++i) {
      for (const Vec3& point : samplesOf(i)) {
        largest[block] = std::max(largest[block], tree.distanceTo(point));
      }
    }
  });
  return largest.empty() ? 0 : *std::max_element(largest.begin(), largest.end());
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
  std::vector<std::array<Vec3, 3>> triangles(surface.triangleCount());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    triangles[t] = surface.triangle(static_cast<Index>(t));
  }
  return TriangleTree(std::move(triangles));
}

SurfaceDistance distanceBetween(const Array<Vec3>& points, std::span<const Quad> quads,
                                const ReferenceSurface& surface, const TriangleTree& tree,
                                double diagonal, Stage& stage) {
  const auto cornersOf = [&](std::size_t q) {
    return std::array<Vec3, 4>{points[quads[q][0]], points[quads[q][1]], points[quads[q][2]],
                               points[quads[q][3]]};
  };
  SurfaceDistance distance;
  // Each vertex is the first of about one quad, but not each of any.
  distance.fromMesh = largestDistance(
      tree, quads.size(),
      [&](std::size_t q) {
        const std::array<Vec3, 4> corners = cornersOf(q);
        return std::array<Vec3, 5>{corners[0], corners[1], corners[2], corners[3],
                                   centreOf(corners)};
      },
      stage);
  std::vector<std::array<Vec3, 3>> triangles;
  triangles.reserve(4 * quads.size());
  for (std::size_t q = 0; q < quads.size(); ++q) {
    const std::array<Vec3, 4> corners = cornersOf(q);
    const Vec3 centre = centreOf(corners);
    for (std::size_t i = 0; i < 4; ++i) {
      triangles.push_back({corners[i], corners[(i + 1) % 4], centre});
    }
  }
  const TriangleTree ofMesh(std::move(triangles));
  distance.fromSurface = largestDistance(
      ofMesh, surface.triangleCount(),
      [&](std::size_t t) {
        const std::array<Vec3, 3> corners = surface.triangle(static_cast<Index>(t));
        return std::array<Vec3, 4>{corners[0], corners[1], corners[2], centreOf(corners)};
      },
      stage);
  distance.fromMesh /= diagonal;
  distance.fromSurface /= diagonal;
  return distance;
}

}  // namespace hexhex
