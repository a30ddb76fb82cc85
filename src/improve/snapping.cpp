#include <algorithm>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include <adjacency/hex_topology.hpp>
#include <adjacency/vertex_lists.hpp>

#include <base/disjoint_sets.hpp>
#include <base/vector3.hpp>
#include <improve/curve_paths.hpp>
#include <improve/snapping.hpp>
#include <improve/vertex_energy.hpp>
#include <mesh/pillow.hpp>
#include <mesh/set_layers.hpp>

namespace hexhex::improvement {

namespace {

using Edge = std::array<Index, 2>;

/// Vertices within this number of edges of moved ones make room for them, in this number of rounds.
constexpr int kRoomRings = 3;
constexpr int kRoomRounds = 10;
/// A corner between two edges on paths is flat if it is wider than 120 degrees.
constexpr double kFlatCorner = -0.5;

/// Divides the boundary of a mesh into regions between paths.
class Regions {
 public:
  Regions(std::span<const Quad> quads, std::span<const Edge> paths)
      : quads_(quads), paths_(paths), sets_(quads.size()) {
    for (Index q = 0; q < quads.size(); ++q) {
      for (std::size_t i = 0; i < 4; ++i) {
        sides_.emplace_back(ascending(quads[q][i], quads[q][(i + 1) % 4]), q);
      }
    }
    std::sort(sides_.begin(), sides_.end());
    for (std::size_t i = 1; i < sides_.size(); ++i) {
      if (sides_[i].first != sides_[i - 1].first || isPath(sides_[i].first)) continue;
      sets_.unite(sides_[i].second, sides_[i - 1].second);
    }
  }

  [[nodiscard]] Index of(Index quad) { return sets_.find(quad); }
  [[nodiscard]] bool isPath(const Edge& edge) const {
    return std::binary_search(paths_.begin(), paths_.end(), edge);
  }
  /// Edges with their quads, sorted.
  [[nodiscard]] std::span<const std::pair<Edge, Index>> sides() const { return sides_; }

 private:
  std::span<const Quad> quads_;
  std::span<const Edge> paths_;
  std::vector<std::pair<Edge, Index>> sides_;
  DisjointSets sets_;
};

class CurveSnapper {
 public:
  CurveSnapper(HexMesh mesh, const Boundary& boundary, const VertexPlaces& places, CurvePaths paths,
               double angle, Stage& stage)
      : mesh_(std::move(mesh)),
        boundary_(boundary),
        places_(places),
        paths_(std::move(paths)),
        edges_(edgesOf(paths_)),
        regions_(boundary.quads, edges_),
        stage_(stage) {
    std::vector<Edge> segments;
    for (const CurvePath& path : paths_.paths) {
      segments.insert(segments.end(), path.segments.begin(), path.segments.end());
      ends_.push_back(path.vertices.front());
      ends_.push_back(path.vertices.back());
    }
    std::sort(ends_.begin(), ends_.end());
    places_.surface = places.surface.withCurves(std::move(segments), angle, stage);
  }

  /// Moves vertices of paths onto curves, and other boundary vertices onto the patches of their
  /// regions.
  void snap() {
    const Array<Vec3> before = mesh_.points;
    placeOnPatches();
    placeOnPaths();
    makeRoom(before);
  }

  /// @return nothing if no pillow is possible
  std::optional<Improved> layered(const ImproveReport& report) {
    mesh::Pillow pillow = mesh::addPillow(mesh_, {}, stage_);
    if (pillow.obstacle) return std::nullopt;
    const std::size_t cells = mesh_.cells.size();
    std::vector<Index> setOf(pillow.mesh.cells.size(), kNone);
    const std::vector<std::uint8_t> isIn = layerQuads();
    for (Index q = 0; q < isIn.size(); ++q) {
      if (isIn[q] != 0) setOf[cells + q] = regions_.of(q);
    }
    mesh::SetLayers layers = mesh::addSetLayers(pillow.mesh, setOf, stage_);
    Improved result{std::move(layers.mesh), {}, places_, {}, report};
    extend(result, pillow.mesh.points.size() - mesh_.points.size(), layers);
    result.boundary = Boundary(result.mesh, boundary_.surface, stage_);
    return result;
  }

 private:
  static std::vector<Edge> edgesOf(const CurvePaths& paths) {
    std::vector<Edge> edges;
    for (const CurvePath& path : paths.paths) {
      for (std::size_t i = 1; i < path.vertices.size(); ++i) {
        edges.push_back(ascending(path.vertices[i - 1], path.vertices[i]));
      }
    }
    std::sort(edges.begin(), edges.end());
    return edges;
  }

  /// Assigns to each region the patch that is nearest to most of its area.
  void findPatches() {
    std::map<Index, std::map<Index, double>> areas;
    for (Index q = 0; q < boundary_.quads.size(); ++q) {
      const Quad& quad = boundary_.quads[q];
      const std::array<Vec3, 4> corners = {mesh_.points[quad[0]], mesh_.points[quad[1]],
                                           mesh_.points[quad[2]], mesh_.points[quad[3]]};
      const auto nearest =
          static_cast<Index>(boundary_.surface.nearest(centreOf(corners)).triangle);
      areas[regions_.of(q)][places_.surface.patchOf(nearest)] +=
          length(cross(minus(corners[2], corners[0]), minus(corners[3], corners[1])));
    }
    for (const auto& [region, patches] : areas) {
      patchOf_[region] = std::max_element(patches.begin(), patches.end(), [](auto& a, auto& b) {
                           return a.second < b.second;
                         })->first;
    }
  }

  /// The nearest place on the patch of a region.
  [[nodiscard]] SurfacePlace placeOf(Index region, const Vec3& point) {
    Patch& patch = patches_[patchOf_.at(region)];
    if (!patch.tree) {
      std::vector<std::array<Vec3, 3>> corners;
      for (const Index t : patch.triangles) corners.push_back(places_.surface.triangle(t));
      patch.tree.emplace(corners);
    }
    const Index triangle = patch.triangles[patch.tree->nearest(point).triangle];
    return {nearestOf(places_.surface.triangle(triangle), point), triangle};
  }

  void placeOnPatches() {
    findPatches();
    for (Index t = 0; t < places_.surface.boundaryCount(); ++t) {
      patches_[places_.surface.patchOf(t)].triangles.push_back(t);
    }
    for (Index q = 0; q < boundary_.quads.size(); ++q) {
      for (const Index v : boundary_.quads[q]) {
        const SurfacePlace place = placeOf(regions_.of(q), mesh_.points[v]);
        places_.freedom[v] = Freedom::OnPatch;
        places_.isLoose[v] = false;
        places_.simplex[v] = place.simplex;
        mesh_.points[v] = place.point;
      }
    }
  }

  void placeOnPaths() {
    for (const CurvePath& path : paths_.paths) {
      for (std::size_t i = 0; i < path.vertices.size(); ++i) {
        const Index v = path.vertices[i];
        const PlaceOnCurve& place = path.places[i];
        const bool isPoint = place.segment[0] == place.segment[1];
        places_.freedom[v] = places_.surface.freedomAt(
            std::span(place.segment).first(isPoint ? 1 : 2), places_.simplex[v]);
        mesh_.points[v] = place.point;
      }
    }
  }

  /// Vertices that moved, and rings of vertices around them.
  [[nodiscard]] std::vector<Index> nearMoved(const Array<Vec3>& before,
                                             const adjacency::VertexLists<Index>& beside) const {
    std::vector<Index> near;
    std::vector<std::uint8_t> isNear(before.size(), 0);
    for (Index v = 0; v < before.size(); ++v) {
      if (mesh_.points[v] == before[v]) continue;
      near.push_back(v);
      isNear[v] = 1;
    }
    std::size_t begin = 0;
    for (int ring = 0; ring < kRoomRings; ++ring) {
      for (const std::size_t end = near.size(); begin < end; ++begin) {
        for (const Index v : beside(near[begin])) {
          if (std::exchange(isNear[v], 1) == 0) near.push_back(v);
        }
      }
    }
    return near;
  }

  /// Moves the vertices around to the averages of their neighbours; those on the boundary stay on
  /// it.
  void makeRoom(const Array<Vec3>& before) {
    const std::size_t n = mesh_.points.size();
    std::vector<std::uint8_t> isOuter(n, 0);
    std::vector<Edge> edges;
    for (const auto& [edge, quad] : regions_.sides()) {
      edges.push_back(edge);
      for (const Index v : edge) isOuter[v] = 1;
    }
    for (const Hex& cell : mesh_.cells) {
      for (const auto& [a, b] : adjacency::kHexEdges) edges.push_back(ascending(cell[a], cell[b]));
    }
    const auto beside = adjacency::verticesBeside(std::move(edges), n, stage_);
    const std::vector<Index> near = nearMoved(before, beside);
    for (int round = 0; round < kRoomRounds; ++round) {
      for (const Index v : near) {
        if (places_.freedom[v] != Freedom::Free && places_.freedom[v] != Freedom::OnPatch) continue;
        Vec3 sum{};
        double count = 0;
        for (const Index other : beside(v)) {
          if (isOuter[v] != 0 && isOuter[other] == 0) continue;
          sum = plus(sum, mesh_.points[other]);
          ++count;
        }
        const SurfacePlace place = places_.nearest(v, times(1 / count, sum));
        mesh_.points[v] = place.point;
        places_.simplex[v] = place.simplex;
      }
    }
  }

  /// Per quad: 1 if its cell gets a layer around it. These are the quads of regions with flat
  /// corners, except for those at ends of paths, whose corners would be halved: the fewer corners a
  /// layer has, the better are its cells. Those of a region are connected around each vertex.
  std::vector<std::uint8_t> layerQuads() {
    const Array<Quad>& quads = boundary_.quads;
    std::set<Index> wanted;  // regions
    for (Index q = 0; q < quads.size(); ++q) {
      if (hasFlatCorner(quads[q])) wanted.insert(regions_.of(q));
    }
    std::vector<std::uint8_t> isIn(quads.size(), 0);
    for (Index q = 0; q < quads.size(); ++q) {
      const bool isAtEnd =
          std::any_of(quads[q].begin(), quads[q].end(), [&](Index v) { return isEnd(v); });
      if (wanted.contains(regions_.of(q)) && (!isAtEnd || hasFlatCorner(quads[q]))) isIn[q] = 1;
    }
    const adjacency::VertexLists<Index> quadsAt(mesh_.points.size(), stage_, [&](const auto& add) {
      for (Index q = 0; q < quads.size(); ++q) {
        for (const Index v : quads[q]) add(v, q);
      }
    });
    while (connect(quadsAt, isIn)) {
    }
    return isIn;
  }

  /// Whether a quad has two edges on paths that hardly turn between them.
  [[nodiscard]] bool hasFlatCorner(const Quad& quad) const {
    for (std::size_t i = 0; i < 4; ++i) {
      const auto [last, v, next] =
          std::array<Index, 3>{quad[(i + 3) % 4], quad[i], quad[(i + 1) % 4]};
      if (!regions_.isPath(ascending(last, v)) || !regions_.isPath(ascending(v, next))) continue;
      const Vec3& point = mesh_.points[v];
      if (cosineBetween(minus(mesh_.points[last], point), minus(mesh_.points[next], point)) <
          kFlatCorner) {
        return true;
      }
    }
    return false;
  }

  [[nodiscard]] bool isEnd(Index v) const {
    return std::binary_search(ends_.begin(), ends_.end(), v);
  }

  /// Per vertex and region: number of edges between chosen quads of the region and other quads.
  [[nodiscard]] std::map<std::pair<Index, Index>, int> bordersAt(
      const std::vector<std::uint8_t>& isIn) {
    std::map<std::pair<Index, Index>, int> borders;
    const auto sides = regions_.sides();
    for (std::size_t i = 1; i < sides.size(); ++i) {
      if (sides[i].first != sides[i - 1].first) continue;
      const std::array<Index, 2> both = {sides[i - 1].second, sides[i].second};
      const bool isSame = regions_.of(both[0]) == regions_.of(both[1]);
      for (const std::size_t k : {0U, 1U}) {
        if (isIn[both[k]] == 0 || (isSame && isIn[both[1 - k]] != 0)) continue;
        for (const Index v : sides[i].first) ++borders[{v, regions_.of(both[k])}];
      }
    }
    return borders;
  }

  /// Connects the chosen quads of each region around each vertex.
  /// @return whether quads were added or removed
  bool connect(const adjacency::VertexLists<Index>& quadsAt, std::vector<std::uint8_t>& isIn) {
    bool isChanged = false;
    for (const auto& [where, count] : bordersAt(isIn)) {
      if (count <= 2) continue;
      bool isAdded = false;
      for (const Index q : quadsAt(where.first)) {
        if (regions_.of(q) == where.second && isIn[q] == 0) {
          isIn[q] = 1;
          isAdded = true;
        }
      }
      isChanged = true;
      if (isAdded) continue;
      // The region touches itself there: remove all of it.
      for (Index q = 0; q < isIn.size(); ++q) {
        if (regions_.of(q) == where.second) isIn[q] = 0;
      }
    }
    return isChanged;
  }

  /// Extends places to new vertices: copies of boundary vertices are on the patch of their region.
  void extend(Improved& result, std::size_t underneath, const mesh::SetLayers& layers) {
    VertexPlaces& places = result.places;
    places.freedom.resize(mesh_.points.size() + underneath, Freedom::Free);
    places.simplex.resize(places.freedom.size(), kNone);
    for (std::size_t i = 0; i < layers.originals.size(); ++i) {
      const bool isOuter = places.freedom[layers.originals[i]] != Freedom::Free;
      places.freedom.push_back(isOuter ? Freedom::OnPatch : Freedom::Free);
      Vec3& point = result.mesh.points[places.simplex.size()];
      const SurfacePlace place = isOuter ? placeOf(layers.sets[i], point) : SurfacePlace{point};
      point = place.point;
      places.simplex.push_back(place.simplex);
    }
    places.isLoose.resize(places.freedom.size(), false);
  }

  struct Patch {
    std::vector<Index> triangles;
    std::optional<TriangleTree> tree;  ///< built on first use
  };

  HexMesh mesh_;
  const Boundary& boundary_;
  VertexPlaces places_;
  CurvePaths paths_;
  std::vector<Edge> edges_;
  std::vector<Index> ends_;  ///< of paths, ascending
  Regions regions_;
  std::map<Index, Index> patchOf_;  ///< per region
  std::map<Index, Patch> patches_;
  Stage& stage_;
};

}  // namespace

std::optional<Improved> improvedWithCurves(const HexMesh& mesh, const Boundary& boundary,
                                           const VertexPlaces& places,
                                           const ImproveOptions& options,
                                           const ImproveReport& report, Context& context,
                                           Stage& stage) {
  if (!places.innerQuads.empty() || options.fixBoundary) return std::nullopt;
  CurvePaths paths = pathsAlongCurves(mesh.points, boundary.quads, places.surface, stage);
  if (paths.paths.empty()) return std::nullopt;
  const std::size_t snapped = paths.paths.size();
  CurveSnapper snapper(mesh, boundary, places, std::move(paths), options.featureAngle, stage);
  snapper.snap();
  std::optional<Improved> result = snapper.layered(report);
  if (!result) return std::nullopt;
  result->report.snappedCurves = snapped;
  // Layers start from the snapped mesh, so they may be as far from the surface as that one.
  result->report.distanceBefore =
      result->boundary.distanceTo(result->places, result->mesh.points, report.diagonal, stage)
          .largest;
  moveEnlarged(*result, mesh, options, context, stage);
  result->report.distanceBefore = report.distanceBefore;
  return result;
}

}  // namespace hexhex::improvement
