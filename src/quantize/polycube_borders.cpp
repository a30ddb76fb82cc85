#include <algorithm>

#include <quantize/polycube_borders.hpp>

#include <base/disjoint_sets.hpp>

namespace hexhex::quantization {

namespace {

std::string nameOf(lattice::Direction label) {
  return {lattice::signOf(label) > 0 ? '+' : '-', static_cast<char>('x' + lattice::axisOf(label))};
}

VertexPair verticesOf(const BoundarySides& sides, BoundarySides::Side side) {
  return pairOf(sides.tail(side), sides.head(side));
}

Place placeOf(const VertexPair& edge) { return {PlaceKind::Edge, edge[0], edge[1]}; }

[[noreturn]] void refusePlanes(const std::string& sentence, const Place& place) {
  throw Error(ErrorCode::FlippedTet,
              "The tets cannot be bent to a polycube that fits the labels: " + sentence +
                  " Look at the labels of the faces there.",
              place);
}

Index triangleOf(BoundarySides::Side side) { return static_cast<Index>(side / 3); }

}  // namespace

BoundarySides::BoundarySides(const adjacency::TetTopology& topology) : topology_(topology) {
  for (adjacency::HalfFace h = 0; h < topology.mate.size(); ++h) {
    if (topology.isBoundary(h)) faces_.push_back(h);
  }
  twins_.resize(3 * faces_.size());
  for (Side side = 0; side < twins_.size(); ++side) {
    const adjacency::HalfFace h = face(side);
    const auto ends = static_cast<lattice::CornerMask>(
        lattice::cornerBit(topology.localCorner(adjacency::tetOf(h), head(side))) |
        lattice::cornerBit(topology.localCorner(adjacency::tetOf(h), tail(side))));
    adjacency::EdgeTurn turn(topology, adjacency::tetOf(h), ends,
                             adjacency::otherFaceAtEdge(ends, adjacency::localOf(h)));
    while (turn.next() != kNone) turn.step();
    const auto found = std::lower_bound(faces_.begin(), faces_.end(), turn.out());
    Side there = 3 * static_cast<Side>(found - faces_.begin());
    while (head(there) != tail(side)) ++there;
    twins_[side] = there;
  }
}

Index BoundarySides::corner(Side side, std::size_t ahead) const noexcept {
  // Corners of a face are in the order that looks inwards.
  const adjacency::HalfFace h = face(side);
  const auto& corners = lattice::kFaceCorners[h % 4];
  return topology_.tets[adjacency::tetOf(h)][static_cast<std::size_t>(corners[(side + ahead) % 3])];
}

PolycubeBorders::PolycubeBorders(const LabelledMesh& mesh)
    : mesh_(mesh), sides_(mesh.topology), borderCount_(mesh.topology.pointCount) {
  for (Side side = 0; side < sides_.size(); ++side) {
    if (!isBorder(side)) continue;
    requireOtherAxes(side);
    borders_.push_back(side);
    ++borderCount_[sides_.tail(side)];
  }
  requireBorderOnEachPiece();
  requireFewBorders();
  requireFourEdges();
}

void PolycubeBorders::requireOtherAxes(Side border) const {
  if (lattice::axisOf(label(border)) != lattice::axisOf(labelBeyond(border))) return;
  const lattice::Direction upper = std::min(label(border), labelBeyond(border));
  throw Error(ErrorCode::InvalidArgument,
              "Triangles with the labels " + nameOf(upper) + " and " +
                  nameOf(lattice::opposite(upper)) +
                  " meet at an edge; opposite faces of a polycube never do. Put triangles with "
                  "another label between them.",
              placeOf(verticesOf(sides_, border)));
}

/// A closed surface faces all ways.
void PolycubeBorders::requireBorderOnEachPiece() const {
  DisjointSets pieces(mesh_.topology.pointCount);
  for (Side side = 0; side < sides_.size(); ++side) {
    pieces.unite(sides_.tail(side), sides_.head(side));
  }
  std::vector<bool> hasBorder(mesh_.topology.pointCount);
  for (const Side border : borders_) hasBorder[pieces.find(sides_.tail(border))] = true;
  for (Side side = 0; side < sides_.size(); ++side) {
    if (hasBorder[pieces.find(sides_.tail(side))]) continue;
    refuseFlag(mesh_, sides_.face(side),
               "All triangles of a closed piece of the boundary have the label " +
                   nameOf(label(side)) + "; that of a polycube faces all six ways.");
  }
}

/// Around a corner, there are two directions along each axis.
void PolycubeBorders::requireFewBorders() const {
  std::vector<std::array<Index, 3>> alongAxes(mesh_.topology.pointCount);
  for (const Side border : borders_) {
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

/// Each loop around a face of a polycube turns by right angles.
void PolycubeBorders::requireFourEdges() const {
  std::vector<bool> isSeen(sides_.size());
  for (const Side first : borders_) {
    if (isSeen[first]) continue;
    int edges = 0;
    Side side = first;
    do {
      isSeen[side] = true;
      const Side next = nextBorder(side);
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

/// Of the same loop, from the head on.
PolycubeBorders::Side PolycubeBorders::nextBorder(Side border) const {
  Side side = BoundarySides::next(border);
  while (!isBorder(side)) side = BoundarySides::next(sides_.twin(side));
  return side;
}

/// Counterclockwise, from the same tail.
PolycubeBorders::Side PolycubeBorders::nextBorderAtTail(Side border) const {
  const auto turned = [this](Side side) {
    return sides_.twin(BoundarySides::next(BoundarySides::next(side)));
  };
  Side side = turned(border);
  while (!isBorder(side)) side = turned(side);
  return side;
}

std::vector<lattice::Direction> PolycubeBorders::directions(const PlaneAt& planeAt) const {
  std::vector<lattice::Direction> directions(sides_.size());
  for (const Side first : borders_) {
    if (!isCorner(sides_.tail(first))) continue;
    Side last = first;
    while (!isCorner(sides_.head(last))) last = nextBorder(last);
    const int axis = axisAlong(first);
    const std::int64_t length =
        planeAt(axis, sides_.head(last)) - planeAt(axis, sides_.tail(first));
    if (length == 0) {
      refusePlanes("from vertex " + std::to_string(sides_.tail(first)) + " to vertex " +
                       std::to_string(sides_.head(last)) + " the edge between " +
                       nameOf(label(first)) + " and " + nameOf(labelBeyond(first)) +
                       " has no length, as its ends are in one plane.",
                   placeOf(verticesOf(sides_, first)));
    }
    for (Side side = first; true; side = nextBorder(side)) {
      directions[side] = lattice::direction(axis, length < 0 ? -1 : 1);
      if (side == last) break;
    }
  }
  return directions;
}

/// Walks around a corner, along edges and over faces.
void PolycubeBorders::requireRoom(Side first,
                                  const std::vector<lattice::Direction>& directions) const {
  std::array<bool, lattice::kDirections> isTaken{};
  bool isInjective = true;
  std::string labels;
  Side side = first;
  do {
    const Side next = nextBorderAtTail(side);
    lattice::Direction at = directions[side];
    do {
      isInjective = isInjective && !isTaken[at];
      isTaken[at] = true;
      at = lattice::cross(label(side), at);
    } while (at != directions[next]);
    labels += (labels.empty() ? "" : ", ") + nameOf(label(side));
    side = next;
  } while (side != first);
  if (isInjective) return;
  refusePlanes("faces overlap around a vertex, whose labels are " + labels +
                   " counterclockwise, with their planes where a map turned towards the labels "
                   "puts them.",
               {PlaceKind::Vertex, sides_.tail(first)});
}

/// Quarter turns to the left around a flat face: four times its Euler characteristic.
void PolycubeBorders::requireFlatFaces(const std::vector<lattice::Direction>& directions) const {
  DisjointSets faces(sides_.size() / 3);
  for (Side side = 0; side < sides_.size(); ++side) {
    if (!isBorder(side)) faces.unite(triangleOf(side), triangleOf(sides_.twin(side)));
  }
  // Vertices and edges of borders are as many; others are left to count.
  std::vector<int> twiceCharacteristic(sides_.size() / 3);
  std::vector<int> turns(sides_.size() / 3);
  std::vector<bool> isSeen(mesh_.topology.pointCount);
  for (Side side = 0; side < sides_.size(); ++side) {
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
  for (Side side = 0; side < sides_.size(); side += 3) {
    const Index face = faces.find(triangleOf(side));
    if (turns[face] == 2 * twiceCharacteristic[face]) continue;
    refusePlanes("the border of a face with the label " + nameOf(label(side)) + " makes " +
                     std::to_string(turns[face]) + " quarter turns to the left, and not " +
                     std::to_string(2 * twiceCharacteristic[face]) +
                     ", with planes where a map turned towards the labels puts them.",
                 mesh_.placeOf(sides_.face(side)));
  }
}

IrregularEdges PolycubeBorders::turns(const PlaneAt& planeAt) const {
  const std::vector<lattice::Direction> along = directions(planeAt);
  for (const Side border : borders_) {
    if (isCorner(sides_.tail(border))) requireRoom(border, along);
  }
  requireFlatFaces(along);
  IrregularEdges quarters;
  for (const Side border : borders_) {
    // From the edge, the face goes to the left.
    const bool isConvex =
        labelBeyond(border) == lattice::opposite(lattice::cross(label(border), along[border]));
    quarters[verticesOf(sides_, border)] = isConvex ? 1 : 3;
  }
  return quarters;
}

}  // namespace hexhex::quantization
