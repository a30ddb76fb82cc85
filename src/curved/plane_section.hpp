// Where the plane of a hex face cuts a tet: a triangle or a quadrilateral, not yet clipped.
//
// All coordinates are lattice coordinates in the face's frame: the face, a square, lies in the
// plane where coordinate 2 is 0; coordinates 0 and 1 run from 0 to the unit.
#pragma once

#include <array>
#include <cstdint>

#include <lattice/tet_geometry.hpp>

namespace hexhex::curved {

/// Position of a point relative to the lines through the sides of the square. Side i runs from
/// corner i to corner i + 1, counter-clockwise. Bit i: beyond the line of side i; bit 4 + i: on it.
using BorderFlags = std::uint8_t;

[[nodiscard]] constexpr BorderFlags onBorder(std::size_t side) noexcept {
  return static_cast<BorderFlags>(16U << side);
}
/// The coordinate that a side bounds, and whether it is the bound at 1.
[[nodiscard]] constexpr std::size_t axisAcross(std::size_t side) noexcept { return 1 - side % 2; }
[[nodiscard]] constexpr bool boundsAtOne(std::size_t side) noexcept {
  return side == 1 || side == 2;
}
/// Flags of a point, from the signs of a coordinate and of its distance from 1.
[[nodiscard]] constexpr BorderFlags bordersBySigns(std::size_t axis, int fromZero,
                                                   int fromOne) noexcept {
  const unsigned low = axis == 0 ? 3 : 0;
  const unsigned high = axis == 0 ? 1 : 2;
  return static_cast<BorderFlags>(
      (unsigned{fromZero < 0} << low) | (unsigned{fromZero == 0} << (low + 4)) |
      (unsigned{fromOne > 0} << high) | (unsigned{fromOne == 0} << (high + 4)));
}
/// The same where both signs are certain and nonzero.
[[nodiscard]] constexpr BorderFlags bordersOfCertain(std::size_t axis, bool aboveZero,
                                                     bool aboveOne) noexcept {
  // Sides 3 and 1 bound coordinate 0, sides 0 and 2 coordinate 1.
  const std::size_t low = 3 * (1 - axis);
  return static_cast<BorderFlags>((unsigned{!aboveZero} << low) |
                                  (unsigned{aboveOne} << (1 + axis)));
}

/// A tet in the frame of a face.
struct SeenTet {
  lattice::LatticeTet corners;
  lattice::CornerMask below;    ///< corners below the plane
  lattice::CornerMask inPlane;  ///< corners in the plane
  /// At least the unit and the magnitudes of coordinates 0 and 1 of all corners.
  double reach;

  SeenTet() = default;
  SeenTet(const lattice::LatticeTet& seen, double unit) noexcept;
  /// Adds the last corner; the others must be set.
  void add(std::size_t corner, const lattice::LatticePoint& seen) noexcept;

  /// The simplex whose interior meets the plane in an area: the tet itself, a face that lies in the
  /// plane, or none.
  [[nodiscard]] lattice::CornerMask carrier() const noexcept;
};

struct SectionPoint {
  /// Rounded coordinates: within kPointError times the reach of the tet.
  std::array<double, 2> at;
  lattice::CornerMask simplex;  ///< an edge that the plane crosses, or a vertex in the plane
  BorderFlags borders;          ///< exact
};

// In units of 2^-53, with R for the reach: heights have a relative error of 1, their sum 2, shares
// 1 + 2 + 1 = 4, products with coordinates 4 + 1 + 1 = 6, their sum 7; shares add up to 1, so the
// total is 7 R. 2^-50 is 8.
inline constexpr double kPointError = 0x1p-50;

/// Weights of the two ends of an edge at the point where the plane crosses it.
[[nodiscard]] inline std::array<double, 2> sharesOfIntersection(
    std::int64_t heightOfFirst, std::int64_t heightOfSecond) noexcept {
  // The signs are opposite, so the difference adds magnitudes.
  const auto first = static_cast<double>(heightOfFirst);
  const auto second = static_cast<double>(heightOfSecond);
  const double sum = first - second;
  return {-second / sum, first / sum};
}

/// A convex polygon, counter-clockwise. Side k, from point k to the next, runs inside a face of the
/// tet, or along an edge that lies in the plane.
struct Section {
  std::array<SectionPoint, 4> points;
  std::uint32_t size = 0;

  [[nodiscard]] std::size_t next(std::size_t k) const noexcept { return k + 1 < size ? k + 1 : 0; }
  /// The simplex in which a side runs.
  [[nodiscard]] lattice::CornerMask sideSimplex(std::size_t k) const noexcept {
    return static_cast<lattice::CornerMask>(points[k].simplex | points[next(k)].simplex);
  }
};

/// The section of a tet's carrier.
[[nodiscard]] Section sectionOf(const SeenTet& tet, lattice::CornerMask carrier,
                                std::int64_t unit) noexcept;

/// The same for a tet that has no corner in the plane and is entered through a face: reuses what
/// its section shares with the one on the other side of that face.
/// @param entered   the face
/// @param from      the section on the other side, of a tet without corners in the plane
/// @param fromSide  its side in the face
/// @param side      receives the result's side in the face
[[nodiscard]] Section sectionBehind(const SeenTet& tet, int entered, const Section& from,
                                    std::size_t fromSide, std::int64_t unit,
                                    std::size_t& side) noexcept;

}  // namespace hexhex::curved
