#include <algorithm>
#include <unordered_map>
#include <utility>

#include <base/disjoint_sets.hpp>
#include <repair/patch.hpp>

namespace hexhex::repairs {

namespace {

std::vector<Index> verticesOf(const adjacency::TetTopology& topology, std::span<const Index> tets) {
  std::vector<Index> vertices;
  for (const Index t : tets) {
    vertices.insert(vertices.end(), topology.tets[t].begin(), topology.tets[t].end());
  }
  sortUnique(vertices);
  return vertices;
}

}  // namespace

Patch growPatch(const adjacency::TetTopology& topology, std::span<const Index> startTets,
                int rings) {
  Patch patch;
  patch.startTets.assign(startTets.begin(), startTets.end());
  patch.tets = patch.startTets;
  igm::VertexStar star;
  for (int ring = 0; ring < rings; ++ring) {
    patch.vertices = verticesOf(topology, patch.tets);
    patch.tets.clear();
    patch.stars.clear();
    for (const Index v : patch.vertices) {
      star.collect(topology, v);
      patch.stars.emplace_back(star.members().begin(), star.members().end());
      for (const igm::VertexStar::Member& member : star.members())
        patch.tets.push_back(member.tet());
    }
    sortUnique(patch.tets);
  }
  return patch;
}

std::vector<std::vector<Index>> separateRegions(const adjacency::TetTopology& topology,
                                                std::span<const Index> bad, int rings) {
  // All patches grow together, ring by ring, and each tet and vertex belongs to the first patch
  // that reaches it. Where another patch reaches it within its rings, the two become one region.
  DisjointSets sets(bad.size());
  std::unordered_map<Index, Index> ownerOfTet;
  std::unordered_map<Index, Index> ownerOfVertex;
  std::vector<Index> front(bad.begin(), bad.end());  // tets
  for (Index i = 0; i < bad.size(); ++i) ownerOfTet.emplace(bad[i], i);
  igm::VertexStar star;
  for (int ring = 0; ring < rings; ++ring) {
    std::vector<Index> next;
    for (const Index t : front) {
      const Index owner = ownerOfTet.at(t);
      for (const Index v : topology.tets[t]) {
        const auto [before, isNew] = ownerOfVertex.emplace(v, owner);
        sets.unite(before->second, owner);
        if (!isNew) continue;
        star.collect(topology, v);
        for (const igm::VertexStar::Member& member : star.members()) {
          const auto [known, reached] = ownerOfTet.emplace(member.tet(), owner);
          sets.unite(known->second, owner);
          if (reached) next.push_back(member.tet());
        }
      }
    }
    front = std::move(next);
  }
  std::vector<std::vector<Index>> regions(bad.size());
  for (Index i = 0; i < bad.size(); ++i) regions[sets.find(i)].push_back(bad[i]);
  std::erase_if(regions, [](const std::vector<Index>& region) { return region.empty(); });
  return regions;
}

}  // namespace hexhex::repairs
