#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <base/disjoint_sets.hpp>
#include <base/parallel.hpp>
#include <base/sorted.hpp>
#include <base/vector3.hpp>
#include <improve/reference_surface.hpp>

namespace hexhex::improvement {

namespace {

constexpr std::size_t kReferenceSurfaceGrain = 4096;

/// Whether a triangle traverses an edge from its first vertex to its second.
bool passesForwards(const std::array<Index, 3>& triangle, const std::array<Index, 2>& edge) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (triangle[i] == edge[0] && triangle[(i + 1) % 3] == edge[1]) return true;
  }
  return false;
}

template <std::size_t n>
adjacency::VertexLists<Index> listAt(std::size_t points,
                                     const std::vector<std::array<Index, n>>& simplices,
                                     Stage& stage) {
  return {points, stage, [&](const auto& add) {
            for (std::size_t s = 0; s < simplices.size(); ++s) {
              for (const Index v : simplices[s]) add(v, static_cast<Index>(s));
            }
          }};
}

double squaredDistance(const Vec3& a, const Vec3& b) {
  const Vec3 d = minus(a, b);
  return dot(d, d);
}

/// Walks from simplex to simplex as long as a neighbour is nearer to the point and the place is
/// farther away than `enough`.
template <std::size_t n, class Corners, class Allowed>
SurfacePlace walk(const Vec3& point, Index start, double enough,
                  const std::vector<std::array<Index, n>>& simplices,
                  const adjacency::VertexLists<Index>& at, const Corners& cornersOf,
                  const Allowed& isAllowed) {
  SurfacePlace best{nearestOf(cornersOf(start), point), start};
  double distance = squaredDistance(best.point, point);
  for (bool moved = true; moved && distance > enough * enough;) {
    moved = false;
    for (const Index corner : simplices[best.simplex]) {
      if (!isAllowed(corner)) continue;
      for (const Index next : at(corner)) {
        if (!isAllowed(corner, next)) continue;
        const Vec3 nearest = nearestOf(cornersOf(next), point);
        const double other = squaredDistance(nearest, point);
        if (other >= distance) continue;
        best = {nearest, next};
        distance = other;
        moved = true;
      }
      if (moved) break;
    }
  }
  return best;
}

}  // namespace

Vec3 nearestOf(const std::array<Vec3, 2>& segment, const Vec3& point) noexcept {
  const Vec3 step = minus(segment[1], segment[0]);
  const double square = dot(step, step);
  const double share = square > 0 ? dot(minus(point, segment[0]), step) / square : 0;
  if (share <= 0) return segment[0];
  if (share >= 1) return segment[1];
  return plus(segment[0], times(share, step));
}

Vec3 nearestOf(const std::array<Vec3, 3>& t, const Vec3& point) noexcept {
  const Vec3 normal = normalOf(t);
  const double square = dot(normal, normal);
  bool inside = square > 0;
  for (std::size_t i = 0; i < 3 && inside; ++i) {
    inside = tripleProduct(normal, minus(t[(i + 1) % 3], t[i]), minus(point, t[i])) >= 0;
  }
  if (inside) return plus(point, times(-dot(minus(point, t[0]), normal) / square, normal));
  Vec3 best = t[0];
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 nearest = nearestOf(std::array<Vec3, 2>{t[i], t[(i + 1) % 3]}, point);
    if (squaredDistance(nearest, point) < squaredDistance(best, point)) best = nearest;
  }
  return best;
}

ReferenceSurface::ReferenceSurface(SurfaceParts parts, Stage& stage)
    : points_(std::move(parts.points)), boundaryTriangles_(parts.boundaryTriangles) {
  triangles_.reserve(parts.triangles.size());
  for (const FeatureFace& face : parts.triangles) {
    triangles_.push_back(face.vertices);
    taggedTriangles_.push_back(face.tag != 0);
  }
  findCurves(parts, stage);
  trianglesAt_ = listAt(points_.size(), triangles_, stage);
  segmentsAt_ = listAt(points_.size(), segments_, stage);
  findCorners(parts);
}

bool ReferenceSurface::isCurve(const std::array<Index, 2>& vertices, std::span<const Index> around,
                               const SurfaceParts& parts, double limit) const {
  if (around.size() != 2) return true;
  const auto [a, b] = std::pair(around[0], around[1]);
  if (parts.triangles[a].tag != parts.triangles[b].tag) return true;
  if (parts.sharp) return std::binary_search(parts.sharp->begin(), parts.sharp->end(), vertices);
  if (!parts.groups.empty() && parts.groups[a] == parts.groups[b]) return false;
  // Inner triangles and those of a given surface may face either way.
  const bool isTurned =
      passesForwards(triangles_[a], vertices) == passesForwards(triangles_[b], vertices);
  const Vec3 normal = normalOf(triangle(b));
  return cosineBetween(normalOf(triangle(a)), isTurned ? times(-1, normal) : normal) < limit;
}

void ReferenceSurface::findCurves(const SurfaceParts& parts, Stage& stage) {
  for (const std::array<Index, 2>& curve : parts.curves) {
    segments_.push_back(ascending(curve[0], curve[1]));
  }
  sortUnique(segments_);
  const std::vector<std::array<Index, 2>> given = segments_;
  const double limit = leastCosine(parts.angle * std::numbers::pi / 180);
  DisjointSets sets(triangles_.size());
  DisjointSets setsWithCreases(triangles_.size());
  std::vector<std::array<Index, 2>> creases;
  forEachEdge(
      parts.triangles, [&](const std::array<Index, 2>& vertices, std::span<const Index> around) {
        const bool isGiven = std::binary_search(given.begin(), given.end(), vertices);
        const bool goesOn = around.size() == 2 &&
                            parts.triangles[around[0]].tag == parts.triangles[around[1]].tag &&
                            !(isGiven && parts.areTagged);
        if (goesOn) setsWithCreases.unite(around[0], around[1]);
        if (!isGiven && !isCurve(vertices, around, parts, limit)) {
          sets.unite(around[0], around[1]);
          return;
        }
        if (!isGiven) segments_.push_back(vertices);
        if (goesOn) creases.push_back(vertices);
      });
  std::sort(segments_.begin(), segments_.end());
  for (const std::array<Index, 2>& segment : segments_) {
    taggedSegments_.push_back(parts.areTagged &&
                              std::binary_search(given.begin(), given.end(), segment));
    creases_.push_back(std::binary_search(creases.begin(), creases.end(), segment));
  }
  patches_.resize(triangles_.size());
  withCreases_.resize(triangles_.size());
  parallelFor(stage, triangles_.size(), kReferenceSurfaceGrain, [&](std::size_t t) {
    patches_[t] = sets.find(static_cast<Index>(t));
    withCreases_[t] = setsWithCreases.find(static_cast<Index>(t));
  });
}

void ReferenceSurface::findCorners(const SurfaceParts& parts) {
  corners_ = parts.corners;
  taggedCorners_ = parts.corners;
  std::sort(taggedCorners_.begin(), taggedCorners_.end());
  const double limit = leastCosine(parts.angle * std::numbers::pi / 180);
  for (std::size_t v = 0; v < points_.size(); ++v) {
    const std::span<const Index> at = segmentsAt_(v);
    if (at.empty()) continue;
    bool isCorner = at.size() != 2;
    if (!isCorner) {
      std::array<Vec3, 2> steps{};
      for (std::size_t i = 0; i < 2; ++i) {
        const std::array<Index, 2>& s = segments_[at[i]];
        steps[i] = minus(points_[s[0] == v ? s[1] : s[0]], points_[v]);
      }
      isCorner = -cosineBetween(steps[0], steps[1]) < limit;
    }
    if (isCorner) corners_.push_back(static_cast<Index>(v));
  }
  sortUnique(corners_);
}

ReferenceSurface ReferenceSurface::withCurves(std::vector<std::array<Index, 2>> sharp, double angle,
                                              Stage& stage) const {
  SurfaceParts parts;
  parts.points = points_;
  for (const std::array<Index, 3>& vertices : triangles_) parts.triangles.push_back({vertices, 0});
  parts.boundaryTriangles = boundaryTriangles_;
  parts.corners = taggedCorners_;
  parts.angle = angle;
  std::sort(sharp.begin(), sharp.end());
  parts.sharp = std::move(sharp);
  return {std::move(parts), stage};
}

std::array<Vec3, 3> ReferenceSurface::triangle(Index t) const noexcept {
  const auto& [a, b, c] = triangles_[t];
  return {points_[a], points_[b], points_[c]};
}
std::array<Vec3, 2> ReferenceSurface::segment(Index s) const noexcept {
  return {points_[segments_[s][0]], points_[segments_[s][1]]};
}

Freedom ReferenceSurface::freedomAt(std::span<const Index> corners, Index& simplex) const {
  const auto holdsAll = [&](const auto& candidate) {
    return std::all_of(corners.begin(), corners.end(), [&](Index c) {
      return std::find(candidate.begin(), candidate.end(), c) != candidate.end();
    });
  };
  if (corners.size() == 1 && std::binary_search(corners_.begin(), corners_.end(), corners[0])) {
    simplex = corners[0];
    return Freedom::Fixed;
  }
  for (const Index s : segmentsAt_(corners[0])) {
    if (!holdsAll(segments_[s])) continue;
    simplex = s;
    return Freedom::OnCurve;
  }
  for (const Index t : trianglesAt_(corners[0])) {
    if (!holdsAll(triangles_[t])) continue;
    simplex = t;
    return Freedom::OnPatch;
  }
  return Freedom::Free;
}

bool ReferenceSurface::isCrease(Freedom freedom, Index simplex) const {
  if (simplex == kNone) return false;
  if (freedom == Freedom::OnCurve) return creases_[simplex];
  if (freedom != Freedom::Fixed) return false;
  const std::span<const Index> at = segmentsAt_(simplex);
  return !isTagged(freedom, simplex) &&
         std::all_of(at.begin(), at.end(), [this](Index s) { return creases_[s]; });
}

bool ReferenceSurface::isFading(Freedom freedom, Index simplex) const {
  if (!isCrease(freedom, simplex)) return false;
  if (freedom == Freedom::Fixed) return segmentsAt(simplex).size() == 1;
  for (const Index start : segments_[simplex]) {
    Index point = start;
    Index segment = simplex;
    std::span<const Index> at = segmentsAt(point);
    while (at.size() == 2) {
      segment = at[0] == segment ? at[1] : at[0];
      if (segment == simplex) return false;  // a loop
      const auto& [a, b] = segments_[segment];
      point = a == point ? b : a;
      at = segmentsAt(point);
    }
    if (at.size() == 1 && !isTagged(Freedom::Fixed, point)) return true;
  }
  return false;
}

Index ReferenceSurface::triangleAt(Freedom freedom, Index simplex, const Vec3& point) const {
  const bool isCorner = freedom == Freedom::Fixed;
  const std::array<Index, 2> ends =
      isCorner ? std::array<Index, 2>{simplex, simplex} : segments_[simplex];
  Index best = kNone;
  double least = std::numeric_limits<double>::infinity();
  for (const Index t : trianglesAt_(ends[0])) {
    if (std::find(triangles_[t].begin(), triangles_[t].end(), ends[1]) == triangles_[t].end()) {
      continue;
    }
    const double distance = squaredDistance(nearestOf(triangle(t), point), point);
    if (distance >= least) continue;
    best = t;
    least = distance;
  }
  return best;
}

SurfacePlace ReferenceSurface::onTriangles(const Vec3& point, Index triangle,
                                           const std::vector<Index>& sets, double enough) const {
  struct Allowed {
    const std::vector<Index>& sets;
    Index set;
    bool operator()(Index /*corner*/) const { return true; }
    bool operator()(Index /*corner*/, Index next) const { return sets[next] == set; }
  };
  return walk(
      point, triangle, enough, triangles_, trianglesAt_,
      [this](Index t) { return this->triangle(t); }, Allowed{sets, sets[triangle]});
}

SurfacePlace ReferenceSurface::onPatch(const Vec3& point, Index triangle, double enough) const {
  return onTriangles(point, triangle, patches_, enough);
}

SurfacePlace ReferenceSurface::acrossCreases(const Vec3& point, Index triangle,
                                             double enough) const {
  return onTriangles(point, triangle, withCreases_, enough);
}

SurfacePlace ReferenceSurface::onCurve(const Vec3& point, Index segment) const {
  struct Allowed {
    const std::vector<Index>& corners;
    bool operator()(Index corner) const {
      return !std::binary_search(corners.begin(), corners.end(), corner);
    }
    bool operator()(Index /*corner*/, Index /*next*/) const { return true; }
  };
  return walk(
      point, segment, 0, segments_, segmentsAt_, [this](Index s) { return this->segment(s); },
      Allowed{corners_});
}

}  // namespace hexhex::improvement
