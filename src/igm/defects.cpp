// Collects defects, and checks that the mesh is an oriented manifold (Section 3.1).
#include <algorithm>
#include <atomic>
#include <string>
#include <tuple>

#include <base/short_number.hpp>
#include <igm/defects.hpp>

namespace hexhex::igm {

namespace {

constexpr std::size_t kDefectsGrain = 1024;

/// At most this many places of each kind are kept: a person reads the list.
constexpr std::size_t kWorst = 10;

/// What is wrong and what to do about it, in a sentence or two.
const char* explanation(ErrorCode code) {
  switch (code) {
    case ErrorCode::EmptyMesh:
      return "The mesh has no tets. Give a mesh with at least one.";
    case ErrorCode::IndexOutOfRange:
      return "A tet names a vertex that does not exist. Vertices are numbered from 0.";
    case ErrorCode::RepeatedVertex:
      return "A tet names the same vertex twice. Remove collapsed tets from the mesh.";
    case ErrorCode::NotFinite:
      return "A coordinate or parameter is not a finite number. Find out why the program that made "
             "the map wrote it.";
    case ErrorCode::NonManifoldFace:
      return "A triangle belongs to more than two tets. Remove duplicate or overlapping tets.";
    case ErrorCode::NonManifoldEdge:
      return "The tets around an edge do not form one fan. Separate the parts of the mesh that "
             "touch only there by duplicating the edge's vertices.";
    case ErrorCode::NonManifoldVertex:
      return "The tets around a vertex do not form one ball. Separate the parts of the mesh that "
             "touch only there by duplicating the vertex.";
    case ErrorCode::Orientation:
      return "Neighbouring tets list their corners with opposite orientation. Reorder the corners "
             "(and their parameters) of the tets so that all have positive volume.";
    case ErrorCode::TransitionResidual:
      return "The charts of two neighbouring tets do not differ by a rotation of the integer grid "
             "and an integer translation (IGM1). Let the map's solver converge further, or raise "
             "the tolerance if the amounts are just above it.";
    case ErrorCode::BoundaryOffLattice:
      return "A boundary triangle does not lie in an integer plane (IGM2). Snap the boundary to "
             "integers in the program that made the map, or raise the tolerance if the amounts are "
             "just above it.";
    case ErrorCode::SingularityOffLattice:
      return "A singular edge does not lie on an integer line, or a singular node not on an "
             "integer point (IGM3). Snap singularities to integers in the program that made the "
             "map, or raise the tolerance if the amounts are just above it.";
    case ErrorCode::FlippedTet:
      return "A tet is flipped or degenerate in the map (IGM4). Make the map locally injective, "
             "e.g. by foldover-free optimization.";
    case ErrorCode::HalfIntegerFixedPoint:
      return "The transitions around a vertex leave no grid-aligned position for it: their fixed "
             "points are at half-integers, or they contradict each other. Quantize the map again.";
    case ErrorCode::AmbiguousMesh:
      return "A single hexahedron meets itself around an edge inside of the map: its vertices do "
             "not tell its edges apart, at any scale. Give singular edges a valence of two or "
             "more.";
    case ErrorCode::TooLarge:
      return "A coordinate, parameter or size is larger than the library represents. Translate the "
             "object or its charts towards the origin, or lower the scale.";
    default:
      return "";
  }
}

bool worse(const Defect::Occurrence& a, const Defect::Occurrence& b) {
  if (a.amount != b.amount) return a.amount > b.amount;
  return std::tie(a.place.kind, a.place.index, a.place.second) <
         std::tie(b.place.kind, b.place.index, b.place.second);
}

/// Makes the half-faces of a triangle mates, or boundary if there is only one.
void joinMates(adjacency::TetTopology& topology, std::span<const adjacency::CellFace<Tet>> same,
               DefectCollector& defects) {
  const auto halfFaceAt = [](const adjacency::CellFace<Tet>& at) {
    return adjacency::halfFaceOf(at.cell, at.face);
  };
  for (const adjacency::CellFace<Tet>& at : same) topology.mate[halfFaceAt(at)] = kNone;
  if (same.size() == 1) return;
  const adjacency::CellFace<Tet>& first = same[0];
  const adjacency::CellFace<Tet>& second = same[1];
  const Place place{PlaceKind::Face, first.cell, first.face};
  if (same.size() > 2) {
    defects.add(ErrorCode::NonManifoldFace, place, 0);
    return;
  }
  topology.mate[halfFaceAt(first)] = halfFaceAt(second);
  topology.mate[halfFaceAt(second)] = halfFaceAt(first);
  if (!adjacency::areOpposite(adjacency::faceVertices(topology.tets[first.cell], first.face),
                              adjacency::faceVertices(topology.tets[second.cell], second.face))) {
    defects.add(ErrorCode::Orientation, place, 0);
  }
}

/// Matches half-faces again, collecting defects.
void checkFaces(adjacency::TetTopology& topology, Stage& stage, DefectCollector& defects) {
  topology.mate.resize(4 * topology.tetCount());
  const auto join = [&](std::span<const adjacency::CellFace<Tet>> same) {
    joinMates(topology, same, defects);
  };
  parallelBlocks(
      stage, topology.pointCount, kDefectsGrain,
      [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
        std::vector<Index> around;
        const auto tetsAt = [&](std::size_t v) {
          around.clear();
          for (const adjacency::CornerIndex corner : topology.star(static_cast<Index>(v))) {
            around.push_back(adjacency::tetOf(corner));
          }
          return std::span<const Index>(around);
        };
        adjacency::forEachFace(topology.tets, begin, end, tetsAt, join);
      });
}

/// An edge with more than two boundary faces has more than one fan. Returns the number of edges at
/// each vertex.
Array<Index> checkEdges(const adjacency::TetTopology& topology, Stage& stage,
                        DefectCollector& defects) {
  Array<Index> degree(topology.pointCount, 0);
  parallelFor(stage, topology.pointCount, kDefectsGrain, [&](std::size_t i) {
    const auto v = static_cast<Index>(i);
    std::vector<adjacency::EdgeCorner> scratch;
    adjacency::forEachEdge(topology, v, scratch,
                           [&](Index w, std::span<const adjacency::EdgeCorner> fan) {
                             std::atomic_ref(degree[v]).fetch_add(1, std::memory_order_relaxed);
                             std::atomic_ref(degree[w]).fetch_add(1, std::memory_order_relaxed);
                             if (adjacency::boundaryFacesAt(topology, fan) > 2) {
                               defects.add(ErrorCode::NonManifoldEdge, {PlaceKind::Edge, v, w}, 0);
                             }
                           });
  });
  return degree;
}

/// V - E + F of the link of a vertex: the triangles opposite it in the tets of its star.
std::int64_t linkCharacteristic(std::span<const adjacency::CornerIndex> star,
                                std::int64_t edgesAtVertex, std::int64_t boundaryFaces) {
  const auto triangles = static_cast<std::int64_t>(star.size());
  const std::int64_t sides = (3 * triangles + boundaryFaces) / 2;
  return edgesAtVertex - sides + triangles;
}

std::int64_t boundaryFacesAt(const adjacency::TetTopology& topology,
                             std::span<const adjacency::CornerIndex> star) {
  std::int64_t count = 0;
  for (const adjacency::CornerIndex corner : star) {
    for (int face = 0; face < 4; ++face) {
      if (face != adjacency::localOf(corner) &&
          topology.isBoundary(adjacency::halfFaceOf(corner / 4, face)))
        ++count;
    }
  }
  return count;
}

/// Whether faces at the vertex connect all tets of its star.
bool isConnected(const adjacency::TetTopology& topology,
                 std::span<const adjacency::CornerIndex> star) {
  std::vector<bool> reached(star.size(), false);
  reached[0] = true;
  std::vector<adjacency::CornerIndex> queue = {star[0]};
  for (std::size_t head = 0; head < queue.size(); ++head) {
    const adjacency::CornerIndex corner = queue[head];
    for (int face = 0; face < 4; ++face) {
      const adjacency::HalfFace mate = topology.mate[adjacency::halfFaceOf(corner / 4, face)];
      if (face == adjacency::localOf(corner) || mate == kNone) continue;
      const auto neighbour = std::lower_bound(star.begin(), star.end(), 4 * adjacency::tetOf(mate));
      const auto position = static_cast<std::size_t>(neighbour - star.begin());
      if (reached[position]) continue;
      reached[position] = true;
      queue.push_back(*neighbour);
    }
  }
  return queue.size() == star.size();
}

/// The link of a vertex must be a sphere (inside) or a disk (on the boundary). Its triangles are
/// glued edge to edge and its boundary does not branch (checked at edges), so it suffices that it
/// is connected and has the right Euler characteristic.
void checkLinks(const adjacency::TetTopology& topology, const Array<Index>& degree, Stage& stage,
                DefectCollector& defects) {
  parallelFor(stage, topology.pointCount, kDefectsGrain, [&](std::size_t v) {
    const std::span<const adjacency::CornerIndex> star = topology.star(static_cast<Index>(v));
    if (star.empty()) return;  // isolated: reported by check(), harmless
    const std::int64_t boundary = boundaryFacesAt(topology, star);
    if (linkCharacteristic(star, degree[v], boundary) != (boundary > 0 ? 1 : 2) ||
        !isConnected(topology, star)) {
      defects.add(ErrorCode::NonManifoldVertex, {PlaceKind::Vertex, v}, 0);
    }
  });
}

}  // namespace

void DefectCollector::add(ErrorCode code, Place place, double amount) {
  if (cornersReversed_ && place.kind == PlaceKind::Face && place.second >= 2) {
    place.second = 5 - place.second;
  }
  const std::lock_guard lock(mutex_);
  Defect& defect = defects_[code];
  if (defect.count == 0) {
    defect.code = code;
    defect.sentence = explanation(code);
  }
  ++defect.count;
  const Defect::Occurrence occurrence{place, amount};
  if (defect.worst.size() == kWorst && !worse(occurrence, defect.worst.back())) return;
  defect.worst.insert(std::upper_bound(defect.worst.begin(), defect.worst.end(), occurrence, worse),
                      occurrence);
  if (defect.worst.size() > kWorst) defect.worst.pop_back();
}

std::vector<Defect> DefectCollector::defects() const {
  std::vector<Defect> list;
  list.reserve(defects_.size());
  for (const auto& [code, defect] : defects_) list.push_back(defect);
  std::stable_partition(list.begin(), list.end(),
                        [&](const Defect& defect) { return defect.code == rootCause_; });
  return list;
}

void DefectCollector::throwIfAny() const {
  if (defects_.empty()) return;
  const Defect defect = defects().front();
  const Defect::Occurrence& worst = defect.worst.front();
  std::string message = defect.sentence;
  const std::string where = toString(worst.place);
  if (!where.empty()) {
    message += defect.count == 1 ? " Found once: at "
                                 : " Found " + std::to_string(defect.count) + " times, worst at ";
    message += where;
    if (worst.amount != 0) message += " (by " + shortNumber(worst.amount) + ")";
    message += ".";
  }
  throw Error(defect.code, message, worst.place);
}

void collectTopologyDefects(adjacency::TetTopology& topology, Stage& stage,
                            DefectCollector& defects) {
  adjacency::addStars(topology, stage);
  checkFaces(topology, stage, defects);
  if (defects.has(ErrorCode::NonManifoldFace)) return;
  const Array<Index> degree = checkEdges(topology, stage, defects);
  if (!defects.has(ErrorCode::NonManifoldEdge)) checkLinks(topology, degree, stage, defects);
}

adjacency::TetTopology buildTopology(const TetMapView& map, Stage& stage,
                                     DefectCollector& defects) {
  adjacency::TetTopology topology;
  topology.tets = map.tets;
  topology.pointCount = map.points.size();
  if (!adjacency::matchFaces(topology, stage)) collectTopologyDefects(topology, stage, defects);
  return topology;
}

}  // namespace hexhex::igm
