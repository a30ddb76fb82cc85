// Splits edges of a map, with everything that is known about them.
#include <algorithm>
#include <utility>
#include <vector>

#include <adjacency/edge_fan.hpp>
#include <tetmap/split_map.hpp>

namespace hexhex::tetmap {

namespace {

/// Splits entries that have both vertices of the edge: the second half is appended.
template <class T>
void splitEntries(const VertexPair& edge, Index middle, std::vector<T>& entries) {
  const std::size_t count = entries.size();
  for (std::size_t i = 0; i < count; ++i) {
    auto& vertices = entries[i].vertices;
    const auto has = [&vertices](Index v) {
      return std::find(vertices.begin(), vertices.end(), v) != vertices.end();
    };
    if (!has(edge[0]) || !has(edge[1])) continue;
    T second = entries[i];
    std::replace(vertices.begin(), vertices.end(), edge[1], middle);
    std::replace(second.vertices.begin(), second.vertices.end(), edge[0], middle);
    entries.push_back(second);
  }
}

void splitValences(const VertexPair& edge, Index middle, std::vector<EdgeValence>& valences) {
  const std::size_t count = valences.size();
  for (std::size_t i = 0; i < count; ++i) {
    EdgeValence& known = valences[i];
    if (pairOf(known.vertex0, known.vertex1) != edge) continue;
    const EdgeValence second{middle, edge[1], known.offset};
    known = {edge[0], middle, known.offset};
    valences.push_back(second);
  }
}

void splitTet(TetMap& map, const adjacency::TetEdge& edge, Index middle) {
  const Cut cut = cutTet(map.tets, edge, middle);
  carryCorners(cut, map.parameters);
  carryTet(cut, map.regions);
  // Unknown rotations are computed.
  carryFaces(cut, std::int8_t{-1}, map.rotations);
}

/// An edge to be split, and its tets.
struct Fan {
  VertexPair edge;
  std::vector<Index> tets;
};

/// Fans without common tets, first come, first served.
std::vector<Fan> disjointFans(const adjacency::TetTopology& topology,
                              std::span<const EdgeInTet> edges) {
  std::vector<Fan> fans;
  std::vector<bool> isTaken(topology.tetCount());
  for (const EdgeInTet& at : edges) {
    const lattice::CornerMask ends = topology.edge(at.tet, at.vertices[0], at.vertices[1]).mask();
    Fan fan{at.vertices, adjacency::tetsAround(topology, at.tet, ends)};
    if (std::any_of(fan.tets.begin(), fan.tets.end(), [&](Index t) { return isTaken[t]; }))
      continue;
    for (const Index t : fan.tets) isTaken[t] = true;
    fans.push_back(std::move(fan));
  }
  return fans;
}

}  // namespace

std::size_t splitEdges(TetMap& map, const adjacency::TetTopology& topology,
                       std::span<const EdgeInTet> edges) {
  // All fans first: the topology may view the map's own array, which is about to grow.
  const std::vector<Fan> fans = disjointFans(topology, edges);
  for (const auto& [edge, tets] : fans) {
    const auto middle = static_cast<Index>(map.points.size());
    map.points.push_back(middleOf(map.points[edge[0]], map.points[edge[1]]));
    for (const Index t : tets) splitTet(map, edgeOf(map.tets, t, edge), middle);
    splitEntries(edge, middle, map.features.edges);
    splitEntries(edge, middle, map.features.faces);
    splitValences(edge, middle, map.edgeValences);
  }
  return fans.size();
}

}  // namespace hexhex::tetmap
