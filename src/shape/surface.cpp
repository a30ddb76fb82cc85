#include <cmath>

#include <quantize/polycube/boundary_sides.hpp>
#include <shape/surface.hpp>

#include <base/box.hpp>
#include <base/disjoint_sets.hpp>

namespace hexhex::shape {

namespace {

/// Any unit vector will do for edges of no length and triangles of no area.
Vec3 normalized(const Vec3& v) {
  const double size = length(v);
  if (size == 0) return {0, 0, 1};
  return {v[0] / size, v[1] / size, v[2] / size};
}

void measure(Surface& surface, const std::vector<Vec3>& points) {
  const std::size_t count = surface.triangleCount();
  double lengths = 0;
  for (Side side = 0; side < 3 * count; ++side) {
    const Vec3 edge = minus(points[surface.head(side)], points[surface.tails[side]]);
    surface.lengths.push_back(length(edge));
    surface.directions.push_back(normalized(edge));
    lengths += surface.lengths.back();
  }
  for (Side first = 0; first < 3 * count; first += 3) {
    const Vec3& a = points[surface.tails[first]];
    const Vec3& b = points[surface.head(first)];
    const Vec3& c = points[surface.head(Surface::next(first))];
    const Vec3 normal = cross(minus(b, a), minus(c, a));
    surface.normals.push_back(normalized(normal));
    surface.areas.push_back(0.5 * length(normal));
    surface.area += surface.areas.back();
    const Vec3 sum = plus(plus(a, b), c);
    surface.centres.push_back({sum[0] / 3, sum[1] / 3, sum[2] / 3});
  }
  surface.meanEdge = lengths / static_cast<double>(3 * count);
  surface.meanArea = surface.area / static_cast<double>(count);
  Box box;
  for (const Index v : surface.tails) box.add(points[v]);
  surface.diagonal = box.diagonal();
}

}  // namespace

void Surface::turn(const Rotation& rotation) {
  for (std::vector<Vec3>* const vectors : {&directions, &normals, &centres}) {
    for (Vec3& v : *vectors) v = turned(rotation, v);
  }
}

std::vector<Side> Surface::sidesAt() const {
  std::vector<Side> sides(pointCount, kNone);
  for (Side side = 0; side < tails.size(); ++side) sides[tails[side]] = side;
  return sides;
}

std::vector<Index> Surface::components() const {
  DisjointSets sets(pointCount);
  for (Side side = 0; side < tails.size(); ++side) sets.unite(tails[side], head(side));
  std::vector<Index> components;
  components.reserve(pointCount);
  for (Index v = 0; v < pointCount; ++v) components.push_back(sets.find(v));
  return components;
}

Surface surfaceOf(const adjacency::TetTopology& topology, const std::vector<Vec3>& points) {
  const quantization::BoundarySides sides(topology);
  Surface surface;
  surface.pointCount = topology.pointCount;
  for (std::size_t side = 0; side < sides.size(); ++side) {
    if (side % 3 == 0) surface.faces.push_back(sides.face(side));
    surface.tails.push_back(sides.tail(side));
    surface.twins.push_back(static_cast<Side>(sides.twin(side)));
  }
  measure(surface, points);
  return surface;
}

Surface smoothed(const Surface& surface, std::vector<Vec3> points, int rounds) {
  std::vector<double> neighbours(surface.pointCount);
  for (const Index v : surface.tails) ++neighbours[v];
  for (int round = 0; round < rounds; ++round) {
    std::vector<Vec3> sums(surface.pointCount);
    for (Side side = 0; side < surface.tails.size(); ++side) {
      Vec3& sum = sums[surface.tails[side]];
      sum = plus(sum, points[surface.head(side)]);
    }
    for (std::size_t v = 0; v < sums.size(); ++v) {
      if (neighbours[v] > 0) points[v] = times(1 / neighbours[v], sums[v]);
    }
  }
  Surface result;
  result.tails = surface.tails;
  result.twins = surface.twins;
  result.faces = surface.faces;
  result.pointCount = surface.pointCount;
  measure(result, points);
  return result;
}

bool isManifold(const Surface& surface) {
  std::vector<Index> countAt(surface.pointCount);
  std::vector<std::array<Index, 2>> edges;
  for (Side side = 0; side < surface.tails.size(); ++side) {
    ++countAt[surface.tails[side]];
    edges.push_back({surface.tails[side], surface.head(side)});
  }
  std::sort(edges.begin(), edges.end());
  if (std::adjacent_find(edges.begin(), edges.end()) != edges.end()) return false;
  for (const Side first : surface.sidesAt()) {
    if (first == kNone) continue;
    Index count = 0;
    surface.forEachSideAround(first, [&count](Side /*side*/) { ++count; });
    if (count != countAt[surface.tails[first]]) return false;
  }
  return true;
}

}  // namespace hexhex::shape
