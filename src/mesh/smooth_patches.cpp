#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <adjacency/boundary_quads.hpp>
#include <adjacency/vertex_cells.hpp>

#include <hexhex/error.hpp>
#include <hexhex/patches.hpp>

#include <base/disjoint_sets.hpp>
#include <base/parallel.hpp>
#include <base/vector3.hpp>
#include <mesh/smooth_patches.hpp>

namespace hexhex {

namespace {

/// Quads, or vertices, per block: some tenths of a millisecond.
constexpr std::size_t kGrain = 4096;

/// Normals of flat neighbours differ by rounding; 1e-12 of a cosine is a turn of a millionth, far
/// above rounding and far below any turn that is meant.
constexpr double kCosineError = 1e-12;

/// An edge seen from a quad, or a seam. Its smaller vertex is known from the context.
struct Side {
  Index other;  ///< the larger vertex
  Index quad;   ///< kNone: a seam
};

/// The edges of quads and the seams, by their smaller vertices.
class Sides {
 public:
  Sides(std::size_t points, std::span<const Quad> quads, std::span<const FeatureEdge> seams)
      : begins_(points + 1) {
    std::fill(begins_.begin(), begins_.end(), std::uint64_t{0});
    forEach(quads, seams, [this](Index vertex, const Side&) { ++begins_[vertex]; });
    sides_.resize(exclusiveScan(std::span(begins_)));
    forEach(quads, seams, [this](Index vertex, const Side& side) {
      sides_[begins_[vertex]++] = side;  // begins_[v] becomes the end of v
    });
  }

  /// Those of one vertex, for one thread to sort.
  [[nodiscard]] std::span<Side> at(std::size_t vertex) noexcept {
    const std::uint64_t begin = vertex == 0 ? 0 : begins_[vertex - 1];
    return std::span(sides_).subspan(begin, begins_[vertex] - begin);
  }

 private:
  template <class Visit>
  static void forEach(std::span<const Quad> quads, std::span<const FeatureEdge> seams,
                      const Visit& visit) {
    for (std::size_t q = 0; q < quads.size(); ++q) {
      for (std::size_t i = 0; i < 4; ++i) {
        const auto [low, high] = std::minmax(quads[q][i], quads[q][(i + 1) % 4]);
        visit(low, Side{high, static_cast<Index>(q)});
      }
    }
    for (const FeatureEdge& seam : seams) {
      const auto [low, high] = std::minmax(seam.vertices[0], seam.vertices[1]);
      if (seam.tag != 0) visit(low, Side{high, kNone});
    }
  }

  Array<std::uint64_t> begins_;
  Array<Side> sides_;
};

/// Unit normals; zero for quads without area.
Array<Vec3> normalsOf(std::span<const Vec3> points, std::span<const Quad> quads, Stage& stage) {
  Array<Vec3> normals(quads.size());
  parallelFor(stage, quads.size(), kGrain, [&](std::size_t q) {
    const Quad& quad = quads[q];
    Vec3 normal =
        cross(minus(points[quad[2]], points[quad[0]]), minus(points[quad[3]], points[quad[1]]));
    const double size = length(normal);
    for (double& component : normal) component = size > 0 ? component / size : 0;
    normals[q] = normal;
  });
  return normals;
}

/// Numbers the sets in order of their smallest elements.
SmoothPatches numbered(DisjointSets& sets, std::size_t quads) {
  SmoothPatches patches;
  patches.patchOf.resize(quads);
  for (std::size_t q = 0; q < quads; ++q) {
    const Index first = sets.find(static_cast<Index>(q));
    patches.patchOf[q] = first == q ? patches.count++ : patches.patchOf[first];
  }
  return patches;
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
  const double limit = std::cos(angle * std::numbers::pi / 180) - kCosineError;
  const Array<Vec3> normals = normalsOf(points, quads, stage);
  Sides sides(points.size(), quads, seams);
  DisjointSets sets(quads.size());
  parallelFor(stage, points.size(), kGrain, [&](std::size_t v) {
    const std::span<Side> all = sides.at(v);
    std::sort(all.begin(), all.end(),
              [](const Side& a, const Side& b) { return a.other < b.other; });
    for (std::size_t i = 0; i < all.size();) {
      std::size_t end = i + 1;
      while (end < all.size() && all[end].other == all[i].other) ++end;
      const Index a = all[i].quad;
      const Index b = all[end - 1].quad;
      // Exactly two quads and no seam.
      const bool joins = end - i == 2 && a != kNone && b != kNone;
      if (joins && dot(normals[a], normals[b]) >= limit) sets.unite(a, b);
      i = end;
    }
  });
  return numbered(sets, quads.size());
}

std::vector<FeatureQuad> boundaryPatches(const HexMesh& mesh, double angle, Context& context) {
  requirePatchAngle(angle);
  Stage stage(context, "patches");
  std::vector<FeatureQuad> tagged;
  withThreads(context.threads(), [&] {
    requireCornersInRange(mesh, stage);
    for (const FeatureEdge& edge : mesh.features.edges) {
      if (std::max(edge.vertices[0], edge.vertices[1]) < mesh.points.size()) continue;
      throw Error(ErrorCode::InvalidArgument,
                  "A feature edge names a vertex that is not one of the mesh.",
                  Place{PlaceKind::Edge, edge.vertices[0], edge.vertices[1]});
    }
    const Array<Quad> quads = boundaryQuads(mesh, stage);
    const SmoothPatches patches =
        findSmoothPatches(mesh.points, quads, angle, mesh.features.edges, stage);
    tagged.resize(quads.size());
    for (std::size_t q = 0; q < quads.size(); ++q) {
      tagged[q] = {quads[q], static_cast<std::int32_t>(patches.patchOf[q] + 1)};
    }
  });
  return tagged;
}

}  // namespace hexhex
