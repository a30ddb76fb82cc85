#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <base/parallel.hpp>
#include <base/vector3.hpp>
#include <improve/reference_surface.hpp>
#include <improve/surface_distance.hpp>

namespace hexhex::improvement {

namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();
/// Triangles in a leaf.
constexpr std::size_t kLeaf = 4;

double squaredDistance(const Box& box, const Vec3& point) {
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double d = std::max({box.low[k] - point[k], point[k] - box.high[k], 0.0});
    sum += d * d;
  }
  return sum;
}

}  // namespace

TriangleTree::TriangleTree(std::span<const std::array<Vec3, 3>> triangles) {
  triangles_.reserve(triangles.size());
  for (const std::array<Vec3, 3>& corners : triangles) {
    triangles_.push_back({corners, triangles_.size()});
  }
  std::size_t nodes = 1;
  for (std::size_t leaves = 1; leaves * kLeaf < triangles_.size(); leaves *= 2) nodes += 2 * leaves;
  boxes_.resize(nodes);
  build(0, 0, triangles_.size());
}

void TriangleTree::build(std::size_t node, std::size_t begin, std::size_t end) {
  Box box;
  for (std::size_t t = begin; t < end; ++t) {
    for (const Vec3& corner : triangles_[t].corners) box.add(corner);
  }
  boxes_[node] = box;
  if (2 * node + 2 >= boxes_.size()) return;
  const std::size_t axis = dominantAxis(minus(box.high, box.low));
  const std::size_t middle = begin + (end - begin) / 2;
  const auto at = [this](std::size_t i) {
    return triangles_.begin() + static_cast<std::ptrdiff_t>(i);
  };
  std::nth_element(at(begin), at(middle), at(end), [axis](const Triangle& s, const Triangle& t) {
    const auto& [a, b] = std::pair(s.corners, t.corners);
    return a[0][axis] + a[1][axis] + a[2][axis] < b[0][axis] + b[1][axis] + b[2][axis];
  });
  build(2 * node + 1, begin, middle);
  build(2 * node + 2, middle, end);
}

TriangleTree::Nearest TriangleTree::nearest(const Vec3& point) const {
  struct Range {
    std::size_t node;
    std::size_t begin;
    std::size_t end;
    double squared;
  };
  double best = kFar;
  std::size_t triangle = 0;
  std::vector<Range> open = {{0, 0, triangles_.size(), squaredDistance(boxes_[0], point)}};
  while (!open.empty()) {
    const Range range = open.back();
    open.pop_back();
    if (range.squared >= best) continue;
    if (2 * range.node + 2 >= boxes_.size()) {
      for (std::size_t t = range.begin; t < range.end; ++t) {
        const Vec3 d = minus(nearestOf(triangles_[t].corners, point), point);
        if (dot(d, d) >= best) continue;
        best = dot(d, d);
        triangle = triangles_[t].number;
      }
      continue;
    }
    const std::size_t middle = range.begin + (range.end - range.begin) / 2;
    const std::size_t child = 2 * range.node + 1;
    Range low{child, range.begin, middle, squaredDistance(boxes_[child], point)};
    Range high{child + 1, middle, range.end, squaredDistance(boxes_[child + 1], point)};
    if (low.squared < high.squared) std::swap(low, high);
    open.push_back(low);
    open.push_back(high);
  }
  return {std::sqrt(best), triangle};
}

namespace {

constexpr std::size_t kSurfaceDistanceGrain = 256;

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

/// The vertices of polygons, each once.
/// @param polygonOf  of (i)
template <class PolygonOf>
std::vector<Index> verticesOf(std::size_t polygons, std::size_t points,
                              const PolygonOf& polygonOf) {
  std::vector<Index> vertices;
  std::vector<bool> isListed(points, false);
  for (std::size_t i = 0; i < polygons; ++i) {
    for (const Index v : polygonOf(i)) {
      if (!isListed[v]) vertices.push_back(v);
      isListed[v] = true;
    }
  }
  return vertices;
}

/// Of centres and middles of edges; edges are those of two quads in most cases, and one of these
/// asks.
double distanceOf(const Array<Vec3>& points, const Quad& quad, const TriangleTree& tree) {
  const std::array<Vec3, 4> corners = cornersOf(points, quad);
  double largest = tree.nearest(centreOf(corners)).distance;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t next = (i + 1) % 4;
    if (quad[i] > quad[next]) continue;
    const std::array<Vec3, 2> ends = {corners[i], corners[next]};
    largest = std::max(largest, tree.nearest(centreOf(ends)).distance);
  }
  return largest;
}

/// Of vertices, too; in diagonals.
std::vector<double> distancesOf(const Array<Vec3>& points, std::span<const Quad> quads,
                                const TriangleTree& tree, double diagonal, Stage& stage) {
  const std::vector<Index> vertices =
      verticesOf(quads.size(), points.size(), [&](std::size_t q) { return quads[q]; });
  std::vector<double> ofVertices(points.size());
  parallelFor(stage, vertices.size(), kSurfaceDistanceGrain, [&](std::size_t i) {
    ofVertices[vertices[i]] = tree.nearest(points[vertices[i]]).distance;
  });
  std::vector<double> distances(quads.size());
  parallelFor(stage, quads.size(), kSurfaceDistanceGrain, [&](std::size_t q) {
    double largest = distanceOf(points, quads[q], tree);
    for (const Index v : quads[q]) largest = std::max(largest, ofVertices[v]);
    distances[q] = largest / diagonal;
  });
  return distances;
}

double largestOf(std::span<const double> distances) {
  return distances.empty() ? 0 : *std::max_element(distances.begin(), distances.end());
}

}  // namespace

double diagonalOf(const ReferenceSurface& surface) {
  Box box;
  for (Index t = 0; t < surface.triangleCount(); ++t) {
    for (const Vec3& corner : surface.triangle(t)) box.add(corner);
  }
  return box.diagonal();
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

  struct FromSurface {
    std::size_t quad;
    double distance;
  };
  const TriangleTree ofMesh = treeOf(points, quads);
  const std::vector<Index> vertices =
      verticesOf(surface.boundaryCount(), surface.points().size(),
                 [&](std::size_t t) { return surface.triangleVertices(static_cast<Index>(t)); });
  const std::vector<FromSurface> found = collectFromBlocks<FromSurface>(
      stage, vertices.size() + surface.boundaryCount(), kSurfaceDistanceGrain,
      [&](std::size_t begin, std::size_t end, std::vector<FromSurface>& list) {
        for (std::size_t i = begin; i < end; ++i) {
          const Vec3 point =
              i < vertices.size()
                  ? surface.points()[vertices[i]]
                  : centreOf(surface.triangle(static_cast<Index>(i - vertices.size())));
          const TriangleTree::Nearest nearest = ofMesh.nearest(point);
          list.push_back({nearest.triangle / 4, nearest.distance / diagonal});
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
