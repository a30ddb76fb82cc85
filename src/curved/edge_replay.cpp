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
  Crosser(const PreparedMap& map, FollowedCrossings& crossings) noexcept
      : transitions_(map.exact.transitions),
        mates_(map.topology.mate.data()),
        jumps_(map.exact.transitions.jump.data()),
        corners_(map.exact.corners.data()),
        tets_(map.topology.tets.data()),
        space_(map.input.view.points),
        unit_(map.exact.unit),
        perUnit_(1 / static_cast<double>(unit_)),
        points_(crossings.points.data()),
        parameters_(crossings.parameters.data()),
        generatorTet_(crossings.generatorTet.data()),
        generatorCorners_(crossings.generatorCorners.data()),
        behind_(crossings.behind.data()) {}

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

}  // namespace

void EdgeReplay::add(const FollowedEdges& followed) {
  followed_ = &followed;
  // First all crossings, in a loop that knows nothing of edges: how many faces these cross is as
  // good as random.
  cross(followed.faces);
  ends_.resize(followed.edges.size());
  segmentTet_.resize(followed.faces.size() + followed.edges.size());
  points_ = followed.faces.size();
  Index first = 0;
  for (std::size_t i = 0; i < followed.edges.size(); ++i) {
    const FollowedEdge& edge = followed.edges[i];
    if (isSure(edge, first)) [[likely]] {
      addSure(i, first);
    } else {
      unsure_.push_back(static_cast<Index>(i));
      const std::size_t before = pieces_.points();
      addUnsure(edge, Faces(followed.faces).subspan(first, edge.faceEnd - first));
      points_ += pieces_.points() - before;
      points_ -= edge.faceEnd - first;
    }
    first = edge.faceEnd;
  }
}

void EdgeReplay::cross(Faces faces) {
  crossings_.resize(faces.size() + 1);  // one that edges without crossings may look at
  counts_.resize(faces.size() + 1);
  const Crosser cross(map_, crossings_);
  CrossingCounts counts;
  counts_[0] = counts;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    cross(faces[i], i, counts);
    counts_[i + 1] = counts;
  }
}

/// Makes the arc of a sure edge run along the axis of the midpoint's owner.
/// @param first  its first crossing
inline void EdgeReplay::addSure(std::size_t number, Index first) {
  const FollowedEdge& edge = followed_->edges[number];
  const std::size_t count = edge.faceEnd - first;
  // Whether an arc is turned round is as good as random, so no branch may depend on it, and most
  // edges cross no face or one, so none may depend on which.
  const std::size_t reversed = signOf(middleOf(edge, first).edge.along) < 0 ? 1 : 0;
  ends_[number] = {edge.ends[reversed], edge.ends[1 - reversed]};
  Index* const segments = &segmentTet_[first + number];
  if (count < 2) {
    segments[count & (1 - reversed)] = crossings_.behind[first];
    segments[count & reversed] = edge.tet;
    double& parameter = crossings_.parameters[first];
    parameter = std::array{parameter, 1 - parameter}[count & reversed];
  } else {
    segments[0] = edge.tet;
    std::copy_n(&crossings_.behind[first], count, segments + 1);
    if (reversed != 0) reverse(first, number, count);
    smooth(first, count);
  }
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
    return {crossings_.behind[last], behind(followed_->faces[last])};
  }
  const std::array<Index, 2> owners = {edge.tet,
                                       crossings_.behind[first + std::max(early, Index{1}) - 1]};
  return {owners[std::min(early, Index{1})], {edge.z, edge.along}};
}

void EdgeReplay::addUnsure(const FollowedEdge& edge, Faces faces) {
  const std::size_t points = pieces_.points();
  const std::size_t segments = pieces_.segments();
  if (!exactly_.follow(edge, faces)) {
    pieces_.shorten(points, segments);
    traceFromMiddle(edge, faces);
    return;
  }
  std::array<Index, 2> ends = edge.ends;
  const ChartEdge& middle = exactly_.middle();
  if (signOf(middle.along) < 0) {
    std::swap(ends[0], ends[1]);
    pieces_.reverseFrom(points, segments);
    pieces_.changeParameters(points, [](double& parameter) { parameter = 1 - parameter; });
  }
  addArcOfPieces(ends, points, exactly_.owner(), middle);
}

void EdgeReplay::addArcOfPieces(const std::array<Index, 2>& ends, std::size_t firstPoint,
                                Index owner, const ChartEdge& middle) {
  EdgeTracer::smoothParameters(pieces_, firstPoint);
  pieces_.addArc(ends, firstPoint);
  keys_.emplace_back(owner, middle);
}

void EdgeReplay::copyTo(Arcs& to, std::span<EdgeKey> keys, std::uint64_t firstArc,
                        std::uint64_t firstPoint) const {
  const std::span<const FollowedEdge> edges = followed_->edges;
  Place place{firstArc, firstPoint};
  Run run{0, 0, 0};
  for (std::size_t i = 0; i < unsure_.size(); ++i) {
    run.end = unsure_[i];
    place = copyRun(run, to, keys, place);
    to.pointBegin[place.arc] = place.point;
    pieces_.copyArc(i, to, place.arc, place.point);
    if (!keys.empty()) keys[place.arc] = keys_[i];
    place.point += pieces_.pointsOf(i);
    ++place.arc;
    run = {run.end + 1, 0, edges[run.end].faceEnd};
  }
  run.end = edges.size();
  static_cast<void>(copyRun(run, to, keys, place));
}

/// @param place  of the first arc
/// @return the place behind them
EdgeReplay::Place EdgeReplay::copyRun(const Run& run, Arcs& to, std::span<EdgeKey> keys,
                                      Place place) const {
  if (run.edge == run.end) return place;
  const std::span<const FollowedEdge> edges = followed_->edges;
  const std::size_t points = edges[run.end - 1].faceEnd - run.crossing;
  const std::size_t arcs = run.end - run.edge;
  const auto copy = [](const auto& from, std::size_t first, std::size_t count, auto& target,
                       std::uint64_t at) { std::copy_n(&from[first], count, &target[at]); };
  copy(ends_, run.edge, arcs, to.ends, place.arc);
  if (points > 0) {
    copy(crossings_.points, run.crossing, points, to.points, place.point);
    copy(crossings_.parameters, run.crossing, points, to.parameters, place.point);
    copy(crossings_.generatorTet, run.crossing, points, to.generatorTet, place.point);
    copy(crossings_.generatorCorners, run.crossing, points, to.generatorCorners, place.point);
  }
  const std::uint64_t segment = place.point + place.arc;
  copy(segmentTet_, run.crossing + run.edge, points + arcs, to.segmentTet, segment);
  std::fill_n(&to.segmentCorners[segment], points + arcs, kWholeTet);
  Index crossing = run.crossing;
  for (std::size_t i = run.edge; i < run.end; ++i) {
    to.pointBegin[place.arc] = place.point + (crossing - run.crossing);
    if (!keys.empty()) {
      const Middle middle = middleOf(edges[i], crossing);
      keys[place.arc] = {middle.owner, middle.edge};
    }
    ++place.arc;
    crossing = edges[i].faceEnd;
  }
  return {place.arc, place.point + points};
}

/// Turns the points and segments of an arc round.
/// @param first   its first point
/// @param number  of the edge
void EdgeReplay::reverse(Index first, std::size_t number, std::size_t count) {
  const auto turn = [](auto& array, std::size_t begin, std::size_t size) {
    std::reverse(&array[begin], &array[begin] + size);
  };
  turn(segmentTet_, first + number, count + 1);
  turn(crossings_.points, first, count);
  turn(crossings_.parameters, first, count);
  turn(crossings_.generatorTet, first, count);
  turn(crossings_.generatorCorners, first, count);
  for (std::size_t i = 0; i < count; ++i) {
    crossings_.parameters[first + i] = 1 - crossings_.parameters[first + i];
  }
}

/// Of an arc whose parameters are certain to be in (0, 1).
void EdgeReplay::smooth(Index first, std::size_t count) {
  double before = EdgeTracer::kLeastParameter;
  for (std::size_t i = 0; i < count; ++i) {
    double& parameter = crossings_.parameters[first + i];
    parameter = before = EdgeTracer::smooth(parameter, before);
  }
}

/// Traces the edge from its midpoint.
void EdgeReplay::traceFromMiddle(const FollowedEdge& followed, Faces faces) {
  const SimplexInTet middle = ownedMiddle(findMiddle(followed, faces));
  const ChartEdge edge = ChartEdge{middle.frame.origin, middle.frame.axes[0]}.ascending();
  const std::size_t before = pieces_.points();
  const int axis = axisOf(edge.along);
  const auto ends = tracer_.trace({middle.tet, middle.simplex, Frame::along(edge.z, axis)});
  addArcOfPieces(ends, before, middle.tet, edge);
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
