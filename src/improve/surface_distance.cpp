#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <base/parallel.hpp>
#include <base/sorted.hpp>
#include <base/vector3.hpp>
#include <improve/reference_surface.hpp>
#include <improve/surface_distance.hpp>

namespace hexhex::improvement {

namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();
/// Maximum number of triangles in a leaf.
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

void TriangleTree::build() {
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

TriangleTree::Nearest TriangleTree::nearest(const Vec3& point, std::size_t begin,
                                            double enough) const {
  struct Range {
    std::size_t node;
    std::size_t begin;
    std::size_t end;
    double squared;
  };
  if (triangles_.empty()) return {kFar};
  double best = kFar;
  std::size_t place = 0;
  const auto look = [&](std::size_t t) {
    const Vec3 d = minus(nearestOf(triangles_[t].corners, point), point);
    if (dot(d, d) >= best) return;
    best = dot(d, d);
    place = t;
  };
  look(begin);
  std::array<Range, 64> open;  // twice as many as levels
  open[0] = {0, 0, triangles_.size(), squaredDistance(boxes_[0], point)};
  for (std::size_t count = 1; count > 0 && best > enough * enough;) {
    const Range range = open[--count];
    if (range.squared >= best) continue;
    if (2 * range.node + 2 >= boxes_.size()) {
      for (std::size_t t = range.begin; t < range.end; ++t) look(t);
      continue;
    }
    const std::size_t middle = range.begin + (range.end - range.begin) / 2;
    const std::size_t child = 2 * range.node + 1;
    Range low{child, range.begin, middle, squaredDistance(boxes_[child], point)};
    Range high{child + 1, middle, range.end, squaredDistance(boxes_[child + 1], point)};
    if (low.squared < high.squared) std::swap(low, high);
    open[count++] = low;
    open[count++] = high;
  }
  return {std::sqrt(best), triangles_[place].number, place};
}

namespace {

constexpr std::size_t kSurfaceDistanceGrain = 256;
/// Samples are for quads with at least such edges, in diagonals.
constexpr double kShortestQuadEdge = 1e-3;

std::array<Vec3, 4> cornersOf(const Array<Vec3>& points, const Quad& quad) {
  return {points[quad[0]], points[quad[1]], points[quad[2]], points[quad[3]]};
}

/// A tree of four triangles per quad.
TriangleTree treeOf(const Array<Vec3>& points, std::span<const Quad> quads) {
  return {4 * quads.size(), [&](std::size_t t) {
            const std::array<Vec3, 4> corners = cornersOf(points, quads[t / 4]);
            return std::array<Vec3, 3>{corners[t % 4], corners[(t + 1) % 4], centreOf(corners)};
          }};
}

TriangleTree treeOf(const ReferenceSurface& surface, std::size_t begin, std::size_t end) {
  return {end - begin,
          [&](std::size_t t) { return surface.triangle(static_cast<Index>(begin + t)); }};
}

/// Positions of samples along edges and across quads. More than the middle, since ridges between
/// triangles as long as quads are farthest from these anywhere between vertices.
constexpr std::array<double, 3> kQuarters = {0.25, 0.5, 0.75};

Vec3 between(const Vec3& a, const Vec3& b, double share) {
  return plus(times(1 - share, a), times(share, b));
}

Vec3 pointOf(const std::array<Vec3, 4>& corners, const std::array<double, 4>& weights) {
  Vec3 point{};
  for (std::size_t i = 0; i < 4; ++i) point = plus(point, times(weights[i], corners[i]));
  return point;
}

/// Calls visit(weights of the corners, which corner it is) for the corners of a quad and for
/// samples on edges and inside, which are none: 4. An edge of two quads is only sampled for one.
template <class Visit>
void forSamples(const Quad& quad, const Visit& visit) {
  constexpr std::size_t kBetween = 4;
  for (std::size_t i = 0; i < 4; ++i) {
    std::array<double, 4> weights{};
    weights[i] = 1;
    visit(weights, i);
    const std::size_t next = (i + 1) % 4;
    if (quad[i] > quad[next]) continue;
    for (const double share : kQuarters) {
      weights[i] = 1 - share;
      weights[next] = share;
      visit(weights, kBetween);
    }
  }
  for (const double s : kQuarters) {
    for (const double t : kQuarters) {
      visit(std::array<double, 4>{(1 - s) * (1 - t), (1 - s) * t, s * t, s * (1 - t)}, kBetween);
    }
  }
}

/// Vertices, points on edges, at most so far apart, and centres of boundary triangles: each once.
/// What the mesh misses of the surface, it misses most at vertices or edges.
std::vector<Vec3> samplesOf(const ReferenceSurface& surface, double spacing) {
  std::vector<std::array<Index, 2>> edges;  // with equal vertices: that vertex
  std::vector<Vec3> samples;
  for (Index t = 0; t < surface.boundaryCount(); ++t) {
    samples.push_back(centreOf(surface.triangle(t)));
    const std::array<Index, 3>& v = surface.triangleVertices(t);
    for (std::size_t i = 0; i < 3; ++i) {
      edges.push_back({v[i], v[i]});
      edges.push_back(ascending(v[i], v[(i + 1) % 3]));
    }
  }
  sortUnique(edges);
  for (const auto& [a, b] : edges) {
    const Vec3& start = surface.points()[a];
    const Vec3& end = surface.points()[b];
    if (a == b) samples.push_back(start);
    const double parts = std::max(2.0, std::ceil(length(minus(end, start)) / spacing));
    for (double i = 1; i < parts && a != b; ++i) samples.push_back(between(start, end, i / parts));
  }
  return samples;
}

/// Per quad: the largest distance, in diagonals.
/// @param enough  smaller ones may be any below it
std::vector<double> distancesOf(const Array<Vec3>& points, std::span<const Quad> quads,
                                const TriangleTree& tree, double diagonal, double enough,
                                Stage& stage) {
  std::vector<Index> vertices;  // each is a corner of about four quads
  for (const Quad& quad : quads) vertices.insert(vertices.end(), quad.begin(), quad.end());
  sortUnique(vertices);
  std::vector<double> ofVertices(points.size());
  parallelFor(stage, vertices.size(), kSurfaceDistanceGrain, [&](std::size_t i) {
    ofVertices[vertices[i]] = tree.nearest(points[vertices[i]], 0, enough * diagonal).distance;
  });
  std::vector<double> distances(quads.size());
  parallelFor(stage, quads.size(), kSurfaceDistanceGrain, [&](std::size_t q) {
    const std::array<Vec3, 4> corners = cornersOf(points, quads[q]);
    TriangleTree::Nearest nearest;
    double largest = 0;
    forSamples(quads[q], [&](const std::array<double, 4>& weights, std::size_t corner) {
      if (corner == 4) {
        nearest = tree.nearest(pointOf(corners, weights), nearest.place, enough * diagonal);
      }
      largest = std::max(largest, corner < 4 ? ofVertices[quads[q][corner]] : nearest.distance);
    });
    distances[q] = largest / diagonal;
  });
  return distances;
}

/// Adds those of the samples of a quad.
void addGaps(const Array<Vec3>& points, std::span<const Quad> quads, Index quad,
             const ReferenceSurface& surface, const TriangleTree& tree, std::vector<Gap>& gaps) {
  const std::array<Vec3, 4> corners = cornersOf(points, quads[quad]);
  forSamples(quads[quad], [&](const std::array<double, 4>& weights, std::size_t /*corner*/) {
    const Vec3 point = pointOf(corners, weights);
    const auto nearest = static_cast<Index>(tree.nearest(point).triangle);
    gaps.push_back({quad, weights, minus(nearestOf(surface.triangle(nearest), point), point)});
  });
}

/// The gap to a sample of the surface.
/// @param triangle  that is nearest to it, of treeOf()
Gap gapTo(const Vec3& sample, const Array<Vec3>& points, std::span<const Quad> quads,
          std::size_t triangle) {
  const auto quad = static_cast<Index>(triangle / 4);
  const std::array<Vec3, 4> corners = cornersOf(points, quads[quad]);
  const std::size_t i = triangle % 4;
  const std::size_t next = (i + 1) % 4;
  const Vec3 centre = centreOf(corners);
  const Vec3 point = nearestOf(std::array<Vec3, 3>{corners[i], corners[next], centre}, sample);
  const Vec3 u = minus(corners[i], centre);
  const Vec3 v = minus(corners[next], centre);
  const Vec3 w = minus(point, centre);  // first u + second v
  const double square = dot(cross(u, v), cross(u, v));
  const double first = square > 0 ? dot(cross(w, v), cross(u, v)) / square : 0;
  const double second = square > 0 ? dot(cross(u, w), cross(u, v)) / square : 0;
  Gap gap{quad, {}, minus(sample, point)};
  gap.weights.fill((1 - first - second) / 4);
  gap.weights[i] += first;
  gap.weights[next] += second;
  return gap;
}

double largestOf(std::span<const double> distances) {
  return distances.empty() ? 0 : *std::max_element(distances.begin(), distances.end());
}

}  // namespace

double meanEdge(const Array<Vec3>& points, std::span<const Quad> quads) {
  double sum = 0;
  for (const Quad& quad : quads) {
    for (std::size_t i = 0; i < 4; ++i)
      sum += length(minus(points[quad[i]], points[quad[(i + 1) % 4]]));
  }
  return sum / static_cast<double>(std::max<std::size_t>(1, 4 * quads.size()));
}

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
                                 double diagonal, Stage& stage, const Accuracy& accuracy) {
  const auto& [enough, gapsFrom] = accuracy;
  BoundaryDistance distance;
  distance.ofQuads = distancesOf(points, quads, tree, diagonal, enough, stage);
  distance.largest.fromMesh = largestOf(distance.ofQuads);

  const TriangleTree ofMesh = treeOf(points, quads);
  // Closer ones would be too many if the mesh has another unit, or no size.
  const double spacing = std::max(meanEdge(points, quads), kShortestQuadEdge * diagonal) / 4;
  const std::vector<Vec3> samples = samplesOf(surface, spacing);
  std::vector<TriangleTree::Nearest> found(samples.size());
  parallelBlocks(stage, samples.size(), kSurfaceDistanceGrain,
                 [&, enough = enough](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   std::size_t place = 0;
                   for (std::size_t i = begin; i < end; ++i) {
                     found[i] = ofMesh.nearest(samples[i], place, enough * diagonal);
                     place = found[i].place;
                   }
                 });
  for (const auto& [far, triangle, place] : found) {
    double& ofQuad = distance.ofQuads[triangle / 4];
    ofQuad = std::max(ofQuad, far / diagonal);
    distance.largest.fromSurface = std::max(distance.largest.fromSurface, far / diagonal);
  }
  for (Index q = 0; q < quads.size(); ++q) {
    if (distance.ofQuads[q] > gapsFrom) addGaps(points, quads, q, surface, tree, distance.gaps);
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (found[i].distance <= gapsFrom * diagonal) continue;
    distance.gaps.push_back(gapTo(samples[i], points, quads, found[i].triangle));
  }
  std::erase_if(distance.gaps,
                [&](const Gap& gap) { return length(gap.way) <= accuracy.gapsFrom * diagonal; });
  return distance;
}

double innerDistance(const Array<Vec3>& points, std::span<const Quad> quads,
                     const ReferenceSurface& surface, double diagonal, Stage& stage) {
  if (quads.empty() || surface.boundaryCount() == surface.triangleCount()) return 0;
  const TriangleTree tree = treeOf(surface, surface.boundaryCount(), surface.triangleCount());
  return largestOf(distancesOf(points, quads, tree, diagonal, 0, stage));
}

}  // namespace hexhex::improvement
