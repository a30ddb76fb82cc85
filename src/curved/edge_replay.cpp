#include <algorithm>
#include <cmath>
#include <utility>

#include <base/branchless.hpp>
#include <curved/edge_replay.hpp>

namespace hexhex {

namespace {

/// Whether an edge, unless it jumps from chart to chart, is followed against its axis, along which
/// its arc is to run.
unsigned runsBack(const FollowedEdge& edge) noexcept {
  return descends(edge.along) & static_cast<unsigned>(!edge.jumps);
}

/// Computes crossings. Has pointers of its own, as those of arrays might change with everything
/// that is written.
class Crosser {
 public:
  /// @param to  receives the points
  Crosser(const PreparedMap& map, const FollowedEdges& followed, const ArcColumns& to) noexcept
      : edges_(followed.edges.data()),
        transitions_(map.exact.transitions),
        mates_(map.topology.mate.data()),
        jumps_(map.exact.transitions.jump.data()),
        corners_(map.exact.corners.data()),
        tets_(map.topology.tets.data()),
        space_(map.input.view.points),
        unit_(map.exact.unit),
        perUnit_(1 / static_cast<double>(unit_)),
        points_(to.points),
        parameters_(to.parameters),
        generatorTet_(to.generatorTet),
        generatorCorners_(to.generatorCorners),
        segmentTet_(to.segmentTet) {}

  /// Writes the point of a crossing, and the segment behind it, in the order of the arc if the edge
  /// does not jump.
  /// @return whether the crossing is certain to be inside the face, not before the one before it,
  ///         neither at the beginning nor at the end, and not at the midpoint
  bool operator()(const FollowedFace& face, std::size_t number) noexcept {
    const HalfFace mate = mates_[face.halfFace];
    // Which side owns the face, that of the smaller tet, is as good as random, so no branch may
    // depend on it: all bits are set if it is the other one.
    const auto isMates =
        static_cast<HalfFace>((std::int64_t{mate} - std::int64_t{face.halfFace}) >> 63);
    const HalfFace owned = face.halfFace ^ ((face.halfFace ^ mate) & isMates);
    const Index owner = tetOf(owned);
    const int local = localOf(owned);
    const Index jump = jumps_[face.halfFace];
    const FollowedFace* edge = &face;
    FollowedFace carried;
    if ((jump & isMates) != 0) [[unlikely]] {
      const ChartEdge there = ChartEdge{face.z, face.along}.across(transitions_, face.halfFace);
      carried = {mate, face.edge, there.z, there.along};
      edge = &carried;
    }
    const OwnersFace ownersFace(corners_[owner], local);
    const FaceCrossing rough =
        crossAt(shareRoughly(ownersFace, *edge, unit_), ownersFace, *edge, unit_, perUnit_);
    // In which order is as good as random, too.
    const FollowedEdge& whole = edges_[face.edge];
    const unsigned back = runsBack(whole);
    const std::size_t mirrored = std::size_t{whole.faceBegin} + whole.faceEnd - 1 - number;
    const std::size_t place = number ^ ((number ^ mirrored) & (std::size_t{0} - back));
    points_[place] = pointInFace(rough.shares, pointsOf(tets_[owner], local, space_));
    parameters_[place] = fromOtherEnd(rough.parameter, back);
    generatorTet_[place] = owner;
    generatorCorners_[place] = faceMask(local);
    segmentTet_[place + face.edge + (1 - back)] = tetOf(mate);
    const double before = std::array{0.0, before_}[face.edge == edge_ ? 1 : 0];
    edge_ = face.edge;
    before_ = rough.parameter;
    const double fromQuarter = std::abs(std::abs(rough.parameter - 0.5) - 0.25);
    return allOf(rough.inside, fromQuarter < 0.25 - rough.error, before <= rough.parameter);
  }

 private:
  const FollowedEdge* edges_;
  const Transitions& transitions_;
  const HalfFace* mates_;
  const Index* jumps_;
  const LatticeTet* corners_;
  const Tet* tets_;
  std::span<const Vec3> space_;
  std::int64_t unit_;
  double perUnit_;
  Vec3* points_;
  double* parameters_;
  Index* generatorTet_;
  CornerSet* generatorCorners_;
  Index* segmentTet_;
  Index edge_ = kNone;  ///< of the crossing before
  double before_ = 0;   ///< its parameter
};

/// Turns the points and segments of an arc round.
/// @param segment  the first
void reverse(const ArcColumns& to, std::size_t segment, std::size_t point, std::size_t points) {
  const auto turn = [](auto* first, std::size_t size) { std::reverse(first, first + size); };
  turn(to.segmentTet + segment, points + 1);
  turn(to.points + point, points);
  turn(to.parameters + point, points);
  turn(to.generatorTet + point, points);
  turn(to.generatorCorners + point, points);
  for (std::size_t i = point; i < point + points; ++i) to.parameters[i] = 1 - to.parameters[i];
}

}  // namespace

std::size_t EdgeReplay::add(const FollowedEdges& followed, const ArcColumns& to) {
  followed_ = &followed;
  const std::size_t faces = followed.faces.size();
  const std::size_t edges = followed.edges.size();
  // First all crossings, in a loop that knows nothing of edges: how many faces these cross is as
  // good as random. Then edges choose from them, in place: none has more points than it crosses
  // faces, as in one tet it has one simplex that contains it.
  cross(followed.faces, to);
  std::fill_n(to.segmentCorners, faces + edges, kWholeTet);
  std::size_t spare = 0;  // crossings that gave no point: so far is what follows to be moved
  std::size_t sure = 0;   // edges from here on are sure, and have not been moved
  for (std::size_t i = 0; i < edges; ++i) {
    const FollowedEdge& edge = followed.edges[i];
    const std::size_t place = edge.faceBegin - spare;
    if (isSure(edge)) {
      addSure(to, i, place);
    } else {
      move(to, sure, i, spare);
      spare += edge.faceEnd - edge.faceBegin - addUnsure(to, i, place);
      sure = i + 1;
    }
  }
  move(to, sure, edges, spare);
  return faces - spare;
}

void EdgeReplay::cross(Faces faces, const ArcColumns& to) {
  const std::size_t count = faces.size();
  unsure_.resize(count + 1);
  Crosser cross(map_, *followed_, to);
  Index unsure = 0;
  for (std::size_t i = 0; i < count; ++i) {
    unsure_[i] = unsure;
    unsure += cross(faces[i], i) ? 0 : 1;
  }
  unsure_[count] = unsure;
}

/// Moves points and segments of consecutive edges to an earlier place.
void EdgeReplay::move(const ArcColumns& to, std::size_t first, std::size_t end,
                      std::size_t distance) const {
  if (distance == 0 || first == end) return;
  const std::size_t face = followed_->edges[first].faceBegin;
  const std::size_t faces = followed_->edges[end - 1].faceEnd - face;
  const auto shift = [distance](auto* begin, std::size_t size) {
    std::copy(begin, begin + size, begin - distance);
  };
  shift(to.points + face, faces);
  shift(to.parameters + face, faces);
  shift(to.generatorTet + face, faces);
  shift(to.generatorCorners + face, faces);
  shift(to.segmentTet + face + first, faces + end - first);
}

/// Makes the arc of a sure edge run along the axis of the midpoint's owner. Its points and segments
/// stay where its crossings are.
/// @param place  where its points will be, not behind these
inline void EdgeReplay::addSure(const ArcColumns& to, std::size_t number, std::size_t place) {
  const FollowedEdge& edge = followed_->edges[number];
  const std::size_t count = edge.faceEnd - edge.faceBegin;
  const std::size_t segment = edge.faceBegin + number;
  unsigned back = runsBack(edge);
  to.segmentTet[segment + count * back] = edge.tet;
  if (edge.jumps || to.keys != nullptr) {
    const Middle middle = middleOf(to, number);
    if (to.keys != nullptr) to.keys[number] = {middle.owner, middle.edge};
    if (edge.jumps && signOf(middle.edge.along) < 0) {
      reverse(to, segment, edge.faceBegin, count);
      back = 1;
    }
  }
  to.ends[number] = {edge.ends[back], edge.ends[1 - back]};
  to.pointBegin[number] = to.firstPoint + place;
}

/// Where the midpoint of a sure edge is. If it jumps, its arc has not been turned round.
EdgeReplay::Middle EdgeReplay::middleOf(const ArcColumns& to, std::size_t number) const noexcept {
  const FollowedEdge& edge = followed_->edges[number];
  std::size_t early = 0;  // points before the midpoint
  for (std::size_t i = edge.faceBegin; i < edge.faceEnd; ++i) {
    early += to.parameters[i] < 0.5 ? 1 : 0;
  }
  const Index owner = to.segmentTet[edge.faceBegin + number + early];
  if (!edge.jumps || early == 0) return {owner, ChartEdge{edge.z, edge.along}};
  return {owner, behind(followed_->faces[edge.faceBegin + early - 1])};
}

/// Makes the arc of an edge that lies in a face from its beginning to its end.
void EdgeReplay::addInFace(const ArcColumns& to, std::size_t number, std::size_t place) const {
  const FollowedEdge& edge = followed_->edges[number];
  const int opposite = oppositeCorner(static_cast<CornerMask>(edge.begin | edge.end));
  const FaceOfOwner face(map_.topology, edge.tet, opposite);
  const ChartEdge inOwner = face.carry({edge.z, edge.along}, map_.exact.transitions);
  const unsigned back = descends(inOwner.along);
  if (to.keys != nullptr) to.keys[number] = {face.tet, inOwner};
  to.ends[number] = {edge.ends[back], edge.ends[1 - back]};
  to.pointBegin[number] = to.firstPoint + place;
  to.segmentTet[place + number] = face.tet;
  to.segmentCorners[place + number] = face.simplex().corners;
}

/// Makes the arc of an edge of which not everything is certain.
/// @param place  as for addSure()
/// @return the number of points
std::size_t EdgeReplay::addUnsure(const ArcColumns& to, std::size_t number, std::size_t place) {
  const FollowedEdge& edge = followed_->edges[number];
  const std::size_t count = edge.faceEnd - edge.faceBegin;
  if (count == 0 && dimension(static_cast<CornerMask>(edge.begin | edge.end)) == 2) {
    addInFace(to, number, place);
    return 0;
  }
  pieces_.clear();
  followExactly(edge, Faces(followed_->faces).subspan(edge.faceBegin, count));
  if (pieces_.points() > count) {
    ArcTracer::fail(edge.tet, "a hex edge meets more simplices than it was followed through");
  }
  if (to.keys != nullptr) to.keys[number] = key_;
  pieces_.copyTo(to, number, place);
  return pieces_.points();
}

void EdgeReplay::followExactly(const FollowedEdge& edge, Faces faces) {
  if (!exactly_.follow(edge, faces)) {
    pieces_.clear();
    traceFromMiddle(edge, faces);
    return;
  }
  std::array<Index, 2> ends = edge.ends;
  const ChartEdge& middle = exactly_.middle();
  if (signOf(middle.along) < 0) {
    std::swap(ends[0], ends[1]);
    pieces_.reverseFrom(0, 0);
    pieces_.changeParameters(0, [](double& parameter) { parameter = 1 - parameter; });
  }
  addArcOfPieces(ends, exactly_.owner(), middle);
}

void EdgeReplay::addArcOfPieces(const std::array<Index, 2>& ends, Index owner,
                                const ChartEdge& middle) {
  EdgeTracer::smoothParameters(pieces_, 0);
  pieces_.addArc(ends, 0);
  key_ = {owner, middle};
}

/// Traces the edge from its midpoint.
void EdgeReplay::traceFromMiddle(const FollowedEdge& followed, Faces faces) {
  const SimplexInTet middle = ownedMiddle(findMiddle(followed, faces));
  const ChartEdge edge = ChartEdge{middle.frame.origin, middle.frame.axes[0]}.ascending();
  const int axis = axisOf(edge.along);
  const auto ends = tracer_.trace({middle.tet, middle.simplex, Frame::along(edge.z, axis)});
  addArcOfPieces(ends, middle.tet, edge);
}

/// A simplex with the midpoint, in one of the tets that the edge was followed through.
SimplexInTet EdgeReplay::findMiddle(const FollowedEdge& followed, Faces faces) const {
  ChartEdge at{followed.z, followed.along};
  Index tet = followed.tet;
  for (std::size_t i = 0;; ++i) {
    const ChartEdge edge = at.ascending();
    const int axis = axisOf(edge.along);
    LatticePoint middle;
    for (std::size_t k = 0; k < 3; ++k) middle[k] = edge.z[k] * map_.exact.unit;
    middle[static_cast<std::size_t>(axis)] += map_.exact.unit / 2;
    const LatticeTet& corners = map_.exact.corners[tet];
    const CornerMask simplex =
        simplexBySides([&](std::size_t face) { return sideOfFace(corners, face, middle); });
    if (simplex != kNoSimplex) return {tet, simplex, Frame::along(edge.z, axis)};
    if (i == faces.size()) break;
    at = behind(faces[i]);
    tet = tetOf(map_.topology.mate[faces[i].halfFace]);
  }
  ArcTracer::fail(followed.tet, "a hex edge was not followed through its midpoint");
}

/// The same in the smallest tet.
SimplexInTet EdgeReplay::ownedMiddle(const SimplexInTet& middle) {
  SimplexInTet owned = middle;
  star_.visit(middle, [&](const SimplexInTet& here) {
    if (here.tet < owned.tet) owned = here;
    return false;
  });
  return owned;
}

}  // namespace hexhex
