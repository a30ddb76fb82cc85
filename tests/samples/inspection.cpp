#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <set>
#include <vector>

#include <samples/inspection.hpp>

namespace hexhex::test {

namespace {

constexpr double kRightAngle = 1.5707963267948966;

Vec3 minus(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double determinant(const Vec3& p0, const Vec3& p1, const Vec3& p2, const Vec3& p3) {
  return dot(minus(p1, p0), cross(minus(p2, p0), minus(p3, p0)));
}
double toInteger(double x) { return std::abs(x - std::round(x)); }

/// One side of a triangle: the tet and its corners, counter-clockwise from outside the tet.
struct Side {
  std::array<Index, 3> sorted;
  std::size_t tet;
  std::array<std::size_t, 3> corners;
};

struct EdgeCorner {
  std::array<Index, 2> sorted;
  std::size_t tet;
  std::array<std::size_t, 2> corners;
  double angle;
};

class Classes {
 public:
  explicit Classes(std::size_t size) : parent_(size) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) { parent_[root(a)] = root(b); }

 private:
  std::vector<std::size_t> parent_;
};

std::vector<Side> sidesOf(const TetMap& map) {
  constexpr std::array<std::array<std::size_t, 3>, 4> kFaces = {
      {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
  std::vector<Side> sides;
  for (std::size_t t = 0; t < map.tets.size(); ++t) {
    for (const auto& face : kFaces) {
      Side side{{map.tets[t][face[0]], map.tets[t][face[1]], map.tets[t][face[2]]}, t, face};
      std::sort(side.sorted.begin(), side.sorted.end());
      sides.push_back(side);
    }
  }
  std::stable_sort(sides.begin(), sides.end(),
                   [](const Side& a, const Side& b) { return a.sorted < b.sorted; });
  return sides;
}

std::vector<EdgeCorner> edgesOf(const TetMap& map) {
  std::vector<EdgeCorner> edges;
  for (std::size_t t = 0; t < map.tets.size(); ++t) {
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = a + 1; b < 4; ++b) {
        const std::size_t c = a != 0 ? 0 : (b != 1 ? 1 : 2);
        const std::size_t d = 6 - a - b - c;
        const TetParameters& p = map.parameters[t];
        const Vec3 along = minus(p[b], p[a]);
        const Vec3 n0 = cross(along, minus(p[c], p[a]));
        const Vec3 n1 = cross(along, minus(p[d], p[a]));
        const Vec3 turn = cross(n0, n1);
        EdgeCorner edge{{map.tets[t][a], map.tets[t][b]},
                        t,
                        {a, b},
                        std::atan2(std::sqrt(dot(turn, turn)), dot(n0, n1))};
        std::sort(edge.sorted.begin(), edge.sorted.end());
        edges.push_back(edge);
      }
    }
  }
  std::stable_sort(edges.begin(), edges.end(),
                   [](const EdgeCorner& a, const EdgeCorner& b) { return a.sorted < b.sorted; });
  return edges;
}

/// The smallest residual over all rotations and integer translations between three points and their
/// images.
double transitionResidual(const std::array<Vec3, 3>& from, const std::array<Vec3, 3>& to) {
  double best = std::numeric_limits<double>::infinity();
  std::array<std::size_t, 3> axes = {0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      std::array<Vec3, 3> columns{};
      for (std::size_t a = 0; a < 3; ++a) columns[a][axes[a]] = (signs >> a & 1) != 0 ? -1 : 1;
      if (dot(columns[0], cross(columns[1], columns[2])) < 0) continue;
      std::array<Vec3, 3> turned{};
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t a = 0; a < 3; ++a) {
          for (std::size_t k = 0; k < 3; ++k) turned[i][k] += columns[a][k] * from[i][a];
        }
      }
      double worst = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const double translation = std::round(to[0][k] - turned[0][k]);
        for (std::size_t i = 0; i < 3; ++i) {
          worst = std::max(worst, std::abs(turned[i][k] + translation - to[i][k]));
        }
      }
      best = std::min(best, worst);
      if (best == 0) return best;
    }
  } while (std::next_permutation(axes.begin(), axes.end()));
  return best;
}

void inspectTets(const TetMap& map, Inspection& found) {
  found.leastDeterminantInMap = std::numeric_limits<double>::infinity();
  found.leastDeterminantInSpace = std::numeric_limits<double>::infinity();
  std::vector<bool> used(map.points.size(), false);
  for (std::size_t t = 0; t < map.tets.size(); ++t) {
    const Tet& tet = map.tets[t];
    const TetParameters& p = map.parameters[t];
    const double inMap = determinant(p[0], p[1], p[2], p[3]);
    found.volume += inMap / 6;
    found.leastDeterminantInMap = std::min(found.leastDeterminantInMap, inMap);
    found.leastDeterminantInSpace = std::min(found.leastDeterminantInSpace,
                                             determinant(map.points[tet[0]], map.points[tet[1]],
                                                         map.points[tet[2]], map.points[tet[3]]));
    for (const Index vertex : tet) used[vertex] = true;
    for (const Vec3& corner : p) {
      found.integerCoordinates += static_cast<std::uint64_t>(
          std::count_if(corner.begin(), corner.end(), [](double x) { return toInteger(x) == 0; }));
    }
    if (std::set<Index>(tet.begin(), tet.end()).size() != 4) found.conforming = false;
  }
  if (std::find(used.begin(), used.end(), false) != used.end()) found.conforming = false;
}

void inspectInnerFace(const TetMap& map, const Side& a, const Side& b, Inspection& found) {
  ++found.innerFaces;
  std::array<Vec3, 3> from{};
  std::array<Vec3, 3> to{};
  std::array<std::size_t, 3> places{};
  for (std::size_t i = 0; i < 3; ++i) {
    from[i] = map.parameters[a.tet][a.corners[i]];
    for (std::size_t j = 0; j < 3; ++j) {
      if (map.tets[a.tet][a.corners[i]] != map.tets[b.tet][b.corners[j]]) continue;
      to[i] = map.parameters[b.tet][b.corners[j]];
      places[i] = j;
    }
  }
  if ((places[0] + 2) % 3 != places[1]) found.conforming = false;  // the same direction
  if (from != to) ++found.chartJumps;
  found.worstTransition = std::max(found.worstTransition, transitionResidual(from, to));
}

void inspectBoundaryFace(const TetMap& map, const Side& side, Inspection& found) {
  std::array<Vec3, 3> p{};
  for (std::size_t i = 0; i < 3; ++i) p[i] = map.parameters[side.tet][side.corners[i]];
  const Vec3 normal = cross(minus(p[1], p[0]), minus(p[2], p[0]));
  found.boundaryArea += std::sqrt(dot(normal, normal)) / 2;
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t a = 0; a < 3; ++a) {
    double worst = 0;
    for (const Vec3& corner : p) {
      worst = std::max(worst, std::abs(corner[a] - std::round(p[0][a])));
    }
    best = std::min(best, worst);
  }
  found.worstBoundary = std::max(found.worstBoundary, best);
}

/// Returns the edges of the boundary.
std::set<std::array<Index, 2>> inspectFaces(const TetMap& map, Inspection& found) {
  const std::vector<Side> sides = sidesOf(map);
  std::set<std::array<Index, 2>> boundaryEdges;
  Classes tets(map.tets.size());
  Classes surface(map.points.size());
  std::set<Index> surfaceVertices;
  std::int64_t faces = 0;
  for (std::size_t begin = 0; begin < sides.size();) {
    std::size_t end = begin;
    while (end < sides.size() && sides[end].sorted == sides[begin].sorted) ++end;
    ++faces;
    if (end - begin > 2) found.conforming = false;
    if (end - begin == 2) {
      inspectInnerFace(map, sides[begin], sides[begin + 1], found);
      tets.join(sides[begin].tet, sides[begin + 1].tet);
    }
    if (end - begin == 1) {
      inspectBoundaryFace(map, sides[begin], found);
      const auto& v = sides[begin].sorted;
      boundaryEdges.insert({{v[0], v[1]}, {v[0], v[2]}, {v[1], v[2]}});
      surface.join(v[0], v[1]);
      surface.join(v[0], v[2]);
      surfaceVertices.insert(v.begin(), v.end());
    }
    begin = end;
  }
  for (std::size_t t = 0; t < map.tets.size(); ++t) found.components += tets.root(t) == t ? 1 : 0;
  for (const Index v : surfaceVertices) found.boundaryComponents += surface.root(v) == v ? 1 : 0;
  found.eulerCharacteristic = static_cast<std::int64_t>(map.points.size()) + faces -
                              static_cast<std::int64_t>(map.tets.size());
  return boundaryEdges;
}

void inspectEdges(const TetMap& map, const std::set<std::array<Index, 2>>& boundaryEdges,
                  Inspection& found) {
  const std::vector<EdgeCorner> edges = edgesOf(map);
  for (std::size_t begin = 0; begin < edges.size();) {
    std::size_t end = begin;
    double angle = 0;
    while (end < edges.size() && edges[end].sorted == edges[begin].sorted)
      angle += edges[end++].angle;
    --found.eulerCharacteristic;
    const auto valence = static_cast<int>(std::round(angle / kRightAngle));
    found.worstAngle = std::max(found.worstAngle, std::abs(angle - valence * kRightAngle));
    const bool boundary = boundaryEdges.contains(edges[begin].sorted);
    if (valence != (boundary ? 2 : 4)) {
      const EdgeCorner& edge = edges[begin];
      const Vec3& from = map.parameters[edge.tet][edge.corners[0]];
      const Vec3 along = minus(map.parameters[edge.tet][edge.corners[1]], from);
      auto& lengths = boundary ? found.boundarySingularLength : found.innerSingularLength;
      lengths[valence] += std::sqrt(dot(along, along));
      std::array<double, 3> off{};
      for (std::size_t a = 0; a < 3; ++a) {
        off[a] = std::max(toInteger(from[a]), std::abs(along[a]));
      }
      // Two coordinates are constant integers; the largest distance is along the edge.
      std::sort(off.begin(), off.end());
      found.worstSingularity = std::max(found.worstSingularity, off[1]);
    }
    begin = end;
  }
}

}  // namespace

Inspection inspect(const TetMap& map) {
  Inspection found;
  inspectTets(map, found);
  inspectEdges(map, inspectFaces(map, found), found);
  return found;
}

}  // namespace hexhex::test
