#include <algorithm>
#include <utility>

#include <repair/patch.hpp>

#include <base/disjoint_sets.hpp>

namespace hexhex {

namespace {

void sortUnique(std::vector<Index>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

std::vector<Index> verticesOf(const TetTopology& topology, std::span<const Index> tets) {
  std::vector<Index> vertices;
  for (const Index t : tets) {
    vertices.insert(vertices.end(), topology.tets[t].begin(), topology.tets[t].end());
  }
  sortUnique(vertices);
  return vertices;
}

}  // namespace

const std::vector<VertexStar::Member>* Patch::starOf(Index vertex) const {
  const auto found = std::lower_bound(vertices.begin(), vertices.end(), vertex);
  if (found == vertices.end() || *found != vertex) return nullptr;
  return &stars[static_cast<std::size_t>(found - vertices.begin())];
}

Patch growPatch(const TetTopology& topology, std::span<const Index> seeds, int rings) {
  Patch patch;
  patch.seeds.assign(seeds.begin(), seeds.end());
  patch.tets = patch.seeds;
  VertexStar star;
  for (int ring = 0; ring < rings; ++ring) {
    patch.vertices = verticesOf(topology, patch.tets);
    patch.tets.clear();
    patch.stars.clear();
    for (const Index v : patch.vertices) {
      star.collect(topology, v);
      patch.stars.emplace_back(star.members().begin(), star.members().end());
      for (const VertexStar::Member& member : star.members()) patch.tets.push_back(member.tet());
    }
    sortUnique(patch.tets);
  }
  return patch;
}

std::vector<std::vector<Index>> separateRegions(const TetTopology& topology,
                                                std::span<const Index> bad, int rings) {
  // Seeds whose patches share a tet get the same root.
  std::vector<std::pair<Index, Index>> claims;  // tet, seed
  for (Index i = 0; i < bad.size(); ++i) {
    for (const Index t : growPatch(topology, bad.subspan(i, 1), rings).tets) {
      claims.emplace_back(t, i);
    }
  }
  std::sort(claims.begin(), claims.end());
  DisjointSets sets(bad.size());
  for (std::size_t k = 1; k < claims.size(); ++k) {
    if (claims[k].first == claims[k - 1].first) sets.unite(claims[k - 1].second, claims[k].second);
  }
  std::vector<std::vector<Index>> regions(bad.size());
  for (Index i = 0; i < bad.size(); ++i) regions[sets.find(i)].push_back(bad[i]);
  std::erase_if(regions, [](const std::vector<Index>& region) { return region.empty(); });
  return regions;
}

}  // namespace hexhex
