#include <algorithm>
#include <cstdlib>
#include <map>
#include <utility>

#include <quantize/polycube/borders.hpp>
#include <tetmap/cut.hpp>

#include <base/disjoint_sets.hpp>

namespace hexhex::quantization {

namespace {

tetmap::VertexPair verticesOf(const BoundarySides& sides, BoundarySide side) {
  return tetmap::pairOf(sides.tail(side), sides.head(side));
}

Place placeOf(const tetmap::VertexPair& edge) { return {PlaceKind::Edge, edge[0], edge[1]}; }

[[noreturn]] void refusePlanes(const std::string& sentence, const Place& place) {
  throw Error(ErrorCode::FlippedTet,
              "The tets cannot be bent to a polycube that fits the labels: " + sentence +
                  " Look at the labels of the faces there.",
              place);
}

Index triangleOf(BoundarySide side) { return static_cast<Index>(side / 3); }

}  // namespace

std::string nameOf(lattice::Direction label) {
  return {lattice::signOf(label) > 0 ? '+' : '-', static_cast<char>('x' + lattice::axisOf(label))};
}

PolycubeBorders::PolycubeBorders(const LabelledMesh& mesh)
    : mesh_(mesh), sides_(mesh.topology), borderCount_(mesh.topology.pointCount) {
  for (BoundarySide side = 0; side < sides_.size(); ++side) {
    if (!isBorder(side)) continue;
    requireOtherAxes(side);
    borders_.push_back(side);
    ++borderCount_[sides_.tail(side)];
  }
  requireBorderOnEachPiece();
  requireFewBorders();
  requireFourEdges();
}

void PolycubeBorders::requireOtherAxes(BoundarySide border) const {
  if (lattice::axisOf(label(border)) != lattice::axisOf(labelBeyond(border))) return;
  const lattice::Direction upper = std::min(label(border), labelBeyond(border));
  throw Error(ErrorCode::InvalidArgument,
              "Triangles with the labels " + nameOf(upper) + " and " +
                  nameOf(lattice::opposite(upper)) +
                  " meet at an edge; opposite faces of a polycube never do. Put triangles with "
                  "another label between them.",
              placeOf(verticesOf(sides_, border)));
}

/// The normals of a closed surface point in all directions, so one label cannot suffice.
void PolycubeBorders::requireBorderOnEachPiece() const {
  DisjointSets pieces(mesh_.topology.pointCount);
  for (BoundarySide side = 0; side < sides_.size(); ++side) {
    pieces.unite(sides_.tail(side), sides_.head(side));
  }
  std::vector<bool> hasBorder(mesh_.topology.pointCount);
  for (const BoundarySide border : borders_) hasBorder[pieces.find(sides_.tail(border))] = true;
  for (BoundarySide side = 0; side < sides_.size(); ++side) {
    if (hasBorder[pieces.find(sides_.tail(side))]) continue;
    refuseFlag(mesh_, sides_.face(side),
               "All triangles of a closed piece of the boundary have the label " +
                   nameOf(label(side)) + "; that of a polycube faces all six ways.");
  }
}

/// A corner has at most two edges along each axis.
void PolycubeBorders::requireFewBorders() const {
  std::vector<std::array<Index, 3>> alongAxes(mesh_.topology.pointCount);
  for (const BoundarySide border : borders_) {
    const Index vertex = sides_.tail(border);
    if (++alongAxes[vertex][static_cast<std::size_t>(axisAlong(border))] <= 2) continue;
    throw Error(ErrorCode::InvalidArgument,
                "More than two edges of the polycube would run along one axis at a vertex, between "
                "the labels " +
                    nameOf(label(border)) + " and " + nameOf(labelBeyond(border)) +
                    " and others of their axes. Label triangles around it otherwise.",
                {PlaceKind::Vertex, vertex});
  }
}

/// The border of a polycube face turns by right angles, hence has at least four edges.
void PolycubeBorders::requireFourEdges() const {
  std::vector<bool> isSeen(sides_.size());
  for (const BoundarySide first : borders_) {
    if (isSeen[first]) continue;
    int edges = 0;
    BoundarySide side = first;
    do {
      isSeen[side] = true;
      const BoundarySide next = nextBorder(side);
      edges += axisAlong(next) != axisAlong(side) ? 1 : 0;
      side = next;
    } while (side != first);
    if (edges >= 4) continue;
    refuseFlag(mesh_, sides_.face(first),
               "Triangles with the label " + nameOf(label(first)) + " have a border of " +
                   (edges == 0 ? "no straight edges" : std::to_string(edges) + " straight edges") +
                   "; around a face of a polycube there are four at least, which labels beyond "
                   "separate by their axes. Merge the triangles with their neighbours, or give "
                   "those other labels.");
  }
}

/// The next border side in the same loop, which starts at the head.
BoundarySide PolycubeBorders::nextBorder(BoundarySide border) const {
  BoundarySide side = BoundarySides::next(border);
  while (!isBorder(side)) side = BoundarySides::next(sides_.twin(side));
  return side;
}

/// The next border side with the same tail, counterclockwise.
BoundarySide PolycubeBorders::nextBorderAtTail(BoundarySide border) const {
  const auto turned = [this](BoundarySide side) {
    return sides_.twin(BoundarySides::next(BoundarySides::next(side)));
  };
  BoundarySide side = turned(border);
  while (!isBorder(side)) side = turned(side);
  return side;
}

/// Each edge of the polycube, from corner to corner, contributes from both of its sides.
std::vector<PolycubeBorders::Gap> PolycubeBorders::gaps(const PlaneAt& planeAt) const {
  std::map<std::array<std::int64_t, 3>, Gap> gaps;
  for (const BoundarySide first : borders_) {
    if (!isCorner(sides_.tail(first))) continue;
    BoundarySide last = first;
    while (!isCorner(sides_.head(last))) last = nextBorder(last);
    const int axis = axisAlong(first);
    const std::int64_t begin = planeAt(axis, sides_.tail(first));
    const std::int64_t end = planeAt(axis, sides_.head(last));
    if (begin == end) {
      refusePlanes("from vertex " + std::to_string(sides_.tail(first)) + " to vertex " +
                       std::to_string(sides_.head(last)) + " the edge between " +
                       nameOf(label(first)) + " and " + nameOf(labelBeyond(first)) +
                       " has no length, as its ends are in one plane.",
                   placeOf(verticesOf(sides_, first)));
    }
    Gap& gap = gaps[{axis, std::min(begin, end), std::max(begin, end)}];
    gap.width = std::abs(end - begin);
    gap.corners.push_back(cornerAt(first));
    for (BoundarySide side = first; true; side = nextBorder(side)) {
      (begin < end ? gap.upwards : gap.downwards).push_back(side);
      if (side == last) break;
    }
  }
  std::vector<Gap> list;
  for (auto& [planes, gap] : gaps) {
    sortUnique(gap.corners);
    list.push_back(std::move(gap));
  }
  std::stable_sort(list.begin(), list.end(),
                   [](const Gap& a, const Gap& b) { return a.width < b.width; });
  return list;
}

/// Orients the edges of a gap as most of their length runs in space.
void PolycubeBorders::turnAsInSpace(Gap& gap) const {
  const auto rise = [this](const std::vector<BoundarySide>& borders) {
    double sum = 0;
    for (const BoundarySide side : borders) {
      const auto axis = static_cast<std::size_t>(axisAlong(side));
      const auto& points = mesh_.input.view.points;
      sum += points[sides_.head(side)][axis] - points[sides_.tail(side)][axis];
    }
    return sum;
  };
  if (rise(gap.upwards) < rise(gap.downwards)) gap.upwards.swap(gap.downwards);
}

void PolycubeBorders::setDirections(const Gap& gap,
                                    std::vector<lattice::Direction>& directions) const {
  for (const BoundarySide side : gap.upwards)
    directions[side] = lattice::direction(axisAlong(side), 1);
  for (const BoundarySide side : gap.downwards)
    directions[side] = lattice::direction(axisAlong(side), -1);
}

std::size_t PolycubeBorders::countOverlaps(
    const Gap& gap, const std::vector<lattice::Direction>& directions) const {
  return static_cast<std::size_t>(
      std::count_if(gap.corners.begin(), gap.corners.end(),
                    [&](BoundarySide corner) { return !hasRoom(corner, directions); }));
}

/// Identifies a corner by the smallest border side that starts at it.
BoundarySide PolycubeBorders::cornerAt(BoundarySide border) const {
  BoundarySide least = border;
  for (BoundarySide side = nextBorderAtTail(border); side != border;
       side = nextBorderAtTail(side)) {
    least = std::min(least, side);
  }
  return least;
}

/// The map that gave the planes follows the labels but need not be injective, so planes close to
/// each other may be in the wrong order. Swaps pairs of planes, the closest first, while that
/// reduces the number of corners with overlapping faces.
std::vector<lattice::Direction> PolycubeBorders::directions(std::vector<Gap> gaps) const {
  std::vector<lattice::Direction> directions(sides_.size());
  for (const Gap& gap : gaps) setDirections(gap, directions);
  const auto turnOver = [&](Gap& gap) {
    gap.upwards.swap(gap.downwards);
    setDirections(gap, directions);
  };
  const auto improves = [&](Gap& gap) {
    const std::size_t before = countOverlaps(gap, directions);
    if (before == 0) return false;
    turnOver(gap);
    if (countOverlaps(gap, directions) < before) return true;
    turnOver(gap);
    return false;
  };
  // Terminates, as each swap reduces the number of such corners.
  while (std::any_of(gaps.begin(), gaps.end(), improves)) {
  }
  return directions;
}

/// Walks around a corner, along edges and across faces.
bool PolycubeBorders::hasRoom(BoundarySide first,
                              const std::vector<lattice::Direction>& directions) const {
  std::array<bool, lattice::kDirections> isTaken{};
  BoundarySide side = first;
  do {
    const BoundarySide next = nextBorderAtTail(side);
    lattice::Direction at = directions[side];
    do {
      if (isTaken[at]) return false;
      isTaken[at] = true;
      at = lattice::cross(label(side), at);
    } while (at != directions[next]);
    side = next;
  } while (side != first);
  return true;
}

void PolycubeBorders::requireRoom(BoundarySide first,
                                  const std::vector<lattice::Direction>& directions) const {
  if (hasRoom(first, directions)) return;
  std::string labels;
  BoundarySide side = first;
  do {
    labels += (labels.empty() ? "" : ", ") + nameOf(label(side));
    side = nextBorderAtTail(side);
  } while (side != first);
  refusePlanes("faces overlap around a vertex, whose labels are " + labels +
                   " counterclockwise, with their planes where a map turned towards the labels "
                   "puts them.",
               {PlaceKind::Vertex, sides_.tail(first)});
}

/// Along the border of a flat face, the number of left quarter turns, less that of right ones, is
/// four times the Euler characteristic of the face.
std::optional<PolycubeBorders::Turns> PolycubeBorders::wrongTurns(
    const std::vector<lattice::Direction>& directions) const {
  DisjointSets faces(sides_.size() / 3);
  for (BoundarySide side = 0; side < sides_.size(); ++side) {
    if (!isBorder(side)) faces.unite(triangleOf(side), triangleOf(sides_.twin(side)));
  }
  // Along borders there are as many vertices as edges, so only inner ones count.
  std::vector<int> twiceCharacteristic(sides_.size() / 3);
  std::vector<int> turns(sides_.size() / 3);
  std::vector<bool> isSeen(mesh_.topology.pointCount);
  for (BoundarySide side = 0; side < sides_.size(); ++side) {
    const Index face = faces.find(triangleOf(side));
    if (side % 3 == 0) twiceCharacteristic[face] += 2;
    if (isBorder(side)) {
      const lattice::Direction next = directions[nextBorder(side)];
      if (next != directions[side]) {
        turns[face] += next == lattice::cross(label(side), directions[side]) ? 1 : -1;
      }
      continue;
    }
    --twiceCharacteristic[face];
    const Index vertex = sides_.tail(side);
    if (borderCount_[vertex] == 0 && !isSeen[vertex]) twiceCharacteristic[face] += 2;
    isSeen[vertex] = true;
  }
  for (BoundarySide side = 0; side < sides_.size(); side += 3) {
    const Index face = faces.find(triangleOf(side));
    const int expected = 2 * twiceCharacteristic[face];
    if (turns[face] != expected) return Turns{side, turns[face], expected};
  }
  return std::nullopt;
}

bool PolycubeBorders::isPolycube(const std::vector<lattice::Direction>& directions) const {
  return std::all_of(borders_.begin(), borders_.end(),
                     [&](BoundarySide border) {
                       return !isCorner(sides_.tail(border)) || hasRoom(border, directions);
                     }) &&
         !wrongTurns(directions);
}

void PolycubeBorders::requirePolycube(const std::vector<lattice::Direction>& directions) const {
  for (const BoundarySide border : borders_) {
    if (isCorner(sides_.tail(border))) requireRoom(border, directions);
  }
  const std::optional<Turns> wrong = wrongTurns(directions);
  if (!wrong) return;
  refusePlanes("the border of a face with the label " + nameOf(label(wrong->at)) + " makes " +
                   std::to_string(wrong->found) + " quarter turns to the left, and not " +
                   std::to_string(wrong->expected) +
                   ", with planes where a map turned towards the labels puts them.",
               mesh_.placeOf(sides_.face(wrong->at)));
}

std::vector<PolycubeEdge> PolycubeBorders::edges(const PlaneAt& planeAt) const {
  std::vector<Gap> all = gaps(planeAt);
  std::vector<lattice::Direction> along = directions(all);
  if (!isPolycube(along)) {
    for (Gap& gap : all) turnAsInSpace(gap);
    const std::vector<lattice::Direction> inSpace = directions(std::move(all));
    if (!isPolycube(inSpace)) requirePolycube(along);
    along = inSpace;
  }
  std::vector<PolycubeEdge> edges;
  for (const BoundarySide border : borders_) {
    if (sides_.head(border) < sides_.tail(border)) continue;  // each edge once
    // The face lies to the left of its border.
    const bool isConvex =
        labelBeyond(border) == lattice::opposite(lattice::cross(label(border), along[border]));
    edges.push_back({verticesOf(sides_, border),
                     {label(border), labelBeyond(border)},
                     along[border],
                     isConvex ? 1 : 3});
  }
  return edges;
}

}  // namespace hexhex::quantization
