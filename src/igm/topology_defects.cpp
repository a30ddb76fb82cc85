#include <atomic>

#include <igm/topology_defects.hpp>

namespace hexhex {

namespace {

constexpr std::size_t kGrain = 1024;

/// A half-face at its smallest vertex.
struct FaceKey {
  Index middle;
  Index largest;
  HalfFace halfFace;
};

/// Whether two tets see their common triangle with opposite orientation, as neighbours must.
bool oppositeOrientation(const TetTopology& topology, HalfFace a, HalfFace b) {
  const auto corners = [&](HalfFace f) {
    const std::array<int, 3>& local = kFaceCorners[f % 4];
    const Tet& tet = topology.tets[f / 4];
    return std::array<Index, 3>{tet[static_cast<std::size_t>(local[0])],
                                tet[static_cast<std::size_t>(local[1])],
                                tet[static_cast<std::size_t>(local[2])]};
  };
  const std::array<Index, 3> left = corners(a);
  const std::array<Index, 3> right = corners(b);
  const auto shift =
      static_cast<std::size_t>(std::find(right.begin(), right.end(), left[0]) - right.begin());
  return right[(shift + 1) % 3] == left[2];
}

/// The half-faces whose smallest vertex is v, so that equal triangles follow each other.
void collectFaces(const TetTopology& topology, Index v, std::vector<FaceKey>& faces) {
  faces.clear();
  for (const CornerIndex corner : topology.star(v)) {
    const Tet& tet = topology.tets[corner / 4];
    // Of the three other corners, two belong to each face at v.
    for (std::uint32_t opposite = 0; opposite < 4; ++opposite) {
      if (opposite == corner % 4) continue;
      std::uint32_t i = 0;
      while (i == corner % 4 || i == opposite) ++i;
      const std::uint32_t j = 6 - corner % 4 - opposite - i;
      if (tet[i] < v || tet[j] < v) continue;
      faces.push_back({std::min(tet[i], tet[j]), std::max(tet[i], tet[j]),
                       halfFaceOf(corner / 4, static_cast<int>(opposite))});
    }
  }
  std::sort(faces.begin(), faces.end(), [](const FaceKey& a, const FaceKey& b) {
    if (a.middle != b.middle) return a.middle < b.middle;
    return a.largest != b.largest ? a.largest < b.largest : a.halfFace < b.halfFace;
  });
}

/// Makes the half-faces of one triangle mates, or boundary if there is only one.
void joinMates(TetTopology& topology, std::span<const FaceKey> same, DefectCollector& defects) {
  for (const FaceKey& face : same) topology.mate[face.halfFace] = kNone;
  if (same.size() == 1) return;
  const HalfFace first = same[0].halfFace;
  const HalfFace second = same[1].halfFace;
  const Place place{PlaceKind::Face, tetOf(first), first % 4};
  if (same.size() > 2) {
    defects.add(ErrorCode::NonManifoldFace, place, 0);
    return;
  }
  topology.mate[first] = second;
  topology.mate[second] = first;
  if (!oppositeOrientation(topology, first, second)) {
    defects.add(ErrorCode::Orientation, place, 0);
  }
}

/// Matches half-faces once more; each triangle is found at its smallest vertex.
void checkFaces(TetTopology& topology, Stage& stage, DefectCollector& defects) {
  topology.mate.resize(4 * topology.tetCount());
  const auto matchAt = [&](Index v, std::vector<FaceKey>& faces) {
    collectFaces(topology, v, faces);
    for (std::size_t begin = 0; begin < faces.size();) {
      std::size_t end = begin + 1;
      while (end < faces.size() && faces[end].middle == faces[begin].middle &&
             faces[end].largest == faces[begin].largest) {
        ++end;
      }
      joinMates(topology, std::span(&faces[begin], end - begin), defects);
      begin = end;
    }
  };
  parallelBlocks(stage, topology.pointCount, kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   std::vector<FaceKey> faces;
                   for (std::size_t v = begin; v < end; ++v) matchAt(static_cast<Index>(v), faces);
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
