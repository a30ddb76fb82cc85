#include <algorithm>

#include <curved/face_cutter.hpp>

namespace hexhex::curved {

std::size_t FaceCutter::cut(Index tet, const Element& face) {
  // The face's axis is its normal.
  const SimplexInTet center{tet, face.simplex, Frame::along(face.z, (face.axis + 1) % 3)};
  const SeenTet seen = see(center);
  border_.begin();
  if (FaceBorder::mayContainAll(seen, exact_.unit)) {
    const lattice::CornerMask carrier = border_.setInsideOneTet(tet, center.frame);
    if (carrier != lattice::kNoSimplex) {
      cutInsideOneTet(tet, carrier);
      return 1;
    }
  }
  pieceCount_ = 0;
  piecesOfTet_.clear();
  inner_.clear();
  innerAtEdge_.clear();
  addFirstPiece(center, seen);
  for (std::size_t head = 0; head < pieceCount_; ++head) addNeighbours(head);
  border_.finish(tet);
  for (std::size_t i = 0; i < pieceCount_; ++i) emit(pieces_[i]);
  return pieceCount_;
}

/// A face with all corners in one closed tet is a single polygon.
void FaceCutter::cutInsideOneTet(Index tet, lattice::CornerMask carrier) {
  Index* const corners = out_.corners.extend(4);
  std::array<double, 2>* const parameters = out_.parameters.extend(4);
  for (std::size_t i = 0; i < 4; ++i) {
    const PatchPoint vertex = border_.vertex(i);
    corners[i] = vertex.number;
    parameters[i] = vertex.parameter;
  }
  out_.cornerCounts.add(4);
  out_.carriers.add(ownedBy(topology_, tet, carrier));
}

/// Any tet, or any triangle in the plane, whose closure contains the centre meets the open square.
/// @param seen  the centre's tet
void FaceCutter::addFirstPiece(const SimplexInTet& center, const SeenTet& seen) {
  if (center.simplex == lattice::kWholeTet) return addPiece(center, seen);
  const bool found = star_.visit(center, [&](const SimplexInTet& here) {
    const SeenTet seenHere = see(here);
    const lattice::CornerMask carrier = seenHere.carrier();
    if (carrier == lattice::kNoSimplex) return false;
    const SimplexInTet owned = ownedCarrier({here.tet, carrier, here.frame});
    addPiece(owned, owned.tet == here.tet ? seenHere : see(owned));
    return true;
  });
  if (!found) failToCut(center.tet, "no tet around the centre meets the face");
}

/// A triangle has two tets: the smaller represents it.
SimplexInTet FaceCutter::ownedCarrier(const SimplexInTet& carrier) const {
  if (carrier.simplex == lattice::kWholeTet) return carrier;
  const int face = lattice::oppositeCorner(carrier.simplex);
  const adjacency::HalfFace mate = topology_.mate[adjacency::halfFaceOf(carrier.tet, face)];
  if (mate == kNone || adjacency::tetOf(mate) > carrier.tet) return carrier;
  return crossed(topology_, exact_, carrier, face);
}

bool FaceCutter::isKnown(const SimplexInTet& carrier, std::size_t first) const {
  for (std::size_t i = first; i != kLast; i = pieces_[i].next) {
    const SimplexInTet& known = pieces_[i].carrier;
    if (known.simplex == carrier.simplex && known.frame == carrier.frame) return true;
  }
  return false;
}

/// Appends a piece to a list. The caller fills in its origin and geometry.
FaceCutter::Piece& FaceCutter::newPiece(const SimplexInTet& carrier, std::size_t& first) {
  if (pieceCount_ == pieces_.size()) pieces_.resize(std::max<std::size_t>(16, 2 * pieceCount_));
  Piece& piece = pieces_[pieceCount_];
  piece.carrier = carrier;
  piece.next = first;
  first = pieceCount_++;
  return piece;
}

void FaceCutter::addPiece(const SimplexInTet& carrier, const SeenTet& seen) {
  Piece& piece = newPiece(carrier, piecesOfTet_[carrier.tet]);
  piece.from = kLast;
  piece.seen = seen;
  piece.section = sectionOf(piece.seen, carrier.simplex, exact_.unit);
  slice(piece, {});
}

/// Adds the piece on the other side of a tet's face if it is new.
/// @param from  the piece on this side
/// @param side  its side in the face
void FaceCutter::addPieceBehind(std::size_t from, std::size_t side, int face) {
  const adjacency::HalfFace halfFace = adjacency::halfFaceOf(pieces_[from].carrier.tet, face);
  const adjacency::HalfFace mate = topology_.mate[halfFace];
  if (mate == kNone) failToCut(pieces_[from].carrier.tet, "a face leaves the mesh");
  SimplexInTet carrier{adjacency::tetOf(mate), lattice::kWholeTet, pieces_[from].carrier.frame};
  carrier.frame.cross(exact_.transitions, halfFace);
  std::size_t& first = piecesOfTet_[carrier.tet];
  if (isKnown(carrier, first)) return;
  Piece& piece = newPiece(carrier, first);
  const Piece& here = pieces_[from];
  // Three corners are known and have the same coordinates.
  const Tet& tet = topology_.tets[here.carrier.tet];
  const auto apex = static_cast<std::size_t>(adjacency::localOf(mate));
  unsigned below = 0;
  unsigned inPlane = 0;
  for (const int i : lattice::kFaceCorners[static_cast<std::size_t>(face)]) {
    const auto old = static_cast<std::size_t>(i);
    const auto corner = static_cast<std::size_t>(topology_.localCorner(carrier.tet, tet[old]));
    piece.seen.corners[corner] = here.seen.corners[old];
    below |= ((unsigned{here.seen.below} >> i) & 1U) << corner;
    inPlane |= ((unsigned{here.seen.inPlane} >> i) & 1U) << corner;
  }
  piece.seen.below = static_cast<lattice::CornerMask>(below);
  piece.seen.inPlane = static_cast<lattice::CornerMask>(inPlane);
  piece.seen.reach = here.seen.reach;
  piece.seen.add(apex, carrier.frame.see(exact_.corners[carrier.tet][apex], exact_.unit));
  piece.from = from;
  piece.fromSide = side;
  const std::size_t sectionSide = here.slice[side].side;
  KnownCut known;
  if (piece.seen.inPlane == 0) {
    piece.section = sectionBehind(piece.seen, adjacency::localOf(mate), here.section, sectionSide,
                                  exact_.unit, piece.entry);
    if (here.cuts.areKnown) known = {piece.entry, here.cuts.sides[sectionSide].reversed()};
  } else {
    piece.section = sectionOf(piece.seen, lattice::kWholeTet, exact_.unit);
    piece.entry = 0;
    while (piece.section.sideSimplex(piece.entry) != lattice::faceMask(adjacency::localOf(mate)))
      ++piece.entry;
  }
  slice(piece, known);
}

void FaceCutter::slice(Piece& piece, const KnownCut& known) {
  sliceSquare(piece.seen, piece.section, exact_.unit, known, piece.cuts, piece.slice);
  if (piece.slice.size() < 3) failToCut(piece.carrier.tet, "a polygon has no area");
  if (piece.slice.borders != 0) border_.findArcs(piece.carrier, piece.seen, piece.slice);
  if (piece.from == kLast) return;
  // From the section's side to the slice's.
  const std::size_t sectionSide = piece.entry;
  if (piece.cuts.areKnown) {
    piece.entry = piece.cuts.corner[sectionSide];
    return;
  }
  piece.entry = 0;
  while (piece.entry < piece.slice.size() && piece.slice[piece.entry].side != sectionSide) {
    ++piece.entry;
  }
  if (piece.entry == piece.slice.size()) failToCut(piece.carrier.tet, "a side is missing");
}

/// Continues across the sides that are not on the square's border.
void FaceCutter::addNeighbours(std::size_t piece) {
  unsigned open = 0;
  {
    const Slice& slice = pieces_[piece].slice;
    const std::size_t entry = pieces_[piece].from == kLast ? slice.size() : pieces_[piece].entry;
    open = ((1U << slice.size()) - 1) & ~(slice.borderSides | 1U << entry);
  }
  for (; open != 0; open &= open - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(open));
    // Adding a piece may move the others.
    const lattice::CornerMask simplex =
        pieces_[piece].section.sideSimplex(pieces_[piece].slice[i].side);
    if (lattice::dimension(simplex) == 2) {
      addPieceBehind(piece, i, lattice::oppositeCorner(simplex));
    } else {
      addPieceAround(piece, i, simplex);
    }
  }
}

/// Two pieces meet in an edge that lies in the plane; the second is somewhere around that edge.
void FaceCutter::addPieceAround(std::size_t from, std::size_t side, lattice::CornerMask edge) {
  const Piece& here = pieces_[from];
  const SimplexInTet at{here.carrier.tet, edge, here.carrier.frame};
  // Walks away from the plane, on either side of the edge; from a triangle in the plane, one side
  // is in this tet and one in the tet behind the triangle.
  for (int face = 0; face < 4; ++face) {
    if (lattice::contains(edge, face) || here.carrier.simplex == lattice::faceMask(face)) continue;
    const auto other = static_cast<std::size_t>(adjacency::otherFaceAtEdge(edge, face));
    if (addPieceAround(from, side, at, face, here.seen.corners[other][2])) return;
  }
  if (here.carrier.simplex != lattice::kWholeTet &&
      addPieceAround(from, side, at, lattice::oppositeCorner(here.carrier.simplex), 0)) {
    return;
  }
  failToCut(at.tet, "an edge leaves the mesh");
}

/// Walks around an edge in the plane to the next piece, and adds it if it is new.
/// @param face    through which the walk leaves the tet
/// @param height  of the face's corner that is not on the edge
/// @return false if the walk ends at the boundary
bool FaceCutter::addPieceAround(std::size_t from, std::size_t side, SimplexInTet edge, int face,
                                std::int64_t height) {
  for (;;) {
    const adjacency::HalfFace mate = topology_.mate[adjacency::halfFaceOf(edge.tet, face)];
    if (mate == kNone) return false;
    edge = crossed(topology_, exact_, edge, face);
    const int apex = adjacency::localOf(mate);
    const lattice::LatticePoint& corner = exact_.corners[edge.tet][static_cast<std::size_t>(apex)];
    const std::int64_t next = edge.frame.see(corner, exact_.unit)[2];
    if (next == 0) {
      const auto triangle =
          static_cast<lattice::CornerMask>(edge.simplex | lattice::cornerBit(apex));
      addPieceAtEdge(from, side, edge, triangle);
      return true;
    }
    if (height != 0 && (height < 0) != (next < 0)) {
      addPieceAtEdge(from, side, edge, lattice::kWholeTet);
      return true;
    }
    height = next;
    face = adjacency::otherFaceAtEdge(edge.simplex, apex);
  }
}

void FaceCutter::addPieceAtEdge(std::size_t from, std::size_t side, SimplexInTet edge,
                                lattice::CornerMask carrier) {
  const SimplexInTet owned = ownedCarrier({edge.tet, carrier, edge.frame});
  std::size_t& first = piecesOfTet_[owned.tet];
  if (isKnown(owned, first)) return;
  if (owned.tet != edge.tet) {
    edge.simplex = topology_.translated(edge.simplex, edge.tet, owned.tet);
  }
  Piece& piece = newPiece(owned, first);
  piece.seen = see(owned);
  piece.section = sectionOf(piece.seen, owned.simplex, exact_.unit);
  piece.from = from;
  piece.fromSide = side;
  piece.entry = 0;
  while (piece.section.sideSimplex(piece.entry) != edge.simplex) ++piece.entry;
  slice(piece, {});
}

/// Appends a piece to the output. Corners shared with the piece from which it was found are known,
/// and those on the border are consecutive on their arcs.
void FaceCutter::emit(Piece& piece) {
  const Slice& slice = piece.slice;
  const std::size_t size = slice.size();
  piece.firstCorner = out_.corners.size();
  Index* const numbers = out_.corners.extend(size);
  std::array<double, 2>* const parameters = out_.parameters.extend(size);
  unsigned open = (1U << size) - 1;
  const auto put = [&](std::size_t corner, const PatchPoint& point) {
    numbers[corner] = point.number;
    parameters[corner] = point.parameter;
    open &= ~(1U << corner);
  };
  if (piece.from != kLast) {
    // There the side runs in the opposite direction.
    const Piece& from = pieces_[piece.from];
    const std::size_t first = from.firstCorner + from.slice.next(piece.fromSide);
    const std::size_t second = from.firstCorner + piece.fromSide;
    const std::size_t next = slice.next(piece.entry);
    put(piece.entry, {out_.corners[first], out_.parameters[first]});
    put(next, {out_.corners[second], out_.parameters[second]});
    ownInnerPoint(piece, slice[piece.entry], numbers[piece.entry]);
    ownInnerPoint(piece, slice[next], numbers[next]);
  }
  for (unsigned sides = slice.borderSides; sides != 0; sides &= sides - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(sides));
    const std::size_t next = slice.next(i);
    const unsigned ends = (1U << i) | (1U << next);
    const auto side = static_cast<std::size_t>(slice[i].side - kSquareSide);
    // Where a section extends beyond the side, its interior is on the border.
    if ((ends & open & ~unsigned{slice.squareCorners}) == 0 ||
        ((slice.borders >> side) & 1U) == 0) {
      continue;
    }
    const FaceBorder::SideEnd first{((open >> i) & 1U) == 0, slice[i].isSquareCorner()};
    const FaceBorder::SideEnd second{((open >> next) & 1U) == 0, slice[next].isSquareCorner()};
    PatchPoint firstPoint{numbers[i], parameters[i]};
    PatchPoint secondPoint{numbers[next], parameters[next]};
    if (!border_.findEnds(piece.carrier, side, first, second, firstPoint, secondPoint)) continue;
    if (!first.isSquareCorner) put(i, firstPoint);
    if (!second.isSquareCorner) put(next, secondPoint);
  }
  for (unsigned corners = slice.squareCorners & open; corners != 0; corners &= corners - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(corners));
    put(i, border_.vertex(slice[i].squareCorner()));
  }
  for (; open != 0; open &= open - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(open));
    const PatchPoint point = pointAt(piece, slice[i]);
    numbers[i] = point.number;
    parameters[i] = point.parameter;
  }
  out_.cornerCounts.add(static_cast<std::uint8_t>(size));
  // Pieces are already identified by the owners of their carriers.
  out_.carriers.add({piece.carrier.tet, piece.carrier.simplex});
}

PatchPoint FaceCutter::pointAt(const Piece& piece, const SliceCorner& corner) {
  if (!corner.isOnBorder()) return innerPoint(piece, corner);
  return border_.pointAt(piece.carrier.tet, piece.seen, corner);
}

/// A point inside the square is identified by the tet vertex or edge that crosses the square there,
/// and by that simplex's coordinates in the square's frame, which are the same in all tets around
/// it. (An edge crosses a face twice only through a periodic domain.)
PatchPoint FaceCutter::innerPoint(const Piece& piece, const SliceCorner& corner) {
  const Tet& tet = topology_.tets[piece.carrier.tet];
  std::size_t i = lattice::firstCorner(corner.simplex);
  std::size_t j = lattice::lastCorner(corner.simplex);
  if (tet[j] < tet[i]) std::swap(i, j);
  const lattice::LatticeTet& seen = piece.seen.corners;
  std::size_t& first = innerAtEdge_[tet[i] ^ (tet[j] * 0x85ebca6bU)];
  for (std::size_t k = first; k != kLast; k = inner_[k].next) {
    const InnerPoint& known = inner_[k];
    if (known.vertices[0] == tet[i] && known.vertices[1] == tet[j] && known.seen[0] == seen[i] &&
        known.seen[1] == seen[j]) {
      ownInnerPoint(piece, corner, known.point.number);
      return known.point;
    }
  }
  const PatchPoint point = newInnerPoint(piece, corner);
  inner_.push_back({{tet[i], tet[j]}, {seen[i], seen[j]}, point, first});
  first = inner_.size() - 1;
  return point;
}

/// All tets around an edge that crosses the open square have pieces there, so one of these pieces
/// is in the smallest tet, which owns the edge.
void FaceCutter::ownInnerPoint(const Piece& piece, const SliceCorner& corner, Index number) {
  if (number < firstInnerPoint_) return;
  OwnedSimplex& generator = out_.generators[number - firstInnerPoint_];
  if (piece.carrier.tet < generator.tet && lattice::dimension(corner.simplex) == 1) {
    generator = {piece.carrier.tet, corner.simplex};
  }
}

PatchPoint FaceCutter::newInnerPoint(const Piece& piece, const SliceCorner& corner) {
  const Tet& tet = topology_.tets[piece.carrier.tet];
  const std::size_t i = lattice::firstCorner(corner.simplex);
  const std::size_t j = lattice::lastCorner(corner.simplex);
  const lattice::LatticeTet& seen = piece.seen.corners;
  const std::array<double, 2> shares =
      i == j ? std::array<double, 2>{1, 0} : sharesOfIntersection(seen[i][2], seen[j][2]);
  const auto& points = input_.map.input.view.points;
  Vec3 position{};
  for (std::size_t k = 0; k < 3; ++k) {
    position[k] += shares[0] * points[tet[i]][k];
    if (i != j) position[k] += shares[1] * points[tet[j]][k];
  }
  const std::array<double, 2>& at = piece.section.points[corner.point].at;
  const std::uint64_t number = firstInnerPoint_ + out_.points.size();
  out_.points.add(position);
  out_.generators.add(i == j ? ownedBy(topology_, piece.carrier.tet, corner.simplex)
                             : OwnedSimplex{piece.carrier.tet, corner.simplex});
  return {static_cast<Index>(number),
          {std::clamp(at[0] / unit_, 0.0, 1.0), std::clamp(at[1] / unit_, 0.0, 1.0)}};
}

}  // namespace hexhex::curved
