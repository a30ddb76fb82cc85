#include <algorithm>
#include <cmath>
#include <utility>

#include <curved/edge_replay.hpp>

namespace hexhex {

namespace {

/// Computes one of the crossings.
/// @param perUnit  1 / unit
/// @param[in,out] counts  of the crossings before
void crossFollowed(const PreparedMap& map, double perUnit, const FollowedFace& face,
                   std::size_t number, FollowedCrossings& crossings, CrossingCounts& counts) {
  const HalfFace mate = map.topology.mate[face.halfFace];
  const HalfFace owned = std::min(face.halfFace, mate);  // of the smaller tet
  const Index owner = tetOf(owned);
  const int local = localOf(owned);
  const std::int64_t unit = map.exact.unit;
  const bool isJump = map.exact.transitions.isJump(face.halfFace);
  ChartEdge edge{face.z, face.along};
  if (isJump && owned == mate) edge = edge.across(map.exact.transitions, face.halfFace);
  const OwnersFace ownersFace(map.exact.corners[owner], local);
  const FaceCrossing rough =
      crossAt(shareRoughly(ownersFace, edge, unit), ownersFace, edge, unit, perUnit);
  const FacePoints corners = pointsOf(map.topology.tets[owner], local, map.input.view.points);
  crossings.points[number] = pointInFace(rough.shares, corners);
  crossings.parameters[number] = rough.parameter;
  crossings.generatorTet[number] = owner;
  crossings.generatorCorners[number] = faceMask(local);
  crossings.behind[number] = tetOf(mate);
  const double distance = std::abs(rough.parameter - 0.5);
  const bool isSure = rough.inside && distance < 0.5 - rough.error && distance > rough.error;
  counts.unsure += isSure ? 0 : 1;
  counts.jumps += isJump ? 1 : 0;
  counts.early += rough.parameter < 0.5 ? 1 : 0;
}

}  // namespace

void EdgeReplay::add(const FollowedEdges& followed) {
  followed_ = &followed;
  // First all crossings, in a loop that knows nothing of edges: how many faces these cross is as
  // good as random.
  cross(followed.faces);
  points_ = followed.faces.size();
  Index first = 0;
  for (std::size_t i = 0; i < followed.edges.size(); ++i) {
    const FollowedEdge& edge = followed.edges[i];
    if (!isSure(edge, first)) {
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
  crossings_.resize(faces.size());
  counts_.resize(faces.size() + 1);
  CrossingCounts counts;
  counts_[0] = counts;
  const double perUnit = 1 / static_cast<double>(map_.exact.unit);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    crossFollowed(map_, perUnit, faces[i], i, crossings_, counts);
    counts_[i + 1] = counts;
  }
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
  // All points as they are, and then what is different.
  const std::size_t points = edges[run.end - 1].faceEnd - run.crossing;
  const auto copy = [&](const auto& from, auto& target) {
    std::copy_n(from.begin() + run.crossing, points,
                target.begin() + static_cast<std::ptrdiff_t>(place.point));
  };
  copy(crossings_.points, to.points);
  copy(crossings_.parameters, to.parameters);
  copy(crossings_.generatorTet, to.generatorTet);
  copy(crossings_.generatorCorners, to.generatorCorners);
  std::fill_n(to.segmentCorners.begin() + static_cast<std::ptrdiff_t>(place.point + place.arc),
              points + (run.end - run.edge), kWholeTet);
  Index crossing = run.crossing;
  for (const FollowedEdge& edge : edges.subspan(run.edge, run.end - run.edge)) {
    to.pointBegin[place.arc] = place.point;
    finishSure(edge, crossing, to, keys, place);
    place.point += edge.faceEnd - crossing;
    ++place.arc;
    crossing = edge.faceEnd;
  }
  return place;
}

/// Adds what else the arc of a sure edge has, and turns it round if need be, to make it run along
/// the axis of the midpoint's owner.
inline void EdgeReplay::finishSure(const FollowedEdge& edge, Index first, Arcs& to,
                                   std::span<EdgeKey> keys, const Place& place) const {
  const std::size_t count = edge.faceEnd - first;
  const CrossingCounts& upTo = counts_[edge.faceEnd];
  const std::size_t early = upTo.early - counts_[first].early;
  ChartEdge middle{edge.z, edge.along};
  if (upTo.jumps != counts_[first].jumps && early > 0) {
    middle = behind(followed_->faces[first + early - 1]);
  }
  if (!keys.empty()) {
    keys[place.arc] = {early > 0 ? crossings_.behind[first + early - 1] : edge.tet, middle};
  }
  // Most edges cross no face or one. Whether they are turned round is as good as random, so no
  // branch may depend on it.
  const std::size_t reversed = signOf(middle.along) < 0 ? 1 : 0;
  to.ends[place.arc] = {edge.ends[reversed], edge.ends[1 - reversed]};
  Index* const segments = &to.segmentTet[place.point + place.arc];
  if (count == 0) {
    segments[0] = edge.tet;
  } else if (count == 1) {
    segments[reversed] = edge.tet;
    segments[1 - reversed] = crossings_.behind[first];
    double& parameter = to.parameters[place.point];
    parameter = std::array{parameter, 1 - parameter}[reversed];
  } else {
    segments[0] = edge.tet;
    std::copy_n(&crossings_.behind[first], count, segments + 1);
    if (reversed != 0) reverse(to, place, count);
    smooth(to, place, count);
  }
}

/// Turns the points and segments of an arc round.
void EdgeReplay::reverse(Arcs& to, const Place& place, std::size_t count) {
  const auto turn = [](auto& array, std::uint64_t first, std::size_t size) {
    std::reverse(&array[first], &array[first] + size);
  };
  turn(to.segmentTet, place.point + place.arc, count + 1);
  turn(to.points, place.point, count);
  turn(to.parameters, place.point, count);
  turn(to.generatorTet, place.point, count);
  turn(to.generatorCorners, place.point, count);
  for (std::size_t i = 0; i < count; ++i) {
    to.parameters[place.point + i] = 1 - to.parameters[place.point + i];
  }
}

/// Of an arc whose parameters are certain to be in (0, 1).
void EdgeReplay::smooth(Arcs& to, const Place& place, std::size_t count) {
  double before = EdgeTracer::kLeastParameter;
  for (std::size_t i = 0; i < count; ++i) {
    double& parameter = to.parameters[place.point + i];
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
