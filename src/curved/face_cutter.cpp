#include <algorithm>
#include <cmath>
#include <string>

#include <curved/face_cutter.hpp>
#include <curved/simplex_point.hpp>

namespace hexhex {

namespace {

[[noreturn]] void fail(Index tet, const char* what) {
  throw Error(ErrorCode::Internal,
              std::string("Cutting a hex face failed: ") + what +
                  ". The map passed all checks, so this is a bug; please report it with the map.",
              {PlaceKind::Tet, tet});
}

/// Corners of the square, counter-clockwise.
constexpr std::array<GridPoint, 4> kSquareCorners = {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}};

/// The square's frame, turned so that a side of the square becomes the first axis.
Frame alongSide(const Frame& frame, std::size_t side) {
  Frame turned = frame;
  turned.origin = frame.at(kSquareCorners[side]);
  for (std::size_t i = 0; i < side; ++i) {
    turned.axes = {turned.axes[1], opposite(turned.axes[0]), turned.axes[2]};
  }
  return turned;
}

/// (u, v) at a place along a side.
std::array<double, 2> onSide(std::size_t side, double t) {
  switch (side) {
    case 0:
      return {t, 0};
    case 1:
      return {1, t};
    case 2:
      return {1 - t, 1};
    default:
      return {0, 1 - t};
  }
}

/// Weights of the point where the plane crosses an edge, or of a vertex.
std::array<double, 4> crossingOfPlane(const LatticeTet& seen, CornerMask simplex) {
  const std::size_t i = firstCorner(simplex);
  const std::size_t j = lastCorner(simplex);
  if (i == j) return SimplexPoint::corner(i).normalized();
  return SimplexPoint::between(i, j, seen[i][2], seen[j][2]).normalized();
}

/// Rounded coordinate along a side of the square of a corner of a slice on it.
double placeOnSide(const LatticeTet& seen, const SliceCorner& corner, std::size_t side,
                   std::int64_t unit) {
  const std::size_t along = side % 2;
  const std::size_t across = 1 - along;
  LatticeTet moved = seen;
  if (side == 1 || side == 2) {
    for (LatticePoint& p : moved) p[across] -= unit;
  }
  SimplexPoint point = SimplexPoint::corner(firstCorner(corner.simplex));
  if (dimension(corner.simplex) == 2) {
    point = crossingOfFace(moved, oppositeCorner(corner.simplex), along);
  } else if (dimension(corner.simplex) == 1) {
    const std::size_t i = firstCorner(corner.simplex);
    const std::size_t j = lastCorner(corner.simplex);
    const std::size_t axis = moved[i][across] != moved[j][across] ? across : 2;
    point = SimplexPoint::between(i, j, moved[i][axis], moved[j][axis]);
  }
  return coordinate(point.normalized(), seen, along) / static_cast<double>(unit);
}

/// The simplex of a tet that holds the origin, or kNoSimplex.
CornerMask simplexOfOrigin(const LatticeTet& corners) {
  std::array<std::array<double, 3>, 4> c;
  std::array<double, 3> reach{};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      c[i][k] = static_cast<double>(corners[i][k]);
      reach[k] = std::max(reach[k], std::abs(c[i][k]));
    }
  }
  // Each volume is a sum of six products with at most eight roundings each: an error below
  // 6 * 8.1 * 2^-53 < 2^-47 times the largest product. 2^-46 leaves a factor of two.
  const double error = 0x1p-46 * reach[0] * reach[1] * reach[2];
  CornerMask simplex = kNoSimplex;
  for (int face = 0; face < 4; ++face) {
    const std::array<int, 3>& f = kFaceCorners[static_cast<std::size_t>(face)];
    const auto i = static_cast<std::size_t>(f[0]);
    const auto j = static_cast<std::size_t>(f[1]);
    const auto k = static_cast<std::size_t>(f[2]);
    const double outside = c[i][2] * (c[j][0] * c[k][1] - c[j][1] * c[k][0]) +
                           c[j][2] * (c[k][0] * c[i][1] - c[k][1] * c[i][0]) +
                           c[k][2] * (c[i][0] * c[j][1] - c[i][1] * c[j][0]);
    const int side = std::abs(outside) > error
                         ? (outside < 0 ? 1 : -1)
                         : orientation(corners[i], corners[j], corners[k], {0, 0, 0});
    if (side < 0) return kNoSimplex;
    if (side > 0) simplex = static_cast<CornerMask>(simplex | cornerBit(face));
  }
  return simplex;
}

std::array<double, 2> ofSquareCorner(std::size_t corner) { return onSide(corner, 0); }

}  // namespace

std::size_t& FaceCutter::Lists::operator[](Index key) {
  const Index number = keys.insert(key);
  if (number == first.size()) first.push_back(kLast);
  return first[number];
}

FaceCutter::Border FaceCutter::cut(Index tet, const Element& face) {
  // The face's axis is its normal.
  Frame frame = Frame::along(face.z, (face.axis + 1) % 3);
  Border border;
  if (cutInsideOneTet(tet, frame, border)) return border;
  collectPieces({tet, face.simplex, frame});
  findArcs(border);
  setVertices(border, input_.arcs, tet);
  for (Piece& piece : pieces_) emit(border, piece);
  border.polygons = static_cast<std::uint32_t>(pieces_.size());
  return border;
}

/// A face with all corners in one closed tet is one polygon.
bool FaceCutter::cutInsideOneTet(Index tet, const Frame& frame, Border& border) {
  std::array<CornerMask, 4> simplices{};
  CornerMask carrier = kNoSimplex;
  for (std::size_t i = 0; i < 4; ++i) {
    const LatticeNumbers::Found found =
        input_.vertices.find(tet, frame.at(kSquareCorners[i]), vertexHints_[i]);
    if (found.vertex == kNone) return false;
    border.vertices[i] = found.vertex;
    simplices[i] = found.simplex;
    carrier = static_cast<CornerMask>(carrier | found.simplex);
  }
  for (std::size_t i = 0; i < 4; ++i) {
    const auto middle = static_cast<CornerMask>(simplices[i] | simplices[(i + 1) % 4]);
    setArc(border, i, {tet, middle, alongSide(frame, i)});
    put(border.vertices[i], ofSquareCorner(i));
  }
  out_.cornerCounts.push_back(4);
  out_.carriers.push_back(ownedBy(topology_, tet, carrier));
  border.polygons = 1;
  return true;
}

void FaceCutter::collectPieces(const SimplexInTet& center) {
  pieces_.clear();
  piecesOfTet_.clear();
  inner_.clear();
  innerAtVertex_.clear();
  // A tet or triangle of the plane whose closure contains the centre meets the open square.
  const bool found = star_.visit(center, [&](const SimplexInTet& here) {
    const CornerMask carrier = carrierOfPlane(see(here));
    if (carrier == kNoSimplex) return false;
    addPiece({here.tet, carrier, here.frame});
    return true;
  });
  if (!found) fail(center.tet, "no tet around the centre meets the face");
  for (std::size_t head = 0; head < pieces_.size(); ++head) addNeighbours(head);
}

/// Adds a piece if it is new.
void FaceCutter::addPiece(SimplexInTet carrier, int entered, std::size_t from,
                          std::size_t fromSide) {
  if (carrier.simplex != kWholeTet) {
    // A triangle has two tets: the smaller one stands for both.
    const int face = oppositeCorner(carrier.simplex);
    const HalfFace mate = topology_.mate[halfFaceOf(carrier.tet, face)];
    if (mate != kNone && tetOf(mate) < carrier.tet) {
      carrier = crossed(topology_, exact_, carrier, face);
    }
  }
  std::size_t& first = piecesOfTet_[carrier.tet];
  for (std::size_t i = first; i != kLast; i = pieces_[i].next) {
    const SimplexInTet& known = pieces_[i].carrier;
    if (known.simplex == carrier.simplex && known.frame == carrier.frame) return;
  }
  const LatticeTet seen = see(carrier);
  const Slice slice = sliceSquare(seen, carrier.simplex, exact_.unit);
  if (slice.size() < 3) fail(carrier.tet, "a polygon has no area");
  pieces_.push_back({carrier, seen, slice, entered, from, fromSide, first, 0});
  first = pieces_.size() - 1;
}

/// Goes on across the sides that do not lie on the square's border.
void FaceCutter::addNeighbours(std::size_t piece) {
  const std::size_t size = pieces_[piece].slice.size();
  for (std::size_t i = 0; i < size; ++i) {
    const std::uint8_t side = pieces_[piece].slice[i].side;
    if (side >= kSquareSide) continue;
    SimplexInTet at{pieces_[piece].carrier.tet, side, pieces_[piece].carrier.frame};
    if (dimension(side) == 2) {
      const int face = oppositeCorner(side);
      if (face == pieces_[piece].entered) continue;
      const HalfFace mate = topology_.mate[halfFaceOf(at.tet, face)];
      if (mate == kNone) fail(at.tet, "a face leaves the mesh");
      at.simplex = kWholeTet;
      addPiece(crossed(topology_, exact_, at, face), localOf(mate), piece, i);
      continue;
    }
    // Two pieces meet in an edge of the plane, somewhere around it.
    star_.visit(at, [&](const SimplexInTet& here) {
      const CornerMask carrier = carrierOfPlane(see(here));
      if (carrier != kNoSimplex) addPiece({here.tet, carrier, here.frame});
      return false;
    });
  }
}

/// Finds the arc along each side of the square, by its midpoint.
void FaceCutter::findArcs(Border& border) {
  unsigned found = 0;
  for (const Piece& piece : pieces_) {
    for (std::size_t i = 0; i < piece.slice.size() && found != 15U; ++i) {
      if (piece.slice[i].side < kSquareSide) continue;
      const std::size_t side = piece.slice[i].side - kSquareSide;
      if (((found >> side) & 1U) != 0) continue;
      const CornerMask simplex = simplexOfMidpoint(piece.seen, side);
      if (simplex == kNoSimplex) continue;
      found |= 1U << side;
      setArc(border, side, {piece.carrier.tet, simplex, alongSide(piece.carrier.frame, side)});
    }
  }
  if (found != 15U) fail(pieces_.front().carrier.tet, "a side was not found");
}

/// The simplex of a tet that holds the midpoint of a side, or kNoSimplex.
CornerMask FaceCutter::simplexOfMidpoint(const LatticeTet& corners, std::size_t side) const {
  const std::int64_t unit = exact_.unit;
  const std::array<LatticePoint, 4> midpoints = {
      {{unit / 2, 0, 0}, {unit, unit / 2, 0}, {unit / 2, unit, 0}, {0, unit / 2, 0}}};
  LatticeTet around = corners;
  for (LatticePoint& corner : around) corner = corner - midpoints[side];
  // Most tets at a side are elsewhere along it.
  const std::size_t along = side % 2;
  bool before = true;
  bool behind = true;
  for (const LatticePoint& corner : around) {
    before = before && corner[along] < 0;
    behind = behind && corner[along] > 0;
  }
  if (before || behind) return kNoSimplex;
  return simplexOfOrigin(around);
}

/// Looks an arc up in the tet that owns its midpoint.
void FaceCutter::setArc(Border& border, std::size_t side, const SimplexInTet& midpoint) {
  const Index owner = ownerTet(topology_, midpoint.tet, midpoint.simplex);
  Frame frame = midpoint.frame;
  if (owner != midpoint.tet) {
    const bool found = star_.visit(midpoint, [&](const SimplexInTet& here) {
      frame = here.frame;
      return here.tet == owner;
    });
    if (!found) fail(midpoint.tet, "the owner of an edge was not found");
  }
  const bool reversed = signOf(frame.axes[0]) < 0;
  const GridPoint smaller = reversed ? frame.at({1, 0, 0}) : frame.origin;
  border.arcs[side] = input_.edges.find(owner, axisOf(frame.axes[0]), smaller, arcHints_[side]);
  if (reversed) border.reversed = static_cast<std::uint8_t>(border.reversed | (1U << side));
}

/// Arcs know their ends; those of neighbouring sides must agree.
void FaceCutter::setVertices(Border& border, const Arcs& arcs, Index tet) {
  std::array<std::array<Index, 2>, 4> ends{};
  for (std::size_t i = 0; i < 4; ++i) {
    ends[i] = arcs.ends[border.arcs[i]];
    if (((border.reversed >> i) & 1U) != 0) std::swap(ends[i][0], ends[i][1]);
  }
  for (std::size_t i = 0; i < 4; ++i) {
    border.vertices[i] = ends[i][0];
    if (ends[i][0] != ends[(i + 3) % 4][1]) fail(tet, "its sides do not close");
  }
}

void FaceCutter::put(std::uint64_t number, std::array<double, 2> parameter) {
  out_.corners.push_back(static_cast<Index>(number));
  out_.parameters.push_back(parameter);
}

/// Corners that the piece shares with the one that it was found from are known.
void FaceCutter::emit(const Border& border, Piece& piece) {
  piece.firstCorner = out_.corners.size();
  const std::size_t size = piece.slice.size();
  const std::uint8_t entry = piece.entered < 0 ? kNoSimplex : faceMask(piece.entered);
  for (std::size_t i = 0; i < size; ++i) {
    const bool begins = piece.slice[i].side == entry;
    const bool ends = piece.slice[i == 0 ? size - 1 : i - 1].side == entry;
    if (!begins && !ends) {
      emitCorner(border, piece, piece.slice[i]);
      continue;
    }
    // There the side runs the other way.
    const Piece& from = pieces_[piece.from];
    const std::size_t after = piece.fromSide + 1 < from.slice.size() ? piece.fromSide + 1 : 0;
    const std::size_t known = from.firstCorner + (begins ? after : piece.fromSide);
    put(out_.corners[known], out_.parameters[known]);
  }
  out_.cornerCounts.push_back(static_cast<std::uint32_t>(size));
  // Pieces are named by the owners of their carriers already.
  out_.carriers.push_back({piece.carrier.tet, piece.carrier.simplex});
}

void FaceCutter::emitCorner(const Border& border, const Piece& piece, const SliceCorner& corner) {
  if (corner.onBorder(0) && corner.onBorder(1)) {
    put(border.vertices[corner.squareCorner()], ofSquareCorner(corner.squareCorner()));
  } else if (corner.onBorder(0) || corner.onBorder(1)) {
    emitArcPoint(border, piece, corner);
  } else {
    emitInnerPoint(piece, corner);
  }
}

/// A point of an arc is known by the simplex that the arc crosses there. (An arc that crosses one
/// simplex twice comes back through a periodic domain; then the place along the arc decides.)
void FaceCutter::emitArcPoint(const Border& border, const Piece& piece, const SliceCorner& corner) {
  const std::size_t side = corner.squareSide();
  const std::size_t arc = border.arcs[side];
  const bool reversed = ((border.reversed >> side) & 1U) != 0;
  const Arcs& arcs = input_.arcs;
  const std::uint64_t end = arcs.pointBegin[arc + 1];
  const SimplexMatcher matches(topology_, piece.carrier.tet, corner.simplex);
  const auto next = [&](std::uint64_t i) {
    while (i < end && !matches({arcs.generatorTet[i], arcs.generatorCorners[i]})) ++i;
    return i;
  };
  std::uint64_t best = next(arcs.pointBegin[arc]);
  if (best == end) fail(piece.carrier.tet, "a corner of a polygon is no point of its arc");
  for (std::uint64_t i = next(best + 1); i < end; i = next(i + 1)) {
    const double along = placeOnSide(piece.seen, corner, side, exact_.unit);
    const double expected = (side >= 2) == reversed ? along : 1 - along;
    if (std::abs(arcs.parameters[i] - expected) < std::abs(arcs.parameters[best] - expected)) {
      best = i;
    }
  }
  const double t = arcs.parameters[best];
  put(vertexCount_ + best, onSide(side, reversed ? 1 - t : t));
}

/// A point inside the square is known by the vertex or edge of the tets that crosses the square
/// there, and by where the square's frame shows that, which is the same from all tets around. (An
/// edge that crosses a face twice comes back through a periodic domain.)
void FaceCutter::emitInnerPoint(const Piece& piece, const SliceCorner& corner) {
  const Tet& tet = topology_.tets[piece.carrier.tet];
  std::size_t i = firstCorner(corner.simplex);
  std::size_t j = lastCorner(corner.simplex);
  if (tet[j] < tet[i]) std::swap(i, j);
  const LatticeTet& seen = piece.seen;
  std::size_t& first = innerAtVertex_[tet[i]];
  for (std::size_t k = first; k != kLast; k = inner_[k].next) {
    const InnerPoint& known = inner_[k];
    if (known.end == tet[j] && known.seen[0] == seen[i] && known.seen[1] == seen[j]) {
      return put(known.number, known.parameter);
    }
  }
  const std::array<double, 4> shares = crossingOfPlane(seen, corner.simplex);
  const auto unit = static_cast<double>(exact_.unit);
  const std::array<double, 2> parameter = {
      std::clamp(coordinate(shares, seen, 0) / unit, 0.0, 1.0),
      std::clamp(coordinate(shares, seen, 1) / unit, 0.0, 1.0)};
  const std::uint64_t number = firstInnerPoint_ + out_.points.size();
  inner_.push_back({tet[j], {seen[i], seen[j]}, parameter, static_cast<Index>(number), first});
  first = inner_.size() - 1;
  out_.points.push_back(position(shares, tet, input_.map.input.view.points));
  out_.generators.push_back(ownedBy(topology_, piece.carrier.tet, corner.simplex));
  put(number, parameter);
}

}  // namespace hexhex
