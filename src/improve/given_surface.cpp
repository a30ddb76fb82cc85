#include <algorithm>
#include <cstddef>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <adjacency/hex_topology.hpp>
#include <adjacency/vertex_lists.hpp>

#include <hexhex/error.hpp>
#include <hexhex/improve.hpp>

#include <base/concat.hpp>
#include <base/parallel.hpp>
#include <base/vector3.hpp>
#include <improve/given_surface.hpp>
#include <improve/surface_distance.hpp>

namespace hexhex::improvement {

namespace {

constexpr std::size_t kGivenSurfaceGrain = 1024;
/// Maximum distance between a curve or corner of the mesh and one of the surface, in mean edge
/// lengths: below that of the next vertex, as long as edges are similar in length.
constexpr double kReach = 0.5;

ReferenceSurface surfaceOf(const TriangleMesh& given, double angle, Stage& stage) {
  if (given.triangles.empty()) {
    throw Error(ErrorCode::EmptyMesh, "The surface has no triangles. Give one that has.");
  }
  SurfaceParts parts;
  parts.angle = angle;
  parts.points.assign(given.points.begin(), given.points.end());
  for (const std::array<Index, 3>& vertices : given.triangles) {
    for (const Index v : vertices) {
      if (v < given.points.size()) continue;
      throw Error(ErrorCode::InvalidArgument,
                  concat("Triangle ", parts.triangles.size(), " of the surface names vertex ", v,
                         ", which does not exist. Correct the surface."),
                  Place{PlaceKind::Vertex, v, 0});
    }
    parts.triangles.push_back({vertices, 0});
  }
  parts.boundaryTriangles = parts.triangles.size();
  return {std::move(parts), stage};
}

/// Per vertex: the mean length of its edges on the boundary, or 0 inside.
std::vector<double> edgeLengths(const Array<Vec3>& points,
                                const adjacency::VertexLists<Index>& beside) {
  std::vector<double> lengths(points.size(), 0);
  for (std::size_t v = 0; v < points.size(); ++v) {
    const std::span<const Index> others = beside(v);
    if (others.empty()) continue;
    for (const Index other : others) lengths[v] += length(minus(points[v], points[other]));
    lengths[v] = std::max(lengths[v] / static_cast<double>(others.size()),
                          std::numeric_limits<double>::min());
  }
  return lengths;
}

void requireNear(std::span<const double> distances, std::span<const double> lengths) {
  std::size_t outer = 0;
  std::size_t far = 0;
  Index worst = 0;
  for (Index v = 0; v < lengths.size(); ++v) {
    if (lengths[v] == 0) continue;
    ++outer;
    far += distances[v] > lengths[v] ? 1U : 0U;
    if (distances[v] > distances[worst]) worst = v;
  }
  if (10 * far <= outer) return;
  throw Error(
      ErrorCode::InvalidArgument,
      concat("The mesh is not where the surface is: ", far, " of ", outer,
             " vertices of its boundary are farther from it than their edges are long, vertex ",
             worst, " by ", distances[worst],
             ". Give the surface of the same object, in the same units, or none."),
      Place{PlaceKind::Vertex, worst, 0});
}

class Belonging {
 public:
  Belonging(const HexMesh& mesh, VertexPlaces& places, ReferenceSurface surface,
            adjacency::VertexLists<Index> beside)
      : mesh_(mesh),
        places_(places),
        surface_(std::move(surface)),
        beside_(std::move(beside)),
        lengths_(edgeLengths(mesh.points, beside_)),
        triangles_(treeOf(surface_)) {}

  /// @return the surface that places refer to now
  ReferenceSurface find(Stage& stage) {
    const Array<Freedom> own = places_.freedom;
    std::vector<double> distances(own.size(), 0);
    parallelFor(stage, own.size(), kGivenSurfaceGrain, [&](std::size_t v) {
      if (lengths_[v] == 0) {
        hold(v);
        return;
      }
      const TriangleTree::Nearest nearest = triangles_.nearest(mesh_.points[v]);
      distances[v] = nearest.distance;
      enter(v, Freedom::OnPatch, static_cast<Index>(nearest.triangle));
    });
    requireNear(distances, lengths_);
    takeCurves(own);
    takeCorners(own);
    return std::move(surface_);
  }

 private:
  void enter(std::size_t v, Freedom freedom, Index simplex) {
    places_.freedom[v] = freedom;
    places_.simplex[v] = simplex;
  }
  /// Vertices inside are free or, on tagged faces, fixed.
  void hold(std::size_t v) {
    if (places_.freedom[v] != Freedom::Free) enter(v, Freedom::Fixed, kNone);
  }

  void takeCurves(const Array<Freedom>& own) {
    std::vector<std::array<Vec3, 3>> segments;
    for (Index s = 0; s < surface_.segmentCount(); ++s) {
      const auto [a, b] = surface_.segment(s);
      segments.push_back({a, b, b});
    }
    const TriangleTree tree(segments);
    for (std::size_t v = 0; v < own.size(); ++v) {
      if (!isOnLine(own, v)) continue;
      const TriangleTree::Nearest nearest = tree.nearest(mesh_.points[v]);
      if (nearest.distance > kReach * lengths_[v]) continue;
      const auto segment = static_cast<Index>(nearest.triangle);
      if (isTaken(own, v, nearestOf(surface_.segment(segment), mesh_.points[v]))) continue;
      enter(v, Freedom::OnCurve, segment);
    }
  }

  void takeCorners(const Array<Freedom>& own) {
    std::vector<std::array<Vec3, 3>> corners;
    for (const Index c : surface_.corners()) {
      const Vec3& point = surface_.points()[c];
      corners.push_back({point, point, point});
    }
    const TriangleTree tree(corners);
    std::map<std::size_t, std::pair<double, std::size_t>> nearestOf;  // corner: distance, vertex
    for (std::size_t v = 0; v < own.size(); ++v) {
      if (!isOnLine(own, v)) continue;
      const TriangleTree::Nearest nearest = tree.nearest(mesh_.points[v]);
      if (nearest.distance > kReach * lengths_[v]) continue;
      const std::pair<double, std::size_t> candidate = {nearest.distance, v};
      const auto [entry, isNew] = nearestOf.emplace(nearest.triangle, candidate);
      if (!isNew) entry->second = std::min(entry->second, candidate);
    }
    for (const auto& [corner, vertex] : nearestOf) {
      enter(vertex.second, Freedom::Fixed, surface_.corners()[corner]);
    }
  }

  /// Whether a neighbour is much nearer to a place on a curve already, as where thin cells along a
  /// curve have lines of the mesh on both sides.
  [[nodiscard]] bool isTaken(const Array<Freedom>& own, std::size_t v, const Vec3& place) const {
    const double distance = length(minus(mesh_.points[v], place));
    return std::any_of(beside_(v).begin(), beside_(v).end(), [&](Index other) {
      return isOnLine(own, other) && length(minus(mesh_.points[other], place)) < kReach * distance;
    });
  }

  [[nodiscard]] bool isOnLine(const Array<Freedom>& own, std::size_t v) const {
    return lengths_[v] > 0 && (own[v] == Freedom::OnCurve || own[v] == Freedom::Fixed);
  }

  const HexMesh& mesh_;
  VertexPlaces& places_;
  ReferenceSurface surface_;
  adjacency::VertexLists<Index> beside_;
  std::vector<double> lengths_;
  TriangleTree triangles_;
};

}  // namespace

VertexPlaces placesOnSurface(const HexMesh& mesh, const TriangleMesh& surface,
                             std::span<const std::uint8_t> isAtBad, double angle, Stage& stage) {
  VertexPlaces places = placesOnMesh(mesh, isAtBad, angle, stage);
  const Array<Quad> quads = adjacency::quadsAt(mesh, adjacency::boundaryPlaces(mesh, stage));
  Belonging belonging(mesh, places, surfaceOf(surface, angle, stage),
                      adjacency::verticesBeside(quads, mesh.points.size(), stage));
  places.surface = belonging.find(stage);
  places.tagged = 0;  // those on tagged faces inside, unlike corners, have no simplex
  for (std::size_t v = 0; v < places.freedom.size(); ++v) {
    if (places.freedom[v] == Freedom::Fixed && places.simplex[v] == kNone) ++places.tagged;
  }
  places.isGiven = true;
  places.isOwn = false;
  return places;
}

}  // namespace hexhex::improvement
