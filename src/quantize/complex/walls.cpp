#include <algorithm>
#include <cmath>

#include <quantize/complex/walls.hpp>

#include <base/vector3.hpp>

namespace hexhex::quantization {

namespace {

/// A wall that crosses an edge within this fraction from an end moves the end into its plane
/// instead of splitting the edge.
constexpr double kClose = 0.25;
/// Distances have the same priority up to this difference, in lattice units (2^52 per map).
constexpr double kDistanceUnits = 0x1p28;

Vec3 toVector(const lattice::LatticePoint& u) {
  return {static_cast<double>(u[0]), static_cast<double>(u[1]), static_cast<double>(u[2])};
}

int otherAxis(std::size_t a, std::size_t b) { return static_cast<int>(3 - a - b); }

}  // namespace

AxisPlane AxisPlane::beyond(const lattice::LatticeMotion& change) const noexcept {
  const lattice::Direction to = change.rotation(lattice::direction(static_cast<int>(axis), 1));
  const auto there = static_cast<std::size_t>(lattice::axisOf(to));
  return {there, lattice::signOf(to) * value + change.translation[there]};
}

AxisPlane planeOf(const WallMesh& mesh, adjacency::HalfFace wall) {
  const auto& c = lattice::kFaceCorners[wall % 4];
  const lattice::LatticeTet& u = mesh.corners[adjacency::tetOf(wall)];
  const auto corner = [&](std::size_t k) { return u[static_cast<std::size_t>(c[k])]; };
  std::size_t axis = 0;
  while (axis < 3 && (corner(0)[axis] != corner(1)[axis] || corner(0)[axis] != corner(2)[axis])) {
    ++axis;
  }
  if (axis == 3) {
    throw Error(ErrorCode::Internal, "A wall does not lie in a plane. This is a bug.",
                {PlaceKind::Tet, mesh.original[adjacency::tetOf(wall)]});
  }
  return {axis, corner(0)[axis]};
}

namespace {

/// Turns around an edge until it meets a plane through the edge, starting on the given side of the
/// plane.
PlaneMeeting turnTo(const WallMesh& mesh, AxisPlane plane, int side,
                    adjacency::EdgeTurn<WallMesh> turn) {
  PlaneMeeting meeting;
  while (true) {
    const Index tet = turn.tet();
    const int sideAhead = side * plane.sideOf(mesh.at(tet, turn.ahead()));
    if (sideAhead < 0) {
      meeting.kind = PlaneMeeting::Kind::Inside;
      // From the corner behind to the one ahead.
      meeting.crossed = {tet, static_cast<std::uint8_t>(adjacency::localOf(turn.out())),
                         static_cast<std::uint8_t>(turn.ahead())};
      meeting.plane = plane;
      return meeting;
    }
    if (sideAhead == 0) {
      meeting.kind = PlaneMeeting::Kind::Face;
      meeting.face = turn.out();
      return meeting;
    }
    if (turn.next() == kNone) return meeting;
    meeting.wallBefore = meeting.wallBefore || mesh.isWall[turn.out()];
    const lattice::LatticeMotion& change = mesh.change[turn.out()];
    const lattice::Direction to =
        change.rotation(lattice::direction(static_cast<int>(plane.axis), 1));
    plane = plane.beyond(change);
    side *= lattice::signOf(to);
    turn.step();
  }
}

/// Meets the plane of a wall half a turn away from the wall, around one of its edges.
PlaneMeeting meetOpposite(const WallMesh& mesh, adjacency::HalfFace wall, Index v, Index w) {
  const Index tet = adjacency::tetOf(wall);
  const adjacency::TetEdge edge = mesh.edge(tet, v, w);
  const AxisPlane plane = planeOf(mesh, wall);
  const int side = plane.sideOf(mesh.at(tet, static_cast<std::size_t>(adjacency::localOf(wall))));
  return turnTo(
      mesh, plane, side,
      adjacency::EdgeTurn(mesh, tet, edge.mask(),
                          adjacency::otherFaceAtEdge(edge.mask(), adjacency::localOf(wall))));
}

}  // namespace

int WallTracer::moveEnd(const adjacency::TetEdge& edge, const AxisPlane& plane) {
  const std::int64_t begin = mesh_.at(edge.tet, edge.corner0)[plane.axis];
  const std::int64_t end = mesh_.at(edge.tet, edge.corner1)[plane.axis];
  const double share = static_cast<double>(plane.value - begin) / static_cast<double>(end - begin);
  int corner = -1;
  if (share < kClose) corner = edge.corner0;
  if (share > 1 - kClose) corner = edge.corner1;
  if (corner < 0) return corner;
  const auto moved = static_cast<std::uint8_t>(corner);
  return mesh_.moveInto(edge.tet, moved, plane.axis, plane.value) ? corner : -1;
}

void WallTracer::split(const adjacency::TetEdge& edge, const AxisPlane& plane) {
  struct Crossed {
    std::array<Index, 2> vertices;
    Index tet;
    AxisPlane plane;
  };
  std::vector<Crossed> others;
  const auto collect = [&](const auto& turn, const AxisPlane& here) {
    const Index tet = turn.tet();
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = 0; b < 4; ++b) {
        if (here.sideOf(mesh_.at(tet, a)) >= 0 || here.sideOf(mesh_.at(tet, b)) <= 0) continue;
        others.push_back({{mesh_.tets[tet][a], mesh_.tets[tet][b]}, tet, here});
      }
    }
    return true;
  };
  const Tet& tet = mesh_.tets[edge.tet];
  if (mesh_.isNew(tet[edge.corner0]) || mesh_.isNew(tet[edge.corner1])) {
    adjacency::visitAroundEdge(
        mesh_, edge.tet, edge.mask(), plane,
        [&](const AxisPlane& here, adjacency::HalfFace out) {
          return here.beyond(mesh_.change[out]);
        },
        collect);
  }
  mesh_.split(edge, plane.axis, plane.value);
  for (const Crossed& other : others) {
    const WallMesh::Found found = mesh_.find(other.vertices[0], other.vertices[1], other.tet);
    if (!found.edge) continue;
    const auto side = [&](std::size_t corner) {
      return other.plane.sideOf(mesh_.at(found.edge->tet, corner));
    };
    // An end may have been moved into the plane.
    if (side(found.edge->corner0) >= 0 || side(found.edge->corner1) <= 0) continue;
    if (moveEnd(*found.edge, other.plane) < 0) {
      mesh_.split(*found.edge, other.plane.axis, other.plane.value);
    }
  }
}

adjacency::HalfFace WallTracer::wallAt(const PlaneMeeting& meeting) {
  adjacency::HalfFace face = meeting.face;
  if (meeting.kind == PlaneMeeting::Kind::Inside) {
    const auto& [tet, corner0, corner1] = meeting.crossed;
    const int moved = moveEnd(meeting.crossed, meeting.plane);
    if (moved < 0) split(meeting.crossed, meeting.plane);
    // Must be a half-face of the previous tet, as a turn continues from its mate.
    face = moved == corner0 ? mesh_.mate[adjacency::halfFaceOf(tet, corner1)]
                            : adjacency::halfFaceOf(tet, corner0);
  }
  mesh_.markWall(face);
  return face;
}

void WallTracer::push(adjacency::HalfFace wall, const std::array<Index, 2>& edge,
                      const std::array<double, 2>& distances) {
  // Extrapolates distance as a linear function with unit gradient, the update of fast marching
  // (Sethian 1996).
  const Index tet = adjacency::tetOf(wall);
  const auto point = [&](Index vertex) {
    return toVector(mesh_.at(tet, mesh_.cornerOf(tet, vertex)));
  };
  Index third = kNone;
  for (const int corner : lattice::kFaceCorners[wall % 4]) {
    const Index vertex = mesh_.tets[tet][static_cast<std::size_t>(corner)];
    if (vertex != edge[0] && vertex != edge[1]) third = vertex;
  }
  const Vec3 along = minus(point(edge[1]), point(edge[0]));
  const Vec3 toThird = minus(point(third), point(edge[0]));
  const double length = std::sqrt(dot(along, along));
  const double slope = std::clamp((distances[1] - distances[0]) / length, -1.0, 1.0);
  const double parallel = dot(toThird, along) / length;
  const double across = std::sqrt(std::max(dot(toThird, toThird) - parallel * parallel, 0.0));
  const double distance = distances[0] + slope * parallel + std::sqrt(1 - slope * slope) * across;
  push({edge[0], third}, {distances[0], distance}, tet);
  push({edge[1], third}, {distances[1], distance}, tet);
}

void WallTracer::push(const std::array<Index, 2>& edge, const std::array<double, 2>& distances,
                      Index tet) {
  // Removes noise, which would decide the order in symmetric maps.
  const double distance = std::round((distances[0] + distances[1]) / kDistanceUnits);
  fronts_.push({distance, order_++, edge, distances, tet});
}

void WallTracer::startAt(const adjacency::TetEdge& edge, int face) {
  const std::array<Index, 2> ends = {mesh_.tets[edge.tet][edge.corner0],
                                     mesh_.tets[edge.tet][edge.corner1]};
  const lattice::LatticePoint origin = mesh_.at(edge.tet, edge.corner0);
  const lattice::LatticePoint along = mesh_.at(edge.tet, edge.corner1) - origin;
  std::size_t axis = 0;
  while (along[axis] == 0) ++axis;
  const std::size_t a = (axis + 1) % 3;
  const std::size_t b = (axis + 2) % 3;
  // Starts with the first grid direction on a turn from `face`, or with `face` if it lies in one.
  adjacency::HalfFace wall = adjacency::halfFaceOf(edge.tet, face);
  const lattice::LatticePoint behind =
      mesh_.at(edge.tet, static_cast<std::size_t>(adjacency::otherFaceAtEdge(edge.mask(), face))) -
      origin;
  if (behind[a] != 0 && behind[b] != 0) {
    const lattice::LatticePoint ahead = mesh_.at(edge.tet, static_cast<std::size_t>(face)) - origin;
    const int turn = lattice::sign(static_cast<lattice::Int128>(behind[a]) * ahead[b] -
                                   static_cast<lattice::Int128>(behind[b]) * ahead[a]);
    const bool sameSigns = (behind[a] > 0) == (behind[b] > 0);
    const std::size_t zero = (turn > 0) == sameSigns ? a : b;
    wall = wallAt(turnTo(mesh_, {zero, origin[zero]}, behind[zero] > 0 ? 1 : -1,
                         adjacency::EdgeTurn(mesh_, edge.tet, edge.mask(),
                                             adjacency::otherFaceAtEdge(edge.mask(), face))));
  } else {
    mesh_.markWall(wall);
  }
  const auto thirdOf = [&](adjacency::HalfFace h) {
    for (const int corner : lattice::kFaceCorners[h % 4]) {
      const Index vertex = mesh_.tets[adjacency::tetOf(h)][static_cast<std::size_t>(corner)];
      if (vertex != ends[0] && vertex != ends[1]) return vertex;
    }
    return kNone;
  };
  const Index first = thirdOf(wall);
  if (!mesh_.isBoundary(wall)) push(wall, ends, {0, 0});
  // Continues by quarter turns, each from the far side of the previous wall.
  bool isStart = true;
  while (true) {
    const adjacency::HalfFace from = isStart && mesh_.isBoundary(wall) ? wall : mesh_.mate[wall];
    isStart = false;
    const Index tet = adjacency::tetOf(from);
    const adjacency::TetEdge here = mesh_.edge(tet, ends[0], ends[1]);
    const lattice::LatticePoint out =
        mesh_.at(tet, mesh_.cornerOf(tet, thirdOf(from))) - mesh_.at(tet, here.corner0);
    const lattice::LatticePoint line = mesh_.at(tet, here.corner1) - mesh_.at(tet, here.corner0);
    std::size_t lineAxis = 0;
    while (line[lineAxis] == 0) ++lineAxis;
    const auto next = static_cast<std::size_t>(otherAxis(lineAxis, planeOf(mesh_, from).axis));
    const PlaneMeeting meeting = turnTo(
        mesh_, {next, mesh_.at(tet, here.corner0)[next]}, out[next] > 0 ? 1 : -1,
        adjacency::EdgeTurn(mesh_, tet, here.mask(),
                            adjacency::otherFaceAtEdge(here.mask(), adjacency::localOf(from))));
    if (meeting.kind == PlaneMeeting::Kind::Boundary) return;
    wall = wallAt(meeting);
    if (mesh_.isBoundary(wall) || thirdOf(wall) == first) return;
    push(wall, ends, {0, 0});
  }
}

bool WallTracer::startIn(Index tet, const AxisPlane& plane) {
  // Splits edges until the plane consists of triangles of the tet's parts.
  std::vector<Index> parts = {tet};
  for (std::size_t next = 0; next < parts.size(); ++next) {
    const Index t = parts[next];
    for (std::uint8_t a = 0; a < 4; ++a) {
      for (std::uint8_t b = 0; b < 4; ++b) {
        if (plane.sideOf(mesh_.at(t, a)) >= 0 || plane.sideOf(mesh_.at(t, b)) <= 0) continue;
        if (moveEnd({t, a, b}, plane) >= 0) continue;
        mesh_.split({t, a, b}, plane.axis, plane.value);
        parts.push_back(adjacency::tetOf(mesh_.mate[adjacency::halfFaceOf(t, a)]));
      }
    }
  }
  bool isStarted = false;
  for (const Index t : parts) {
    for (int face = 0; face < 4; ++face) {
      const auto& c = lattice::kFaceCorners[static_cast<std::size_t>(face)];
      std::array<Index, 3> triangle{};
      bool isInPlane = true;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto corner = static_cast<std::size_t>(c[k]);
        triangle[k] = mesh_.tets[t][corner];
        isInPlane = isInPlane && plane.sideOf(mesh_.at(t, corner)) == 0;
      }
      const adjacency::HalfFace wall = adjacency::halfFaceOf(t, face);
      if (!isInPlane || mesh_.isWall[wall]) continue;
      mesh_.markWall(wall);
      isStarted = true;
      for (std::size_t k = 0; k < 3; ++k) push({triangle[k], triangle[(k + 1) % 3]}, {0, 0}, t);
    }
  }
  return isStarted;
}

adjacency::HalfFace WallTracer::someWall(const adjacency::TetEdge& edge) const {
  for (int face = 0; face < 4; ++face) {
    if (lattice::contains(edge.mask(), face)) continue;
    adjacency::EdgeTurn turn(mesh_, edge.tet, edge.mask(), face);
    do {
      if (mesh_.isWall[turn.out()]) return turn.out();
      turn.step();  // the boundary is a wall
    } while (turn.tet() != edge.tet);
  }
  return kNone;
}

void WallTracer::grow() {
  while (!fronts_.empty()) {
    const Front front = fronts_.top();
    fronts_.pop();
    grow(front);
  }
}

void WallTracer::grow(const Front& front) {
  const auto [v, w] = front.vertices;
  const WallMesh::Found found = mesh_.find(v, w, front.tet);
  if (!found.edge) {
    const double middle = (front.distances[0] + front.distances[1]) / 2;
    push({v, found.middle}, {front.distances[0], middle}, front.tet);
    push({found.middle, w}, {middle, front.distances[1]}, front.tet);
    return;
  }
  const adjacency::HalfFace wall = someWall(*found.edge);
  if (wall == kNone) {
    throw Error(ErrorCode::Internal, "An edge of a wall has lost its wall. This is a bug.",
                {PlaceKind::Edge, v, w});
  }
  if (mesh_.isBoundary(wall)) return;
  const PlaneMeeting one = meetOpposite(mesh_, wall, v, w);
  const PlaneMeeting other = meetOpposite(mesh_, mesh_.mate[wall], v, w);
  if (one.kind == PlaneMeeting::Kind::Boundary || other.kind == PlaneMeeting::Kind::Boundary)
    return;
  if (one.kind == PlaneMeeting::Kind::Face && mesh_.isWall[one.face]) return;
  // The wall ends where another one passes through.
  if (one.wallBefore && other.wallBefore) return;
  push(wallAt(one), front.vertices, front.distances);
}

adjacency::HalfFace wallOpposite(const WallMesh& mesh, adjacency::HalfFace wall, Index v, Index w) {
  const auto meeting = meetOpposite(mesh, wall, v, w);
  const bool isWall = meeting.kind == PlaneMeeting::Kind::Face && mesh.isWall[meeting.face];
  return isWall ? meeting.face : kNone;
}

void WallTracer::startAlong(Index v, Index w, Index tet) {
  // Other walls may have split the edge.
  mesh_.forEachPart(v, w, tet, [this](adjacency::TetEdge edge) {
    const std::array<Index, 2> ends = {mesh_.tets[edge.tet][edge.corner0],
                                       mesh_.tets[edge.tet][edge.corner1]};
    adjacency::EdgeTurn turn(mesh_, edge.tet, edge.mask(),
                             adjacency::otherFaceAtEdge(edge.mask(), -1));
    // Turns from the boundary inward.
    turn.goToBoundary();
    startAt(mesh_.edge(turn.tet(), ends[0], ends[1]), adjacency::localOf(turn.out()));
  });
}

void WallTracer::startAt(adjacency::HalfFace feature) {
  mesh_.markWall(feature);
  const Tet& tet = mesh_.tets[adjacency::tetOf(feature)];
  const auto& c = lattice::kFaceCorners[feature % 4];
  for (std::size_t k = 0; k < 3; ++k) {
    push({tet[static_cast<std::size_t>(c[k])], tet[static_cast<std::size_t>(c[(k + 1) % 3])]},
         {0, 0}, adjacency::tetOf(feature));
  }
}

WallMesh traceWalls(const SeamlessMap& map, const adjacency::EdgeFans& edges) {
  WallMesh mesh(map);
  WallTracer tracer(mesh);
  const std::vector<int> quarters = quartersAround(edges, std::span(map.corners));
  std::vector<adjacency::TetEdge> features;
  for (const adjacency::TetEdge& at : map.featureEdges) {
    const Index edge = edges.edgeOf(at);
    const bool isSingular = quarters[edge] != regularQuarters(edges, edge);
    if (isSingular && !isSingularByTurnsAlone(edges, edge, quarters[edge])) continue;
    if (!isSingular) features.push_back(at);
    mesh.keepEdge(mesh.tets[at.tet][at.corner0], mesh.tets[at.tet][at.corner1]);
  }
  const auto start = [&](const adjacency::TetEdge& at) {
    const Tet& tet = map.topology.tets[at.tet];
    tracer.startAlong(tet[at.corner0], tet[at.corner1], at.tet);
  };
  for (const adjacency::HalfFace feature : map.featureFaces) tracer.startAt(feature);
  for (std::size_t edge = 0; edge < edges.size(); ++edge) {
    if (quarters[edge] != regularQuarters(edges, edge)) start(edges(edge).front());
  }
  for (const adjacency::TetEdge& at : features) start(at);
  std::fill(mesh.isHeld.begin(), mesh.isHeld.end(), false);
  tracer.grow();
  return mesh;
}

}  // namespace hexhex::quantization
