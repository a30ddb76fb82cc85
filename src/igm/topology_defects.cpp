#include <atomic>
#include <vector>

#include <igm/topology_defects.hpp>

namespace hexhex {

namespace {

constexpr std::size_t kGrain = 1024;

/// Makes the half-faces of one triangle mates, or boundary if there is only one.
void joinMates(TetTopology& topology, std::span<const CellFace<Tet>> same,
               DefectCollector& defects) {
  const auto halfFaceAt = [](const CellFace<Tet>& at) { return halfFaceOf(at.cell, at.face); };
  for (const CellFace<Tet>& at : same) topology.mate[halfFaceAt(at)] = kNone;
  if (same.size() == 1) return;
  const CellFace<Tet>& first = same[0];
  const CellFace<Tet>& second = same[1];
  const Place place{PlaceKind::Face, first.cell, first.face};
  if (same.size() > 2) {
    defects.add(ErrorCode::NonManifoldFace, place, 0);
    return;
  }
  topology.mate[halfFaceAt(first)] = halfFaceAt(second);
  topology.mate[halfFaceAt(second)] = halfFaceAt(first);
  if (!areOpposite(faceVertices(topology.tets[first.cell], first.face),
                   faceVertices(topology.tets[second.cell], second.face))) {
    defects.add(ErrorCode::Orientation, place, 0);
  }
}

/// Matches half-faces once more.
void checkFaces(TetTopology& topology, Stage& stage, DefectCollector& defects) {
  topology.mate.resize(4 * topology.tetCount());
  const auto join = [&](std::span<const CellFace<Tet>> same) {
    joinMates(topology, same, defects);
  };
  parallelBlocks(stage, topology.pointCount, kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   FacesAtVertices<Tet> faces(topology.tets);
                   std::vector<Index> around;
                   for (std::size_t i = begin; i < end; ++i) {
                     const auto v = static_cast<Index>(i);
                     around.clear();
                     for (const CornerIndex corner : topology.star(v)) {
                       around.push_back(tetOf(corner));
                     }
                     faces.forEach(v, around, join);
                   }
                 });
}

/// An edge with more than two boundary faces has more than one fan. Returns the number of edges at
/// each vertex.
Array<Index> checkEdges(const TetTopology& topology, Stage& stage, DefectCollector& defects) {
  Array<Index> degree(topology.pointCount, 0);
  parallelBlocks(stage, topology.pointCount, kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   std::vector<EdgeCorner> scratch;
                   for (std::size_t i = begin; i < end; ++i) {
                     const auto v = static_cast<Index>(i);
                     forEachEdge(
                         topology, v, scratch, [&](Index w, std::span<const EdgeCorner> fan) {
                           std::atomic_ref(degree[v]).fetch_add(1, std::memory_order_relaxed);
                           std::atomic_ref(degree[w]).fetch_add(1, std::memory_order_relaxed);
                           if (boundaryFacesAt(topology, fan) > 2) {
                             defects.add(ErrorCode::NonManifoldEdge, {PlaceKind::Edge, v, w}, 0);
                           }
                         });
                   }
                 });
  return degree;
}

/// V - E + F of the link of a vertex: the triangles opposite it in the tets of its star.
std::int64_t linkCharacteristic(std::span<const CornerIndex> star, std::int64_t edgesAtVertex,
                                std::int64_t boundaryFaces) {
  const auto triangles = static_cast<std::int64_t>(star.size());
  const std::int64_t sides = (3 * triangles + boundaryFaces) / 2;
  return edgesAtVertex - sides + triangles;
}

std::int64_t boundaryFacesAt(const TetTopology& topology, std::span<const CornerIndex> star) {
  std::int64_t count = 0;
  for (const CornerIndex corner : star) {
    for (int face = 0; face < 4; ++face) {
      if (face != localOf(corner) && topology.isBoundary(halfFaceOf(corner / 4, face))) ++count;
    }
  }
  return count;
}

/// Whether faces at the vertex connect all tets of its star.
/// @param reached, queue  reused between calls
bool isConnected(const TetTopology& topology, std::span<const CornerIndex> star,
                 std::vector<bool>& reached, std::vector<CornerIndex>& queue) {
  reached.assign(star.size(), false);
  reached[0] = true;
  queue.assign(1, star[0]);
  for (std::size_t head = 0; head < queue.size(); ++head) {
    const CornerIndex corner = queue[head];
    for (int face = 0; face < 4; ++face) {
      const HalfFace mate = topology.mate[halfFaceOf(corner / 4, face)];
      if (face == localOf(corner) || mate == kNone) continue;
      const auto neighbour = std::lower_bound(star.begin(), star.end(), 4 * tetOf(mate));
      const auto position = static_cast<std::size_t>(neighbour - star.begin());
      if (reached[position]) continue;
      reached[position] = true;
      queue.push_back(*neighbour);
    }
  }
  return queue.size() == star.size();
}

/// The link of a vertex must be a sphere (inside) or a disk (on the boundary). As its triangles are
/// glued edge to edge and its boundary is free of branching (checked at edges), that is so if it is
/// connected and has the right Euler characteristic.
void checkLinks(const TetTopology& topology, const Array<Index>& degree, Stage& stage,
                DefectCollector& defects) {
  parallelBlocks(stage, topology.pointCount, kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   std::vector<bool> reached;
                   std::vector<CornerIndex> queue;
                   for (std::size_t v = begin; v < end; ++v) {
                     const std::span<const CornerIndex> star = topology.star(static_cast<Index>(v));
                     if (star.empty()) continue;  // isolated: reported by check(), harmless
                     const std::int64_t boundary = boundaryFacesAt(topology, star);
                     if (linkCharacteristic(star, degree[v], boundary) != (boundary > 0 ? 1 : 2) ||
                         !isConnected(topology, star, reached, queue)) {
                       defects.add(ErrorCode::NonManifoldVertex, {PlaceKind::Vertex, v}, 0);
                     }
                   }
                 });
}

}  // namespace

void collectTopologyDefects(TetTopology& topology, Stage& stage, DefectCollector& defects) {
  addStars(topology, stage);
  checkFaces(topology, stage, defects);
  if (defects.has(ErrorCode::NonManifoldFace)) return;
  const Array<Index> degree = checkEdges(topology, stage, defects);
  if (!defects.has(ErrorCode::NonManifoldEdge)) checkLinks(topology, degree, stage, defects);
}

TetTopology buildTopology(const TetMapView& map, Stage& stage, DefectCollector& defects) {
  TetTopology topology;
  topology.tets = map.tets;
  topology.pointCount = map.points.size();
  if (!matchFaces(topology, stage)) collectTopologyDefects(topology, stage, defects);
  return topology;
}

}  // namespace hexhex
