#include <algorithm>
#include <utility>
#include <vector>

#include <repair/map_changes.hpp>

namespace hexhex::repairs {

namespace {

Vec3 middle(const Vec3& a, const Vec3& b) {
  return {0.5 * a[0] + 0.5 * b[0], 0.5 * a[1] + 0.5 * b[1], 0.5 * a[2] + 0.5 * b[2]};
}

bool isPair(Index v, Index w, const std::array<Index, 2>& edge) {
  return (v == edge[0] && w == edge[1]) || (v == edge[1] && w == edge[0]);
}

void splitTet(TetMap& map, Index tet, const std::array<Index, 2>& edge, Index vertex) {
  const auto place = [&](Index v) {
    const Tet& t = map.tets[tet];
    return static_cast<std::size_t>(std::find(t.begin(), t.end(), v) - t.begin());
  };
  const std::size_t a = place(edge[0]);
  const std::size_t b = place(edge[1]);
  const Vec3 between = middle(map.parameters[tet][a], map.parameters[tet][b]);
  Tet second = map.tets[tet];
  TetParameters secondParameters = map.parameters[tet];
  second[a] = vertex;
  secondParameters[a] = between;
  map.tets[tet][b] = vertex;
  map.parameters[tet][b] = between;
  map.tets.push_back(second);
  map.parameters.push_back(secondParameters);
  if (!map.regions.empty()) map.regions.push_back(map.regions[tet]);
  if (map.rotations.empty()) return;
  // The triangle between both halves: opposite a in the first, opposite b in the second. Where
  // nothing is known, the rotation is computed.
  std::array<std::int8_t, 4> rotations = map.rotations[tet];
  map.rotations[tet][a] = -1;
  rotations[b] = -1;
  map.rotations.push_back(rotations);
}

void splitFeatures(TetMap& map, const std::array<Index, 2>& edge, Index vertex) {
  const std::size_t edgeCount = map.features.edges.size();
  for (std::size_t i = 0; i < edgeCount; ++i) {
    FeatureEdge& feature = map.features.edges[i];
    if (!isPair(feature.vertices[0], feature.vertices[1], edge)) continue;
    const FeatureEdge half{{vertex, edge[1]}, feature.tag};
    feature.vertices = {edge[0], vertex};
    map.features.edges.push_back(half);
  }
  const std::size_t faceCount = map.features.faces.size();
  for (std::size_t i = 0; i < faceCount; ++i) {
    FeatureFace& feature = map.features.faces[i];
    const auto a = std::find(feature.vertices.begin(), feature.vertices.end(), edge[0]);
    const auto b = std::find(feature.vertices.begin(), feature.vertices.end(), edge[1]);
    if (a == feature.vertices.end() || b == feature.vertices.end()) continue;
    FeatureFace half = feature;
    half.vertices[static_cast<std::size_t>(a - feature.vertices.begin())] = vertex;
    *b = vertex;
    map.features.faces.push_back(half);
  }
}

void splitValences(TetMap& map, const std::array<Index, 2>& edge, Index vertex) {
  const std::size_t count = map.edgeValences.size();
  for (std::size_t i = 0; i < count; ++i) {
    EdgeValence& known = map.edgeValences[i];
    if (!isPair(known.vertex0, known.vertex1, edge)) continue;
    const EdgeValence half{vertex, edge[1], known.offset};
    known.vertex0 = edge[0];
    known.vertex1 = vertex;
    map.edgeValences.push_back(half);
  }
}

/// An edge that is to be split, and the tets at it.
struct Fan {
  std::array<Index, 2> edge;
  std::vector<Index> tets;
};

/// Fans that have no tet in common, first come first served.
std::vector<Fan> disjointFans(const adjacency::TetTopology& topology,
                              std::span<const std::array<Index, 2>> edges) {
  std::vector<Fan> fans;
  std::vector<Index> taken;  // sorted
  igm::VertexStar star;
  for (const std::array<Index, 2>& edge : edges) {
    Fan fan{edge, tetsAtEdge(topology, edge, star)};
    const bool free = std::none_of(fan.tets.begin(), fan.tets.end(), [&](Index t) {
      return std::binary_search(taken.begin(), taken.end(), t);
    });
    if (fan.tets.empty() || !free) continue;
    taken.insert(taken.end(), fan.tets.begin(), fan.tets.end());
    std::sort(taken.begin(), taken.end());
    fans.push_back(std::move(fan));
  }
  return fans;
}

}  // namespace

std::vector<Index> tetsAtEdge(const adjacency::TetTopology& topology,
                              const std::array<Index, 2>& edge, igm::VertexStar& star) {
  std::vector<Index> tets;
  star.collect(topology, edge[0]);
  for (const igm::VertexStar::Member& member : star.members()) {
    const Tet& tet = topology.tets[member.tet()];
    if (std::find(tet.begin(), tet.end(), edge[1]) != tet.end()) tets.push_back(member.tet());
  }
  std::sort(tets.begin(), tets.end());
  return tets;
}

void MapBackup::keep(const TetMap& map, Index tet) {
  if (tet >= tetCount_ || tets_.contains(tet)) return;
  KeptTet kept{map.tets[tet], map.parameters[tet], {}};
  if (!map.rotations.empty()) kept.rotations = map.rotations[tet];
  tets_.emplace(tet, kept);
}

void MapBackup::keepLists(const TetMap& map) {
  if (!lists_) lists_ = KeptLists{map.features, map.edgeValences};
}

const TetParameters* MapBackup::parametersOf(Index tet) const {
  const auto found = tets_.find(tet);
  return found == tets_.end() ? nullptr : &found->second.parameters;
}

void MapBackup::restore(TetMap& map) const {
  map.points.resize(pointCount_);
  map.tets.resize(tetCount_);
  map.parameters.resize(tetCount_);
  if (!map.rotations.empty()) map.rotations.resize(tetCount_);
  if (!map.regions.empty()) map.regions.resize(tetCount_);
  for (const auto& [tet, kept] : tets_) {
    map.tets[tet] = kept.tet;
    map.parameters[tet] = kept.parameters;
    if (!map.rotations.empty()) map.rotations[tet] = kept.rotations;
  }
  if (!lists_) return;
  map.features = lists_->features;
  map.edgeValences = lists_->edgeValences;
}

std::size_t splitEdges(TetMap& map, const adjacency::TetTopology& topology,
                       std::span<const std::array<Index, 2>> edges, MapBackup& backup) {
  // All of them first: the topology sees the map's own array, which is going to grow.
  const std::vector<Fan> fans = disjointFans(topology, edges);
  if (!fans.empty()) backup.keepLists(map);
  for (const Fan& fan : fans) {
    for (const Index t : fan.tets) backup.keep(map, t);
    const auto vertex = static_cast<Index>(map.points.size());
    map.points.push_back(middle(map.points[fan.edge[0]], map.points[fan.edge[1]]));
    for (const Index t : fan.tets) splitTet(map, t, fan.edge, vertex);
    splitFeatures(map, fan.edge, vertex);
    splitValences(map, fan.edge, vertex);
  }
  return fans.size();
}

}  // namespace hexhex::repairs
