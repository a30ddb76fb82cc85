#include <algorithm>
#include <cmath>

#include <curved/plane_section.hpp>

namespace hexhex::curved {

namespace {

/// For one set of corners below the plane: the edges that the plane crosses, going around the
/// section.
struct Outline {
  std::uint8_t size = 0;
  std::array<std::uint8_t, 4> above{};    ///< per point: its edge's end above the plane
  std::array<std::uint8_t, 4> below{};    ///< and below the plane
  std::array<std::uint8_t, 4> simplex{};  ///< both ends
  std::array<std::uint8_t, 4> sideIn{};   ///< per face of the tet: the section's side in it

  constexpr void add(std::size_t i, std::size_t j) noexcept {
    above[size] = static_cast<std::uint8_t>(i);
    below[size] = static_cast<std::uint8_t>(j);
    simplex[size++] = static_cast<std::uint8_t>((1U << i) | (1U << j));
  }
  constexpr void finish() noexcept {
    for (std::size_t k = 0; k < size; ++k) {
      const unsigned face = unsigned{simplex[k]} | simplex[k + 1 < size ? k + 1 : 0];
      for (std::size_t f = 0; f < 4; ++f) {
        if (face == (15U ^ (1U << f))) sideIn[f] = static_cast<std::uint8_t>(k);
      }
    }
  }
};

constexpr Outline makeOutline(unsigned belowMask) noexcept {
  std::array<std::size_t, 4> above{};
  std::array<std::size_t, 4> below{};
  std::size_t aboveCount = 0;
  std::size_t belowCount = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    (((belowMask >> i) & 1U) != 0 ? below[belowCount++] : above[aboveCount++]) = i;
  }
  Outline outline;
  if (aboveCount == 0 || belowCount == 0) return outline;
  if (aboveCount == 2) {
    // With corners i, j above and k, l below, in an even order, the sides go around as ik, jk, jl,
    // il: see the tet (1, 0, 1), (-1, 0, 1), (0, 1, -1), (0, -1, -1). Of the orders with i < j and
    // k < l, those of {0, 2}, {1, 3} are odd.
    const bool odd = (above[0] + above[1]) % 2 == 0;
    const std::size_t k = below[odd ? 1 : 0];
    const std::size_t l = below[odd ? 0 : 1];
    outline.add(above[0], k);
    outline.add(above[1], k);
    outline.add(above[1], l);
    outline.add(above[0], l);
  } else {
    // One corner is alone on its side: take its edges to the others in the order that goes around
    // the opposite face, whose normal points to that corner.
    const std::size_t alone = aboveCount == 1 ? above[0] : below[0];
    for (std::size_t n = 0; n < 3; ++n) {
      const auto other =
          static_cast<std::size_t>(lattice::kFaceCorners[alone][belowCount == 1 ? (3 - n) % 3 : n]);
      if (belowCount == 1) {
        outline.add(other, alone);
      } else {
        outline.add(alone, other);
      }
    }
  }
  outline.finish();
  return outline;
}

constexpr std::array<Outline, 16> makeOutlines() noexcept {
  std::array<Outline, 16> outlines;
  for (unsigned mask = 0; mask < 16; ++mask) outlines[mask] = makeOutline(mask);
  return outlines;
}
constexpr std::array<Outline, 16> kOutlines = makeOutlines();

int signOfDifference(std::int64_t a, std::int64_t b) noexcept { return int{a > b} - int{a < b}; }

/// Flags of one coordinate of a point between two corners.
BorderFlags exactBorders(const lattice::LatticePoint& i, const lattice::LatticePoint& j,
                         std::size_t axis, std::int64_t unit) noexcept {
  const std::int64_t weightI = j[2] < 0 ? -j[2] : j[2];
  const std::int64_t weightJ = i[2] < 0 ? -i[2] : i[2];
  // All products fit in 124 bits.
  const lattice::Int128 sum = static_cast<lattice::Int128>(weightI) * i[axis] +
                              static_cast<lattice::Int128>(weightJ) * j[axis];
  const lattice::Int128 one = static_cast<lattice::Int128>(weightI + weightJ) * unit;
  return bordersBySigns(axis, lattice::sign(sum), lattice::sign(sum - one));
}

/// The point where the plane crosses an edge between a corner above it and one below.
SectionPoint intersection(const SeenTet& tet, std::size_t i, std::size_t j,
                          lattice::CornerMask simplex, std::int64_t unit) noexcept {
  const lattice::LatticePoint& a = tet.corners[i];
  const lattice::LatticePoint& b = tet.corners[j];
  const auto [shareA, shareB] = sharesOfIntersection(a[2], b[2]);
  const double u = shareA * static_cast<double>(a[0]) + shareB * static_cast<double>(b[0]);
  const double v = shareA * static_cast<double>(a[1]) + shareB * static_cast<double>(b[1]);
  SectionPoint point{{u, v}, simplex, 0};
  // A difference from 1 has one more rounding, of at most 2 R: the factor of two leaves enough
  // room.
  const double error = 2 * kPointError * tet.reach;
  const auto one = static_cast<double>(unit);
  const double closest =
      std::min(std::min(std::abs(u), std::abs(u - one)), std::min(std::abs(v), std::abs(v - one)));
  point.borders =
      closest > error
          ? static_cast<BorderFlags>(bordersOfCertain(0, u > 0, u > one) |
                                     bordersOfCertain(1, v > 0, v > one))
          : static_cast<BorderFlags>(exactBorders(a, b, 0, unit) | exactBorders(a, b, 1, unit));
  return point;
}

SectionPoint corner(const SeenTet& tet, std::size_t i, std::int64_t unit) noexcept {
  const lattice::LatticePoint& p = tet.corners[i];
  SectionPoint point{{static_cast<double>(p[0]), static_cast<double>(p[1])},
                     lattice::cornerBit(static_cast<int>(i)),
                     0};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    point.borders |=
        bordersBySigns(axis, signOfDifference(p[axis], 0), signOfDifference(p[axis], unit));
  }
  return point;
}

Section sectionOfFace(const SeenTet& tet, lattice::CornerMask face, std::int64_t unit) noexcept {
  const auto opposite = static_cast<std::size_t>(lattice::oppositeCorner(face));
  std::array<int, 3> f = lattice::kFaceCorners[opposite];
  // The face's normal points to the opposite corner.
  if (tet.corners[opposite][2] < 0) std::swap(f[1], f[2]);
  Section section;
  for (const int i : f) {
    section.points[section.size++] = corner(tet, static_cast<std::size_t>(i), unit);
  }
  return section;
}

}  // namespace

SeenTet::SeenTet(const lattice::LatticeTet& seen, double unit) noexcept
    : corners(), below(0), inPlane(0), reach(unit) {
  for (std::size_t i = 0; i < 4; ++i) add(i, seen[i]);
}

void SeenTet::add(std::size_t corner, const lattice::LatticePoint& seen) noexcept {
  corners[corner] = seen;
  below = static_cast<lattice::CornerMask>(below | (unsigned{seen[2] < 0} << corner));
  inPlane = static_cast<lattice::CornerMask>(inPlane | (unsigned{seen[2] == 0} << corner));
  reach = std::max(reach, std::max(std::abs(static_cast<double>(seen[0])),
                                   std::abs(static_cast<double>(seen[1]))));
}

lattice::CornerMask SeenTet::carrier() const noexcept {
  if (below != 0 && (below | inPlane) != lattice::kWholeTet) return lattice::kWholeTet;
  return lattice::dimension(inPlane) == 2 ? inPlane : lattice::kNoSimplex;
}

Section sectionOf(const SeenTet& tet, lattice::CornerMask carrier, std::int64_t unit) noexcept {
  if (carrier != lattice::kWholeTet) return sectionOfFace(tet, carrier, unit);
  // Corners in the plane count as above it; the points on their edges are then the corners
  // themselves.
  const Outline& outline = kOutlines[tet.below];
  Section section;
  lattice::CornerMask known = lattice::kNoSimplex;
  for (std::size_t k = 0; k < outline.size; ++k) {
    const std::size_t above = outline.above[k];
    if (!lattice::contains(tet.inPlane, outline.above[k])) {
      section.points[section.size++] =
          intersection(tet, above, outline.below[k], outline.simplex[k], unit);
    } else if (!lattice::contains(known, outline.above[k])) {
      // A corner of the tet may end several edges that the plane crosses.
      known = static_cast<lattice::CornerMask>(known | lattice::cornerBit(outline.above[k]));
      section.points[section.size++] = corner(tet, above, unit);
    }
  }
  return section;
}

Section sectionBehind(const SeenTet& tet, int entered, const Section& from, std::size_t fromSide,
                      std::int64_t unit, std::size_t& side) noexcept {
  const Outline& outline = kOutlines[tet.below];
  Section section;
  section.size = outline.size;
  side = outline.sideIn[static_cast<std::size_t>(entered)];
  // There the side runs in the opposite direction.
  std::size_t k = side;
  section.points[k] = from.points[from.next(fromSide)];
  section.points[k].simplex = outline.simplex[k];
  k = section.next(k);
  section.points[k] = from.points[fromSide];
  section.points[k].simplex = outline.simplex[k];
  for (k = section.next(k); k != side; k = section.next(k)) {
    section.points[k] =
        intersection(tet, outline.above[k], outline.below[k], outline.simplex[k], unit);
  }
  return section;
}

}  // namespace hexhex::curved
