#include <algorithm>
#include <cmath>
#include <utility>

#include <curved/edge_replay.hpp>

namespace hexhex {

void EdgeReplay::clear() noexcept {
  arcs_.clear();
  keys_.clear();
  points_ = 0;
  pieces_.clear();
}

/// @param followed  of a block; once between calls of clear()
void EdgeReplay::add(const FollowedEdges& followed) {
  // First all crossings, in a loop that knows nothing of edges: how many faces these cross is as
  // good as random.
  cross(followed.faces);
  arcs_.reserve(followed.edges.size());
  Index first = 0;
  for (const FollowedEdge& edge : followed.edges) {
    const Index end = edge.faceEnd;
    const bool isInside = end > first || edge.inside;
    if (isInside && counts_[end].unsure == counts_[first].unsure) {
      addSure(edge, first, followed);
    } else {
      addUnsure(edge, Faces(followed.faces).subspan(first, end - first));
    }
    first = end;
  }
}

void EdgeReplay::cross(Faces faces) {
  crossings_.resize(faces.size());
  counts_.resize(faces.size() + 1);
  Counts sum;
  counts_[0] = sum;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const Counts counts = cross(faces[i], crossings_[i]);
    sum.unsure += counts.unsure;
    sum.jumps += counts.jumps;
    sum.early += counts.early;
    counts_[i + 1] = sum;
  }
}

EdgeReplay::Counts EdgeReplay::cross(const FollowedFace& face, Crossing& crossing) const {
  const HalfFace mate = map_.topology.mate[face.halfFace];
  const HalfFace owned = std::min(face.halfFace, mate);  // of the smaller tet
  const Index owner = tetOf(owned);
  const int local = localOf(owned);
  const bool isJump = map_.exact.transitions.isJump(face.halfFace);
  ChartEdge edge{face.z, face.along};
  if (isJump && owned == mate) edge = behind(face);
  const OwnersFace ownersFace(map_.exact.corners[owner], local);
  const FaceCrossing rough =
      crossAt(shareRoughly(ownersFace, edge, unit_), ownersFace, edge, unit_);
  const FacePoints corners = pointsOf(map_.topology.tets[owner], local, map_.input.view.points);
  crossing = {
      pointInFace(rough.shares, corners), rough.parameter, {owner, faceMask(local)}, tetOf(mate)};
  const double fromMiddle = rough.parameter - 0.5;
  const double distance = std::abs(fromMiddle);
  const bool isSure = rough.inside && distance < 0.5 - rough.error && distance > rough.error;
  return {isSure ? 0U : 1U, isJump ? 1U : 0U, fromMiddle < 0 ? 1U : 0U};
}

/// Adds an edge that passes through the interiors of faces and tets, and its midpoint through that
/// of a tet, along the axis of this one.
/// @param first  its first crossing
void EdgeReplay::addSure(const FollowedEdge& edge, Index first, const FollowedEdges& followed) {
  const Index end = edge.faceEnd;
  const Index middleAt = first + counts_[end].early - counts_[first].early;
  ChartEdge middle{edge.z, edge.along};
  if (counts_[end].jumps != counts_[first].jumps && middleAt > first) {
    middle = behind(followed.faces[middleAt - 1]);
  }
  const bool reversed = signOf(middle.along) < 0;
  arcs_.push_back({{edge.ends[reversed ? 1 : 0], edge.ends[reversed ? 0 : 1]},
                   first,
                   end - first,
                   edge.tet,
                   reversed});
  points_ += end - first;
  addKey(middleAt > first ? crossings_[middleAt - 1].behind : edge.tet, middle);
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
  addArcOfPieces(ends, points);
  addKey(exactly_.owner(), middle);
}

void EdgeReplay::addArcOfPieces(const std::array<Index, 2>& ends, std::size_t firstPoint) {
  EdgeTracer::smoothParameters(pieces_, firstPoint);
  const auto number = static_cast<Index>(pieces_.arcs());
  pieces_.addArc(ends, firstPoint);
  arcs_.push_back({ends, number, 0, kNone, false});
  points_ += pieces_.points() - firstPoint;
}

void EdgeReplay::copyTo(Arcs& to, std::uint64_t firstArc, std::uint64_t firstPoint) const {
  std::uint64_t number = firstArc;
  std::uint64_t point = firstPoint;
  for (const Arc& arc : arcs_) {
    to.ends[number] = arc.ends;
    to.pointBegin[number] = point;
    if (arc.tet != kNone) {
      copySure(arc, to, number, point);
      point += arc.count;
    } else {
      pieces_.copyArc(arc.first, to, number, point);
      point += pieces_.pointsOf(arc.first);
    }
    ++number;
  }
}

void EdgeReplay::copySure(const Arc& arc, Arcs& to, std::uint64_t number,
                          std::uint64_t firstPoint) const {
  const Crossing* const crossings = crossings_.data() + arc.first;
  const std::size_t count = arc.count;
  double low = EdgeTracer::kLeastParameter;
  for (std::size_t i = 0; i < count; ++i) {
    const Crossing& crossing = crossings[arc.reversed ? count - 1 - i : i];
    const std::uint64_t place = firstPoint + i;
    to.points[place] = crossing.point;
    low = EdgeTracer::smooth(arc.reversed ? 1 - crossing.parameter : crossing.parameter, low);
    to.parameters[place] = low;
    to.generatorTet[place] = crossing.generator.tet;
    to.generatorCorners[place] = crossing.generator.corners;
  }
  const std::uint64_t firstSegment = firstPoint + number;
  for (std::size_t i = 0; i <= count; ++i) {
    const std::uint64_t place = firstSegment + (arc.reversed ? count - i : i);
    to.segmentTet[place] = i == 0 ? arc.tet : crossings[i - 1].behind;
    to.segmentCorners[place] = kWholeTet;
  }
}

/// Traces the edge from its midpoint.
void EdgeReplay::traceFromMiddle(const FollowedEdge& followed, Faces faces) {
  const SimplexInTet middle = ownedMiddle(findMiddle(followed, faces));
  const ChartEdge edge = ChartEdge{middle.frame.origin, middle.frame.axes[0]}.ascending();
  const std::size_t before = pieces_.points();
  const int axis = axisOf(edge.along);
  const auto ends = tracer_.trace({middle.tet, middle.simplex, Frame::along(edge.z, axis)});
  addArcOfPieces(ends, before);
  addKey(middle.tet, edge);
}

/// A simplex with the midpoint, in one of the tets that the edge was followed through.
SimplexInTet EdgeReplay::findMiddle(const FollowedEdge& followed, Faces faces) const {
  ChartEdge at{followed.z, followed.along};
  Index tet = followed.tet;
  for (std::size_t i = 0;; ++i) {
    const ChartEdge edge = at.ascending();
    const int axis = axisOf(edge.along);
    LatticePoint middle;
    for (std::size_t k = 0; k < 3; ++k) middle[k] = edge.z[k] * unit_;
    middle[static_cast<std::size_t>(axis)] += unit_ / 2;
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
