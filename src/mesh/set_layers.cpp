#include <algorithm>
#include <array>
#include <vector>

#include <adjacency/hex_topology.hpp>

#include <base/vector3.hpp>
#include <mesh/set_layers.hpp>

namespace hexhex::mesh {

namespace {

/// Of the way to the middle of the set's cells around, which a copy is moved.
constexpr double kLayerDepth = 0.25;

/// A vertex as a set has it.
struct Copy {
  Index set;
  Index vertex;
  auto operator<=>(const Copy&) const = default;
};

/// A face between a cell of a set and one that is not.
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

class LayerMaker {
 public:
  LayerMaker(const HexMesh& mesh, std::span<const Index> setOf, Stage& stage)
      : mesh_(mesh), setOf_(setOf), borders_(bordersOf(mesh, setOf, stage)) {
    for (const Border& border : borders_) {
      for (const Index v : border.quad) copies_.push_back({setOf[border.cell], v});
    }
    std::sort(copies_.begin(), copies_.end());
    copies_.erase(std::unique(copies_.begin(), copies_.end()), copies_.end());
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
    return layers;
  }

 private:
  /// The vertex of a cell of a set.
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
