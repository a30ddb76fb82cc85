#include <algorithm>
#include <compare>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <adjacency/corner_range.hpp>
#include <adjacency/hex_topology.hpp>
#include <adjacency/vertex_lists.hpp>

#include <hexhex/error.hpp>
#include <hexhex/patches.hpp>

#include <base/disjoint_sets.hpp>
#include <base/numbered_sets.hpp>
#include <base/parallel.hpp>
#include <base/vector3.hpp>
#include <mesh/smooth_patches.hpp>

namespace hexhex::mesh {

namespace {

/// Quads or vertices per block: some tenths of a millisecond.
constexpr std::size_t kSmoothPatchesGrain = 4096;

/// An edge as seen from a quad, or a seam. Its smaller vertex is known from the context.
struct EdgeSide {
  Index other;  ///< the larger vertex
  Index quad;   ///< kNone: a seam
  auto operator<=>(const EdgeSide&) const = default;
};

/// The edges of quads and the seams, by their smaller vertices.
adjacency::VertexLists<EdgeSide, std::uint64_t> listSides(std::size_t points,
                                                          std::span<const Quad> quads,
                                                          std::span<const FeatureEdge> seams,
                                                          Stage& stage) {
  return {points, stage, [&](const auto& add) {
            parallelFor(stage, quads.size(), kSmoothPatchesGrain, [&](std::size_t q) {
              for (std::size_t i = 0; i < 4; ++i) {
                const auto [low, high] = std::minmax(quads[q][i], quads[q][(i + 1) % 4]);
                if (low != high) add(low, EdgeSide{high, static_cast<Index>(q)});
              }
            });
            for (const FeatureEdge& seam : seams) {
              const auto [low, high] = std::minmax(seam.vertices[0], seam.vertices[1]);
              if (seam.tag != 0) add(low, EdgeSide{high, kNone});
            }
          }};
}

/// Unit normals; zero for quads without area.
Array<Vec3> normalsOf(std::span<const Vec3> points, std::span<const Quad> quads, Stage& stage) {
  Array<Vec3> normals(quads.size());
  parallelFor(stage, quads.size(), kSmoothPatchesGrain, [&](std::size_t q) {
    const Quad& quad = quads[q];
    Vec3 normal =
        cross(minus(points[quad[2]], points[quad[0]]), minus(points[quad[3]], points[quad[1]]));
    const double size = length(normal);
    for (double& component : normal) component = size > 0 ? component / size : 0;
    normals[q] = normal;
  });
  return normals;
}

}  // namespace

void requirePatchAngle(double angle) {
  if (angle >= 0 && angle <= 180) return;
  throw Error(ErrorCode::InvalidArgument, "The angle between patches is " + std::to_string(angle) +
                                              " degrees. Choose one from 0 to 180.");
}

SmoothPatches findSmoothPatches(std::span<const Vec3> points, std::span<const Quad> quads,
                                double angle, std::span<const FeatureEdge> seams, Stage& stage) {
  requirePatchAngle(angle);
  if (quads.size() >= kNone) {
    throw Error(ErrorCode::TooLarge, "The mesh has " + std::to_string(quads.size()) +
                                         " boundary quads, more than 32-bit indices can number.");
  }
  const double limit = leastCosine(angle * std::numbers::pi / 180);
  const Array<Vec3> normals = normalsOf(points, quads, stage);
  const adjacency::VertexLists<EdgeSide, std::uint64_t> sides =
      listSides(points.size(), quads, seams, stage);
  DisjointSets sets(quads.size());
  const auto isSameEdge = [](const EdgeSide& a, const EdgeSide& b) { return a.other == b.other; };
  const auto join = [&](std::span<const EdgeSide> atEdge) {
    // Exactly two quads and no seam, which would come last.
    if (atEdge.size() != 2 || atEdge[1].quad == kNone) return;
    const auto [a, b] = std::pair(atEdge[0].quad, atEdge[1].quad);
    if (dot(normals[a], normals[b]) >= limit) sets.unite(a, b);
  };
  parallelFor(stage, points.size(), kSmoothPatchesGrain,
              [&](std::size_t v) { adjacency::forEachRun(sides(v), isSameEdge, join); });
  NumberedSets patches = numberSets(sets, quads.size());
  return {std::move(patches.setOf), patches.count};
}

}  // namespace hexhex::mesh

namespace hexhex {

std::vector<FeatureQuad> boundaryPatches(const HexMesh& mesh, double angle, Context& context) {
  mesh::requirePatchAngle(angle);
  return inStage(context, "boundaryPatches", "patches", [&](Stage& stage) {
    std::vector<FeatureQuad> tagged;
    withThreads(context.threads(), [&] {
      adjacency::requireCornersInRange(mesh, stage);
      for (const FeatureEdge& edge : mesh.features.edges) {
        if (std::max(edge.vertices[0], edge.vertices[1]) < mesh.points.size()) continue;
        throw Error(ErrorCode::InvalidArgument,
                    "A feature edge names a vertex that is not one of the mesh.",
                    Place{PlaceKind::Edge, edge.vertices[0], edge.vertices[1]});
      }
      const Array<Quad> quads = adjacency::quadsAt(mesh, adjacency::boundaryPlaces(mesh, stage));
      const mesh::SmoothPatches patches =
          mesh::findSmoothPatches(mesh.points, quads, angle, mesh.features.edges, stage);
      tagged.resize(quads.size());
      for (std::size_t q = 0; q < quads.size(); ++q) {
        tagged[q] = {quads[q], static_cast<std::int32_t>(patches.patchOf[q] + 1)};
      }
    });
    return tagged;
  });
}

}  // namespace hexhex
