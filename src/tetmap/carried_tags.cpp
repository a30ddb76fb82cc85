// Finds the simplices of a split mesh that are parts of tagged ones.
#include <algorithm>
#include <utility>

#include <adjacency/cell_faces.hpp>
#include <tetmap/carried_tags.hpp>
#include <tetmap/cut.hpp>

#include <base/sorted.hpp>

namespace hexhex::tetmap {

namespace {

/// The tagged parts of tagged edges or triangles.
/// @tparam Simplex  FeatureEdge or FeatureFace
template <class Simplex>
class Carrier {
 public:
  Carrier(std::span<const Simplex> given, const AddedVertices& added) : added_(added) {
    for (const Simplex& simplex : given) {
      known_.emplace_back(added.simplexOf(simplex.vertices), simplex.tag);
    }
    std::sort(known_.begin(), known_.end());
  }

  [[nodiscard]] bool hasWork() const noexcept { return !known_.empty(); }

  void look(const decltype(Simplex::vertices)& vertices) {
    const Tet simplex = added_.simplexOf(vertices);
    const auto found =
        std::lower_bound(known_.begin(), known_.end(), simplex,
                         [](const auto& entry, const Tet& key) { return entry.first < key; });
    if (found == known_.end() || found->first != simplex) return;
    found_.push_back({sorted(vertices), found->second});
  }

  /// Each part once.
  std::vector<Simplex> take() {
    const auto less = [](const Simplex& a, const Simplex& b) { return a.vertices < b.vertices; };
    std::sort(found_.begin(), found_.end(), less);
    found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
    return std::move(found_);
  }

 private:
  const AddedVertices& added_;
  std::vector<std::pair<Tet, std::int32_t>> known_;  ///< ascending
  std::vector<Simplex> found_;
};

}  // namespace

Tet AddedVertices::simplexOf(std::span<const Index> vertices) const {
  Tet simplex = {kNone, kNone, kNone, kNone};
  const auto insert = [&simplex](Index v) {
    for (Index& corner : simplex) {
      if (v == corner) return;
      if (v < corner) std::swap(v, corner);
    }
  };
  for (const Index v : vertices) {
    if (v < given_) {
      insert(v);
    } else {
      for (const Index corner : simplices_[v - given_]) insert(corner);
    }
  }
  return simplex;
}

void carryTags(FeaturesView features, std::span<const std::int32_t> regions,
               const AddedVertices& added, std::span<const Index> parents, TetMap& map) {
  map.features = features.copy();
  map.regions.clear();
  if (!regions.empty()) {
    for (const Index parent : parents) map.regions.push_back(regions[parent]);
  }
  if (added.empty()) return;
  Carrier<FeatureEdge> edges(features.edges, added);
  Carrier<FeatureFace> faces(features.faces, added);
  for (const Tet& tet : map.tets) {
    if (edges.hasWork()) {
      forEachEdgeOf(
          tet, [&](const VertexPair& edge, lattice::CornerMask /*corners*/) { edges.look(edge); });
    }
    for (std::size_t face = 0; faces.hasWork() && face < 4; ++face) {
      faces.look(adjacency::faceVertices(tet, face));
    }
  }
  map.features.edges = edges.take();
  map.features.faces = faces.take();
}

}  // namespace hexhex::tetmap
