#include <cmath>

#include <curved/edge_crossing.hpp>
#include <curved/exact_replay.hpp>
#include <curved/simplex_point.hpp>
#include <curved/tet_faces.hpp>

namespace hexhex {

namespace {

/// A tet as seen from where an edge begins. The edge's axis ascends.
LatticeTet seenAlong(const LatticeTet& corners, const ChartEdge& edge, std::int64_t unit) {
  const auto axis = static_cast<std::size_t>(axisOf(edge.along));
  LatticeTet seen = corners;
  for (LatticePoint& corner : seen) {
    for (std::size_t k = 0; k < 3; ++k) corner[k] -= edge.z[k] * unit;
    if (signOf(edge.along) < 0) corner[axis] = -corner[axis];
  }
  return seen;
}

}  // namespace

bool ExactReplay::follow(const FollowedEdge& edge, std::span<const FollowedFace> faces) {
  tet_ = edge.tet;
  at_ = {edge.z, edge.along};
  entered_ = vertices_.find(tet_, at_.z).simplex;
  owner_ = kNone;
  for (const FollowedFace& face : faces) {
    const Passed passed = pass(face.halfFace);
    if (passed != Passed::On) return passed == Passed::ToEnd;
  }
  const CornerMask end = vertices_.find(tet_, step(at_.z, at_.along)).simplex;
  return end != kNoSimplex && addSegment(end, true);
}

/// Goes on to where the edge meets a face of the tet at hand, and through it.
ExactReplay::Passed ExactReplay::pass(HalfFace halfFace) {
  const auto axis = static_cast<std::size_t>(axisOf(at_.along));
  const std::int64_t unit = map_.exact.unit;
  const LatticeTet seen = seenAlong(map_.exact.corners[tet_], at_, unit);
  const int face = localOf(halfFace);
  const SimplexPoint point = crossingOfFace(seen, face, axis);
  const CornerMask exit = point.simplex();
  if (exit == kNoSimplex) return Passed::Failed;  // in the plane of the face
  const SimplexPoint::Rough place = point.roughly(seen, axis);
  const auto compare = [&](std::int64_t target) {
    const double difference = place.at - static_cast<double>(target);
    if (std::abs(difference) > place.error) return difference > 0 ? 1 : -1;
    return point.compare(seen, axis, target);
  };
  const bool isBegin = compare(0) <= 0;
  if (!isBegin && compare(unit) >= 0) {
    return addSegment(exit, true) ? Passed::ToEnd : Passed::Failed;
  }
  if (!isBegin && exit != entered_) {
    const int fromMiddle = compare(unit / 2);
    if (fromMiddle == 0 || !addSegment(exit, fromMiddle > 0)) return Passed::Failed;
    const ArcExit found =
        exit == faceMask(face)
            ? exitThrough(map_, tet_, face, at_)
            : exitAtCorners(map_, ownedBy(map_.topology, tet_, exit), tet_, exit, seen, axis);
    pieces_.addPoint(found, found.parameter);
  }
  goThrough(halfFace, exit);
  return Passed::On;
}

/// From where the tet was entered.
/// @param behindMiddle  whether it ends behind the midpoint
bool ExactReplay::addSegment(CornerMask to, bool behindMiddle) {
  // By convexity, all between lies in the smallest simplex that contains both ends.
  const auto carrier = static_cast<CornerMask>(entered_ | to);
  if (dimension(carrier) < 2) return false;
  OwnedSimplex owned{tet_, carrier};
  ChartEdge edge = at_;
  if (dimension(carrier) == 2) {
    const FaceOfOwner face(map_.topology, tet_, oppositeCorner(carrier));
    owned = face.simplex();
    edge = face.carry(edge, map_.exact.transitions);
  }
  pieces_.addSegment(owned);
  if (behindMiddle && owner_ == kNone) {
    owner_ = owned.tet;
    middle_ = edge;
  }
  return true;
}

/// @param exit  what holds the point, in the tet at hand
void ExactReplay::goThrough(HalfFace halfFace, CornerMask exit) {
  const HalfFace mate = map_.topology.mate[halfFace];
  const Index next = tetOf(mate);
  entered_ = exit == faceMask(localOf(halfFace)) ? faceMask(localOf(mate))
                                                 : map_.topology.translated(exit, tet_, next);
  at_ = at_.across(map_.exact.transitions, halfFace);
  tet_ = next;
}

}  // namespace hexhex
