#include <algorithm>
#include <cmath>
#include <utility>

#include <curved/edge_replay.hpp>

#include <base/branchless.hpp>

namespace hexhex {

namespace {

/// Computes crossings. Has pointers of its own, as those of arrays might change with everything
/// that is written.
class Crosser {
 public:
  /// @param to  receives the points
  Crosser(const PreparedMap& map, const ArcColumns& to, Array<Index>& behind) noexcept
      : transitions_(map.exact.transitions),
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
        behind_(behind.data()) {}

  /// @param[in,out] counts  of the crossings before
  void operator()(const FollowedFace& face, std::size_t number,
                  CrossingCounts& counts) const noexcept {
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
      carried = {mate, there.z, there.along};
      edge = &carried;
    }
    const OwnersFace ownersFace(corners_[owner], local);
    const FaceCrossing rough =
        crossAt(shareRoughly(ownersFace, *edge, unit_), ownersFace, *edge, unit_, perUnit_);
    points_[number] = pointInFace(rough.shares, pointsOf(tets_[owner], local, space_));
    parameters_[number] = rough.parameter;
    generatorTet_[number] = owner;
    generatorCorners_[number] = faceMask(local);
    behind_[number] = tetOf(mate);
    // Not at an end, and not at the midpoint.
    const double fromQuarter = std::abs(std::abs(rough.parameter - 0.5) - 0.25);
    counts.unsure += allOf(rough.inside, fromQuarter < 0.25 - rough.error) ? 0 : 1;
    counts.jumps += jump != 0 ? 1 : 0;
    counts.early += rough.parameter < 0.5 ? 1 : 0;
  }

 private:
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
  Index* behind_;
};

void movePoint(const ArcColumns& to, std::size_t from, std::size_t place) {
  to.points[place] = to.points[from];
  to.parameters[place] = to.parameters[from];
  to.generatorTet[place] = to.generatorTet[from];
  to.generatorCorners[place] = to.generatorCorners[from];
}

/// Turns the points and segments of an arc round.
void reverse(const ArcColumns& to, Index* segments, std::size_t place, std::size_t count) {
  const auto turn = [](auto* first, std::size_t size) { std::reverse(first, first + size); };
  turn(segments, count + 1);
  turn(to.points + place, count);
  turn(to.parameters + place, count);
  turn(to.generatorTet + place, count);
  turn(to.generatorCorners + place, count);
  for (std::size_t i = place; i < place + count; ++i) to.parameters[i] = 1 - to.parameters[i];
}

/// Of an arc whose parameters are certain to be in (0, 1).
void smooth(double* parameters, std::size_t count) {
  double before = EdgeTracer::kLeastParameter;
  for (std::size_t i = 0; i < count; ++i) {
    parameters[i] = before = EdgeTracer::smooth(parameters[i], before);
  }
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
  std::size_t place = 0;
  Index first = 0;
  for (std::size_t i = 0; i < edges; ++i) {
    place += isSure(followed.edges[i], first) ? addSure(to, i, first, place)
                                              : addUnsure(to, i, first, place);
    first = followed.edges[i].faceEnd;
  }
  return place;
}

void EdgeReplay::cross(Faces faces, const ArcColumns& to) {
  const std::size_t count = faces.size();
  // One more that edges without crossings may look at.
  behind_.resize(count + 1);
  behind_[count] = kNone;
  to.points[count] = {};
  to.parameters[count] = 0;
  to.generatorTet[count] = kNone;
  to.generatorCorners[count] = kNoSimplex;
  counts_.resize(count + 1);
  const Crosser cross(map_, to, behind_);
  CrossingCounts counts;
  counts_[0] = counts;
  for (std::size_t i = 0; i < count; ++i) {
    cross(faces[i], i, counts);
    counts_[i + 1] = counts;
  }
}

/// Makes the arc of a sure edge run along the axis of the midpoint's owner.
/// @param first  its first crossing
/// @param place  of its first point, not behind it
/// @return the number of points
inline std::size_t EdgeReplay::addSure(const ArcColumns& to, std::size_t number, Index first,
                                       std::size_t place) {
  const FollowedEdge& edge = followed_->edges[number];
  const std::size_t count = edge.faceEnd - first;
  const Middle middle = middleOf(edge, first);
  if (to.keys != nullptr) to.keys[number] = {middle.owner, middle.edge};
  // Whether an arc is turned round is as good as random, so no branch may depend on it, and most
  // edges cross no face or one, so none may depend on which.
  const std::size_t reversed = signOf(middle.edge.along) < 0 ? 1 : 0;
  to.ends[number] = {edge.ends[reversed], edge.ends[1 - reversed]};
  to.pointBegin[number] = to.firstPoint + place;
  Index* const segments = &to.segmentTet[place + number];
  if (count < 2) {
    segments[count & (1 - reversed)] = behind_[first];
    segments[count & reversed] = edge.tet;
    movePoint(to, first, place);
    double& parameter = to.parameters[place];
    parameter = std::array{parameter, 1 - parameter}[count & reversed];
  } else {
    segments[0] = edge.tet;
    std::copy_n(&behind_[first], count, segments + 1);
    for (std::size_t i = 0; i < count; ++i) movePoint(to, first + i, place + i);
    if (reversed != 0) reverse(to, segments, place, count);
    smooth(&to.parameters[place], count);
  }
  return count;
}

/// Where the midpoint of a sure edge is.
inline EdgeReplay::Middle EdgeReplay::middleOf(const FollowedEdge& edge,
                                               Index first) const noexcept {
  const CrossingCounts& before = counts_[first];
  const CrossingCounts& upTo = counts_[edge.faceEnd];
  const Index early = upTo.early - before.early;
  // At random there are some; jumps are rare.
  if ((upTo.jumps - before.jumps) * std::min(early, Index{1}) != 0) [[unlikely]] {
    const Index last = first + early - 1;
    return {behind_[last], behind(followed_->faces[last])};
  }
  const std::array<Index, 2> owners = {edge.tet, behind_[first + std::max(early, Index{1}) - 1]};
  return {owners[std::min(early, Index{1})], {edge.z, edge.along}};
}

/// Makes the arc of an edge of which not everything is certain.
/// @param first, place  as for addSure()
/// @return the number of points
std::size_t EdgeReplay::addUnsure(const ArcColumns& to, std::size_t number, Index first,
                                  std::size_t place) {
  const FollowedEdge& edge = followed_->edges[number];
  const std::size_t count = edge.faceEnd - first;
  pieces_.clear();
  followExactly(edge, Faces(followed_->faces).subspan(first, count));
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
