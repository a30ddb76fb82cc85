#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include <adjacency/hex_topology.hpp>

#include <base/parallel.hpp>
#include <base/sorted.hpp>
#include <base/vector3.hpp>
#include <mesh/pillow.hpp>

namespace hexhex::mesh {

namespace {

constexpr std::size_t kPillowGrain = 2048;

/// Fraction of the way to the other end of an edge: the layer takes a quarter of the cells beneath.
constexpr double kPillowDepth = 0.25;

using Edge = std::array<Index, 2>;

Edge edgeOf(const Quad& quad, std::size_t i) {
  return adjacency::ascending(quad[i], quad[(i + 1) % 4]);
}

template <class T>
bool isIn(const std::vector<T>& sorted, const T& value) {
  return std::binary_search(sorted.begin(), sorted.end(), value);
}

Error obstacleAt(ErrorCode code, const Edge& edge, const char* what) {
  return {code,
          "A layer of cells under the boundary cannot pass edge " + std::to_string(edge[0]) + "-" +
              std::to_string(edge[1]) + ": " + what + ". Improve without a pillow.",
          Place{PlaceKind::Edge, edge[0], edge[1]}};
}

constexpr const char* kNarrow = "an inner face or curve is there only one cell wide";

Error obstacleAt(Index vertex, const char* what) {
  return {ErrorCode::InvalidArgument,
          "A layer of cells under the boundary cannot pass vertex " + std::to_string(vertex) +
              ": " + what + ". Improve without a pillow.",
          Place{PlaceKind::Vertex, vertex, 0}};
}

/// An edge from the boundary inward along which the layer must keep something attached.
struct Inward {
  Index vertex;  ///< on the boundary
  Index other;
  bool isCurve;  ///< is tagged, or has a number of walls other than two
  auto operator<=>(const Inward&) const = default;
};

class PillowMaker {
 public:
  PillowMaker(const HexMesh& mesh, std::span<const Quad> walls, Stage& stage)
      : mesh_(mesh),
        walls_(walls),
        stage_(stage),
        places_(adjacency::boundaryPlaces(mesh, stage)),
        quads_(adjacency::quadsAt(mesh, places_)),
        innerOf_(mesh.points.size(), kNone) {}

  Pillow make() {
    Pillow pillow;
    numberVertices();
    pillow.obstacle = findEdges();
    if (!pillow.obstacle) pillow.obstacle = findWallEdges();
    if (!pillow.obstacle) pillow.obstacle = findLeaders(pillow.leaders);
    if (pillow.obstacle) {
      pillow.leaders.clear();
      return pillow;
    }
    pillow.mesh = mesh_;
    addPoints(pillow);
    addCells(pillow.mesh);
    for (const Quad& wall : walls_) addWall(wall, pillow.walls);
    addTags(pillow.mesh.features);
    return pillow;
  }

 private:
  [[nodiscard]] bool isOuter(Index v) const { return innerOf_[v] != kNone; }
  [[nodiscard]] Index innerOf(Index v) const { return isOuter(v) ? innerOf_[v] : v; }
  [[nodiscard]] bool isOuter(const Edge& edge) const { return isIn(edges_, edge); }

  void numberVertices() {
    for (const Quad& quad : quads_) outer_.insert(outer_.end(), quad.begin(), quad.end());
    sortUnique(outer_);
    const std::size_t n = mesh_.points.size();
    if (n + outer_.size() >= kNone || mesh_.cells.size() + quads_.size() >= kNone) {
      throw Error(ErrorCode::TooLarge,
                  "With a layer of cells, the mesh has more than 32-bit indices can number.");
    }
    for (const Index v : outer_) innerOf_[v] = static_cast<Index>(n + count_++);
  }

  std::optional<Error> findEdges() {
    for (const Quad& quad : quads_) {
      for (std::size_t i = 0; i < 4; ++i) edges_.push_back(edgeOf(quad, i));
    }
    std::sort(edges_.begin(), edges_.end());
    std::optional<Error> obstacle;
    adjacency::forEachRun(std::span<const Edge>(edges_), std::equal_to<>(), [&](const auto& run) {
      if (run.size() == 2 || obstacle) return;
      obstacle = obstacleAt(ErrorCode::NonManifoldEdge, run[0],
                            "it has other than two quads of the boundary");
    });
    edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
    return obstacle;
  }

  /// Boundary edges where a wall begins: the layer has a wall there, too.
  std::optional<Error> findWallEdges() {
    for (const Quad& wall : walls_) {
      for (std::size_t i = 0; i < 4; ++i) {
        if (isOuter(edgeOf(wall, i))) wallEdges_.push_back(edgeOf(wall, i));
      }
    }
    std::sort(wallEdges_.begin(), wallEdges_.end());
    const auto twice = std::adjacent_find(wallEdges_.begin(), wallEdges_.end());
    if (twice != wallEdges_.end()) {
      return obstacleAt(ErrorCode::InvalidArgument, *twice,
                        "several inner faces with tags, or between regions, meet the boundary "
                        "there");
    }
    std::vector<Index> ends;
    for (const Edge& edge : wallEdges_) ends.insert(ends.end(), edge.begin(), edge.end());
    std::sort(ends.begin(), ends.end());
    for (const Quad& wall : walls_) {
      for (const Index v : wall) {
        if (isOuter(v) && !isIn(ends, v)) {
          return obstacleAt(v,
                            "an inner face with a tag, or between regions, has no other vertex "
                            "on the boundary there");
        }
      }
    }
    return std::nullopt;
  }

  [[nodiscard]] std::vector<Inward> inwardEdges() const {
    std::vector<Edge> atWalls;
    for (const Quad& wall : walls_) {
      for (std::size_t i = 0; i < 4; ++i) {
        const Edge edge = edgeOf(wall, i);
        if ((isOuter(edge[0]) || isOuter(edge[1])) && !isOuter(edge)) atWalls.push_back(edge);
      }
    }
    std::sort(atWalls.begin(), atWalls.end());
    std::vector<Inward> inward;
    const auto add = [&](const Edge& edge, bool isCurve) {
      if (isOuter(edge[0])) inward.push_back({edge[0], edge[1], isCurve});
      if (isOuter(edge[1])) inward.push_back({edge[1], edge[0], isCurve});
    };
    adjacency::forEachRun(std::span<const Edge>(atWalls), std::equal_to<>(),
                          [&](const auto& run) { add(run[0], run.size() != 2); });
    for (const FeatureEdge& feature : mesh_.features.edges) {
      const Edge edge = adjacency::ascending(feature.vertices[0], feature.vertices[1]);
      if (feature.tag != 0 && !isOuter(edge)) add(edge, true);
    }
    std::sort(inward.begin(), inward.end());
    return inward;
  }

  /// Leaders of the vertices from which curves or walls go inward.
  std::optional<Error> findLeaders(Array<Index>& leaders) const {
    leaders.assign(count_, kNone);
    const std::vector<Inward> inward = inwardEdges();
    std::optional<Error> obstacle;
    const auto isSameVertex = [](const Inward& a, const Inward& b) { return a.vertex == b.vertex; };
    adjacency::forEachRun(std::span<const Inward>(inward), isSameVertex, [&](const auto& run) {
      Index curve = kNone;
      Index wall = kNone;
      const Index v = run[0].vertex;
      for (const Inward& edge : run) {
        if (edge.isCurve && curve != kNone && curve != edge.other) {
          obstacle = obstacleAt(v, "several curves inside meet there");
        }
        if (edge.isCurve) curve = edge.other;
        if (!isOuter(edge.other)) wall = edge.other;
      }
      const Index leader = curve != kNone ? curve : wall;
      if (leader == kNone || isOuter(leader)) {
        obstacle = obstacleAt(v, kNarrow);
      }
      leaders[innerOf_[v] - mesh_.points.size()] = leader;
    });
    if (!obstacle) obstacle = leadFromCorners(leaders);
    return obstacle;
  }

  /// At a corner of a wall with both edges on the boundary, the opposite corner leads.
  std::optional<Error> leadFromCorners(Array<Index>& leaders) const {
    for (const Quad& wall : walls_) {
      for (std::size_t i = 0; i < 4; ++i) {
        if (!isOuter(edgeOf(wall, i)) || !isOuter(edgeOf(wall, (i + 3) % 4))) continue;
        const Index across = wall[(i + 2) % 4];
        if (isOuter(across)) return obstacleAt(wall[i], kNarrow);
        Index& leader = leaders[innerOf_[wall[i]] - mesh_.points.size()];
        if (leader == kNone) leader = across;
      }
    }
    return std::nullopt;
  }

  /// Position of a new vertex: halfway to the mean of the cells' centres, which is inside wherever
  /// the boundary turns; beside curves and walls, along them.
  [[nodiscard]] Vec3 placeUnder(Index v, Index leader, std::span<const Index> cells) const {
    const Vec3& point = mesh_.points[v];
    Vec3 step{};
    if (leader != kNone) {
      step = minus(mesh_.points[leader], point);
    } else {
      for (const Index cell : cells) {
        for (const Index corner : mesh_.cells[cell]) {
          const Vec3 way = minus(mesh_.points[corner], point);
          for (std::size_t k = 0; k < 3; ++k) {
            step[k] += 2 * way[k] / static_cast<double>(8 * cells.size());
          }
        }
      }
    }
    return {point[0] + kPillowDepth * step[0], point[1] + kPillowDepth * step[1],
            point[2] + kPillowDepth * step[2]};
  }

  void addPoints(Pillow& pillow) const {
    HexMesh& mesh = pillow.mesh;
    const adjacency::VertexCells around = adjacency::cellsAroundVertices(mesh_, stage_);
    const std::size_t n = mesh_.points.size();
    mesh.points.resize(n + count_);
    parallelFor(stage_, count_, kPillowGrain, [&](std::size_t i) {
      mesh.points[n + i] = placeUnder(outer_[i], pillow.leaders[i], around(outer_[i]));
    });
    if (mesh_.generatorTet.size() != n || mesh_.generatorCorners.size() != n) return;
    constexpr CornerSet kWholeTet = 15;
    for (std::size_t i = 0; i < count_; ++i) {
      const Index leader = pillow.leaders[i];
      mesh.generatorTet.push_back(mesh_.generatorTet[leader != kNone ? leader : outer_[i]]);
      mesh.generatorCorners.push_back(leader != kNone ? mesh_.generatorCorners[leader] : kWholeTet);
    }
  }

  void addCells(HexMesh& mesh) const {
    for (Hex& cell : mesh.cells) {
      for (Index& v : cell) v = innerOf(v);
    }
    const bool hasRegions = mesh_.regions.size() == mesh_.cells.size();
    for (std::size_t q = 0; q < quads_.size(); ++q) {
      const Quad& quad = quads_[q];  // faces outward: it is the upper side
      Hex cell{};
      for (std::size_t i = 0; i < 4; ++i) {
        cell[i] = innerOf_[quad[i]];
        cell[i + 4] = quad[i];
      }
      mesh.cells.push_back(cell);
      if (hasRegions) mesh.regions.push_back(mesh_.regions[places_[q] / 8]);
    }
  }

  /// A wall in its new place, and its continuation through the layer.
  void addWall(const Quad& wall, std::vector<Quad>& walls) const {
    walls.push_back({innerOf(wall[0]), innerOf(wall[1]), innerOf(wall[2]), innerOf(wall[3])});
    for (std::size_t i = 0; i < 4; ++i) {
      const Edge edge = edgeOf(wall, i);
      if (isOuter(edge)) walls.push_back({edge[0], edge[1], innerOf_[edge[1]], innerOf_[edge[0]]});
    }
  }

  void addTags(HexFeatures& features) const {
    std::vector<Quad> boundary;
    for (const Quad& quad : quads_) boundary.push_back(adjacency::ascending(quad));
    std::sort(boundary.begin(), boundary.end());
    std::vector<Quad> walls;
    std::vector<FeatureQuad> quads;
    for (const FeatureQuad& quad : features.quads) {
      walls.clear();
      if (isIn(boundary, adjacency::ascending(quad.vertices))) {
        walls.push_back(quad.vertices);
      } else {
        addWall(quad.vertices, walls);
      }
      for (const Quad& wall : walls) quads.push_back({wall, quad.tag});
    }
    features.quads = std::move(quads);
    std::vector<FeatureEdge> edges;
    for (const FeatureEdge& edge : features.edges) {
      const auto [a, b] = edge.vertices;
      if (isOuter(adjacency::ascending(a, b))) {
        edges.push_back(edge);
        continue;
      }
      edges.push_back({{innerOf(a), innerOf(b)}, edge.tag});
      for (const Index v : edge.vertices) {
        if (isOuter(v)) edges.push_back({{v, innerOf_[v]}, edge.tag});
      }
    }
    features.edges = std::move(edges);
  }

  const HexMesh& mesh_;
  std::span<const Quad> walls_;
  Stage& stage_;
  std::vector<std::uint64_t> places_;  ///< as of boundaryPlaces()
  Array<Quad> quads_;
  Array<Index> innerOf_;      ///< per boundary vertex: the new one beneath
  std::vector<Index> outer_;  ///< per new vertex: the one on the boundary
  std::size_t count_ = 0;     ///< number of new vertices
  std::vector<Edge> edges_;   ///< of the boundary, ascending
  std::vector<Edge> wallEdges_;
};

}  // namespace

Pillow addPillow(const HexMesh& mesh, std::span<const Quad> walls, Stage& stage) {
  return PillowMaker(mesh, walls, stage).make();
}

}  // namespace hexhex::mesh
