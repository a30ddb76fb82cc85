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

/// Where the line of a hex edge meets a face of a tet, along the edge.
class Meeting {
 public:
  /// @param seen   the tet, seen along the edge
  /// @param point  of the face
  Meeting(const LatticeTet& seen, std::size_t axis, std::int64_t unit, const SimplexPoint& point)
      : seen_(seen), axis_(axis), unit_(unit), point_(point), at_(point.simplex()) {
    if (dimension(at_) == 1) {
      crossing_ = crossTetEdge(seen[firstCorner(at_)], seen[lastCorner(at_)], axis, unit);
    } else {
      const SimplexPoint::Rough rough = point.roughly(seen, axis);
      crossing_.begun = rough.at;
      crossing_.left = static_cast<double>(unit) - rough.at;
      crossing_.error = rough.error + 0x1p-52 * static_cast<double>(unit);
    }
  }

  /// The simplex that holds the point.
  [[nodiscard]] CornerMask at() const noexcept { return at_; }
  /// If it is an edge.
  [[nodiscard]] const EdgeCrossing& crossing() const noexcept { return crossing_; }

  // Exact:
  [[nodiscard]] bool isBehindBegin() const noexcept { return compare(crossing_.begun, 0) > 0; }
  [[nodiscard]] bool isBeforeEnd() const noexcept { return compare(-crossing_.left, unit_) < 0; }
  /// Sign of the point minus the midpoint.
  [[nodiscard]] int fromMiddle() const noexcept {
    return compare(0.5 * (crossing_.begun - crossing_.left), unit_ / 2);
  }

 private:
  /// @param difference  from the target, roughly
  [[nodiscard]] int compare(double difference, std::int64_t target) const noexcept {
    if (std::abs(difference) > crossing_.error) return difference > 0 ? 1 : -1;
    return point_.compare(seen_, axis_, target);
  }

  const LatticeTet& seen_;
  std::size_t axis_;
  std::int64_t unit_;
  const SimplexPoint& point_;
  CornerMask at_;
  EdgeCrossing crossing_{};
};

/// The point at which an edge leaves a tet through an edge or a vertex.
/// @param seen  the tet, seen along the edge
ArcExit exitAtCorners(const PreparedMap& map, Index tet, const LatticeTet& seen, std::size_t axis,
                      const Meeting& meeting) {
  const CornerMask at = meeting.at();
  const OwnedSimplex generator = ownedBy(map.topology, tet, at);
  if (dimension(at) == 0) return exitAtCorners(map, generator, tet, at, seen, axis);
  const Tet& vertices = map.topology.tets[tet];
  const std::span<const Vec3> points = map.input.view.points;
  return exitAtEdge(meeting.crossing(), generator, points[vertices[firstCorner(at)]],
                    points[vertices[lastCorner(at)]]);
}

}  // namespace

bool ExactReplay::follow(const FollowedEdge& edge, std::span<const FollowedFace> faces) {
  tet_ = edge.tet;
  at_ = {edge.z, edge.along};
  entered_ = edge.begin;
  owner_ = kNone;
  for (const FollowedFace& face : faces) {
    const Passed passed = pass(face.halfFace);
    if (passed != Passed::On) return passed == Passed::ToEnd;
  }
  return addSegment(edge.end, true);
}

/// Goes on to where the edge meets a face of the tet at hand, and through it.
ExactReplay::Passed ExactReplay::pass(HalfFace halfFace) {
  const int face = localOf(halfFace);
  if ((entered_ & faceMask(face)) == entered_) {
    goThrough(halfFace, entered_);  // where it is, on its way around an edge or a vertex
    return Passed::On;
  }
  const auto axis = static_cast<std::size_t>(axisOf(at_.along));
  const std::int64_t unit = map_.exact.unit;
  const LatticeTet seen = seenAlong(map_.exact.corners[tet_], at_, unit);
  const SimplexPoint point = crossingOfFace(seen, face, axis);
  if (point.simplex() == kNoSimplex) return Passed::Failed;  // in the plane of the face
  const Meeting meeting(seen, axis, unit, point);
  const CornerMask exit = meeting.at();
  if (meeting.isBehindBegin()) {
    if (!meeting.isBeforeEnd()) return addSegment(exit, true) ? Passed::ToEnd : Passed::Failed;
    const int fromMiddle = meeting.fromMiddle();
    if (fromMiddle == 0 || !addSegment(exit, fromMiddle > 0)) return Passed::Failed;
    const ArcExit found = exit == faceMask(face) ? exitThrough(map_, tet_, face, at_)
                                                 : exitAtCorners(map_, tet_, seen, axis, meeting);
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
  entered_ = acrossFace(map_.topology, halfFace, exit);
  at_ = at_.across(map_.exact.transitions, halfFace);
  tet_ = tetOf(mate);
}

}  // namespace hexhex
