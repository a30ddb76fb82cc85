#include <algorithm>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <adjacency/hex_topology.hpp>

#include <hexhex/error.hpp>
#include <hexhex/improve.hpp>

#include <base/parallel.hpp>
#include <base/vector3.hpp>
#include <improve/given_surface.hpp>
#include <improve/surface_distance.hpp>

namespace hexhex::improvement {

namespace {

constexpr std::size_t kGivenSurfaceGrain = 1024;
/// A curve or corner of the mesh is one of the surface within so many mean lengths of its edges:
/// nearer than the next vertex.
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
      if (v >= given.points.size() || !isFinite(given.points[v])) {
        throw Error(v < given.points.size() ? ErrorCode::NotFinite : ErrorCode::InvalidArgument,
                    "Triangle " + std::to_string(parts.triangles.size()) +
                        " of the surface names vertex " + std::to_string(v) +
                        ", which does not exist or is at no finite position. Correct the surface.",
                    Place{PlaceKind::Vertex, v, 0});
      }
    }
    parts.triangles.push_back({vertices, 0});
  }
  parts.boundaryTriangles = parts.triangles.size();
  return {std::move(parts), stage};
}

/// Per vertex: the mean length of its edges on the boundary, or 0 inside.
std::vector<double> edgeLengths(const Array<Vec3>& points, std::span<const Quad> quads) {
  std::vector<double> lengths(points.size(), 0);
  std::vector<double> counts(points.size(), 0);
  for (const Quad& quad : quads) {
    for (std::size_t i = 0; i < 4; ++i) {
      const Index next = quad[(i + 1) % 4];
      const double edge = length(minus(points[quad[i]], points[next]));
      for (const Index v : {quad[i], next}) {
        lengths[v] += edge;
        ++counts[v];
      }
    }
  }
  for (std::size_t v = 0; v < points.size(); ++v) lengths[v] /= std::max(1.0, counts[v]);
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
      "The mesh is not where the surface is: " + std::to_string(far) + " of " +
          std::to_string(outer) +
          " vertices of its boundary are farther from it than their edges are long, vertex " +
          std::to_string(worst) + " by " + std::to_string(distances[worst]) +
          ". Give the surface of the same object, in the same units, or none.",
      Place{PlaceKind::Vertex, worst, 0});
}

class Belonging {
 public:
  Belonging(const HexMesh& mesh, VertexPlaces& places, ReferenceSurface surface,
            std::vector<double> lengths)
      : mesh_(mesh),
        places_(places),
        surface_(std::move(surface)),
        lengths_(std::move(lengths)),
        triangles_(treeOf(surface_)) {}

  /// @return what the places are on now
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
    places_.isLoose[v] = 0;
  }
  /// Vertices inside are free, or on tagged faces, which stay.
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
      enter(v, Freedom::OnCurve, static_cast<Index>(nearest.triangle));
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

  [[nodiscard]] bool isOnLine(const Array<Freedom>& own, std::size_t v) const {
    return lengths_[v] > 0 && (own[v] == Freedom::OnCurve || own[v] == Freedom::Fixed);
  }

  const HexMesh& mesh_;
  VertexPlaces& places_;
  ReferenceSurface surface_;
  std::vector<double> lengths_;
  TriangleTree triangles_;
};

}  // namespace

VertexPlaces placesOnSurface(const HexMesh& mesh, const TriangleMesh& surface,
                             std::span<const std::uint8_t> isAtBad, double angle, Stage& stage) {
  VertexPlaces places = placesOnMesh(mesh, isAtBad, angle, stage);
  std::vector<double> lengths =
      edgeLengths(mesh.points, adjacency::quadsAt(mesh, adjacency::boundaryPlaces(mesh, stage)));
  Belonging belonging(mesh, places, surfaceOf(surface, angle, stage), std::move(lengths));
  places.surface = belonging.find(stage);
  places.tagged = 0;
  places.isGiven = true;
  return places;
}

}  // namespace hexhex::improvement
