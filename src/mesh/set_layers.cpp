#include <algorithm>
#include <array>
#include <functional>
#include <vector>

#include <adjacency/hex_topology.hpp>

#include <base/sorted.hpp>
#include <base/vector3.hpp>
#include <mesh/set_layers.hpp>

namespace hexhex::mesh {

namespace {

/// Fraction of the way to the mean of the set's cells around it by which a copy is moved.
constexpr double kLayerDepth = 0.25;

/// A vertex as the cells of a set use it.
struct Copy {
  Index set;
  Index vertex;
  auto operator<=>(const Copy&) const = default;
};

/// A face between a cell of a set and a cell outside.
struct Border {
  Index cell;
  Quad quad;  ///< facing away from the set
};

std::vector<Border> bordersOf(const HexMesh& mesh, std::span<const Index> setOf, Stage& stage) {
  const adjacency::FaceNeighbours neighbours = adjacency::findFaceNeighbours(mesh, stage);
  std::vector<Border> borders;
  for (Index cell = 0; cell < mesh.cells.size(); ++cell) {
    if (setOf[cell] == kNone) continue;
    for (std::size_t face = 0; face < 6; ++face) {
      const Index other = neighbours[cell][face];
      if (other == kNone || setOf[other] == setOf[cell]) continue;
      borders.push_back({cell, adjacency::faceVertices(mesh.cells[cell], face)});
    }
  }
  return borders;
}

Vec3 sumOf(const HexMesh& mesh, const Hex& cell) {
  Vec3 sum{};
  for (const Index v : cell) sum = plus(sum, mesh.points[v]);
  return sum;
}

/// An edge or quad of a cell of a set.
template <class T>
struct OfSet {
  T vertices;  ///< ascending
  Index set;
  auto operator<=>(const OfSet&) const = default;
};
using EdgeOfSet = OfSet<std::array<Index, 2>>;
using QuadOfSet = OfSet<Quad>;

/// The first with these vertices, or null.
template <class T>
const OfSet<T>* found(const std::vector<OfSet<T>>& sorted, const T& vertices) {
  const auto at = std::lower_bound(sorted.begin(), sorted.end(), OfSet<T>{vertices, 0});
  return at != sorted.end() && at->vertices == vertices ? &*at : nullptr;
}

class LayerMaker {
 public:
  LayerMaker(const HexMesh& mesh, std::span<const Index> setOf, Stage& stage)
      : mesh_(mesh), setOf_(setOf), borders_(bordersOf(mesh, setOf, stage)) {
    for (const Border& border : borders_) {
      for (const Index v : border.quad) copies_.push_back({setOf[border.cell], v});
    }
    sortUnique(copies_);
  }

  SetLayers make() {
    SetLayers layers;
    for (const Copy& copy : copies_) {
      layers.originals.push_back(copy.vertex);
      layers.sets.push_back(copy.set);
    }
    layers.mesh = mesh_;
    addPoints(layers.mesh);
    addCells(layers.mesh);
    moveQuadTags(layers.mesh.features.quads);
    moveEdgeTags(layers.mesh.features.edges);
    return layers;
  }

 private:
  /// The vertex as a cell of the set uses it.
  [[nodiscard]] Index in(Index set, Index v) const {
    const Copy copy{set, v};
    const auto found = std::lower_bound(copies_.begin(), copies_.end(), copy);
    if (found == copies_.end() || *found != copy) return v;
    return static_cast<Index>(mesh_.points.size() +
                              static_cast<std::size_t>(found - copies_.begin()));
  }

  void addPoints(HexMesh& mesh) const {
    std::vector<Vec3> sums(copies_.size());
    std::vector<double> counts(copies_.size(), 0);
    for (Index cell = 0; cell < mesh_.cells.size(); ++cell) {
      if (setOf_[cell] == kNone) continue;
      const Vec3 sum = sumOf(mesh_, mesh_.cells[cell]);
      for (const Index v : mesh_.cells[cell]) {
        const Index copy = in(setOf_[cell], v);
        if (copy == v) continue;
        const std::size_t i = copy - mesh_.points.size();
        sums[i] = plus(sums[i], sum);
        counts[i] += 8;
      }
    }
    const bool hasGenerators = mesh_.generatorTet.size() == mesh_.points.size();
    for (std::size_t i = 0; i < copies_.size(); ++i) {
      const Index v = copies_[i].vertex;
      const Vec3& point = mesh_.points[v];
      const Vec3 inwards = minus(times(1 / counts[i], sums[i]), point);
      mesh.points.push_back(plus(point, times(kLayerDepth, inwards)));
      if (!hasGenerators) continue;
      mesh.generatorTet.push_back(mesh_.generatorTet[v]);
      mesh.generatorCorners.push_back(mesh_.generatorCorners[v]);
    }
  }

  void addCells(HexMesh& mesh) const {
    for (Index cell = 0; cell < mesh_.cells.size(); ++cell) {
      if (setOf_[cell] == kNone) continue;
      for (Index& v : mesh.cells[cell]) v = in(setOf_[cell], v);
    }
    const bool hasRegions = mesh_.regions.size() == mesh_.cells.size();
    for (const Border& border : borders_) {
      Hex cell{};
      for (std::size_t i = 0; i < 4; ++i) {
        cell[i] = in(setOf_[border.cell], border.quad[i]);
        cell[i + 4] = border.quad[i];
      }
      mesh.cells.push_back(cell);
      if (hasRegions) mesh.regions.push_back(mesh_.regions[border.cell]);
    }
  }

  /// Quads of sets move with their cells; where a layer ends beside one, so does its tag.
  void moveQuadTags(std::vector<FeatureQuad>& tags) const {
    if (tags.empty()) return;
    std::vector<QuadOfSet> quads;
    for (Index cell = 0; cell < mesh_.cells.size(); ++cell) {
      if (setOf_[cell] == kNone) continue;
      for (std::size_t face = 0; face < 6; ++face) {
        const Quad quad = adjacency::faceVertices(mesh_.cells[cell], face);
        quads.push_back({adjacency::ascending(quad), setOf_[cell]});
      }
    }
    std::sort(quads.begin(), quads.end());
    const std::vector<EdgeOfSet> ends = endsOfLayers();
    const std::size_t count = tags.size();
    for (std::size_t i = 0; i < count; ++i) {
      const FeatureQuad tag = tags[i];
      const QuadOfSet* const quad = found(quads, adjacency::ascending(tag.vertices));
      if (quad == nullptr) continue;
      for (std::size_t k = 0; k < 4; ++k) {
        const Index a = tag.vertices[k];
        const Index b = tag.vertices[(k + 1) % 4];
        tags[i].vertices[k] = in(quad->set, a);
        const EdgeOfSet end{adjacency::ascending(a, b), quad->set};
        if (!std::binary_search(ends.begin(), ends.end(), end)) continue;
        tags.push_back({{a, b, in(quad->set, b), in(quad->set, a)}, tag.tag});
      }
    }
  }

  /// Edges that occur once among a set's borders: the layer ends there.
  [[nodiscard]] std::vector<EdgeOfSet> endsOfLayers() const {
    std::vector<EdgeOfSet> edges;
    for (const Border& border : borders_) {
      for (std::size_t k = 0; k < 4; ++k) {
        edges.push_back(
            {adjacency::ascending(border.quad[k], border.quad[(k + 1) % 4]), setOf_[border.cell]});
      }
    }
    std::sort(edges.begin(), edges.end());
    std::vector<EdgeOfSet> ends;
    adjacency::forEachRun(std::span<const EdgeOfSet>(edges), std::equal_to<>(),
                          [&](const auto& run) {
                            if (run.size() == 1) ends.push_back(run[0]);
                          });
    return ends;
  }

  /// Edges stay if other cells have them, and move with the cells of their set otherwise.
  void moveEdgeTags(std::vector<FeatureEdge>& tags) const {
    if (tags.empty()) return;
    std::vector<EdgeOfSet> edges;  // kNone: of no set, or of a layer
    for (Index cell = 0; cell < mesh_.cells.size(); ++cell) {
      for (const auto& [a, b] : adjacency::kHexEdges) {
        edges.push_back(
            {adjacency::ascending(mesh_.cells[cell][a], mesh_.cells[cell][b]), setOf_[cell]});
      }
    }
    for (const Border& border : borders_) {
      for (std::size_t k = 0; k < 4; ++k) {
        edges.push_back({adjacency::ascending(border.quad[k], border.quad[(k + 1) % 4]), kNone});
      }
    }
    std::sort(edges.begin(), edges.end());
    const std::size_t count = tags.size();
    for (std::size_t i = 0; i < count; ++i) {
      const FeatureEdge tag = tags[i];
      const auto [a, b] = tag.vertices;
      const EdgeOfSet* const edge = found(edges, adjacency::ascending(a, b));
      if (edge == nullptr) continue;
      const EdgeOfSet kept{edge->vertices, kNone};
      if (std::binary_search(edges.begin(), edges.end(), kept)) continue;
      tags[i].vertices = {in(edge->set, a), in(edge->set, b)};
      for (const Index v : tag.vertices) {
        if (in(edge->set, v) != v) tags.push_back({{v, in(edge->set, v)}, tag.tag});
      }
    }
  }

  const HexMesh& mesh_;
  std::span<const Index> setOf_;
  std::vector<Border> borders_;
  std::vector<Copy> copies_;  ///< ascending
};

}  // namespace

SetLayers addSetLayers(const HexMesh& mesh, std::span<const Index> setOf, Stage& stage) {
  return LayerMaker(mesh, setOf, stage).make();
}

}  // namespace hexhex::mesh
