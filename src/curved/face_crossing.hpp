// Where a hex edge crosses the interior of a face of the tets.
//
// Every way to trace an edge finds the same point, bit for bit: it is computed from the face as its
// owner has it. The chart, and the direction in which the edge is followed, only permute and negate
// the integers that all begins with, and what follows is the same for them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include <curved/owned_simplex.hpp>

#include <hexhex/types.hpp>

#include <map/prepare.hpp>

namespace hexhex {

/// A hex edge in the chart of a tet: from a grid point to its neighbour.
struct ChartEdge {
  GridPoint z;
  Direction along;

  /// Carries it across a face.
  [[nodiscard]] ChartEdge across(const Transitions& transitions, HalfFace halfFace) const noexcept {
    if (!transitions.isJump(halfFace)) return *this;
    const Transition& transition = transitions.across(halfFace);
    return {transition(z), transition(along)};
  }
  /// The same edge along the positive axis.
  [[nodiscard]] ChartEdge ascending() const noexcept {
    if (signOf(along) > 0) return *this;
    return {step(z, along), opposite(along)};
  }
};

/// The point inside a face at which an edge crosses it.
struct FaceCrossing {
  std::array<double, 3> shares{};  ///< of the face's corners, with sum 1
  double parameter = 0;            ///< along the edge; 1 minus it, exactly, from the other end
  double error = 0;                ///< bound for that of the parameter
  bool inside = false;  ///< whether the edge's line crosses the interior of the face: exact
};

/// The shares of a face's corners at a point, and whether all are known to be positive.
struct FaceShares {
  std::array<double, 3> of{};
  bool inside = false;
};

/// A face as seen along an edge.
struct FaceView {
  const LatticePoint& first;
  const LatticePoint& second;
  const LatticePoint& third;
  std::array<std::uint8_t, 3> axes;  ///< along the edge, then across

  FaceView(const LatticeTet& corners, int face, Direction along) noexcept
      : first(cornerOf(corners, face, 0)),
        second(cornerOf(corners, face, 1)),
        third(cornerOf(corners, face, 2)),
        axes(kAxes[static_cast<std::size_t>(axisOf(along))]) {}

 private:
  static constexpr std::array<std::array<std::uint8_t, 3>, 3> kAxes = {
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}}};
  static const LatticePoint& cornerOf(const LatticeTet& corners, int face, std::size_t i) noexcept {
    return corners[static_cast<std::size_t>(kFaceCorners[static_cast<std::size_t>(face)][i])];
  }
};

/// Where the line of an edge meets the plane of a face, by exact arithmetic up to the last roundings.
[[nodiscard]] FaceShares shareExactly(const FaceView& face, const GridPoint& z,
                                      std::int64_t unit) noexcept;

/// The same in floating point.
///
/// In units of u = 2^-53 and of M, the largest coordinate of a corner across the edge relative to
/// the first one; none of the line is larger, as it meets the closed face. Coordinates carry one
/// rounding, so products are known to 3 M^2 and their differences to 8 M^2. M^2 is less than the sum
/// of squares. Where the sum of all weights is above 2^-10 of that, the shares of the second and the
/// third corner are known to 2^14 and their own roundings, the share that is left to twice that:
/// less than 2^-37.
/// @return outside if it is not certain, or not known so well
[[nodiscard]] inline FaceShares shareRoughly(const FaceView& face, const GridPoint& z,
                                             std::int64_t unit) noexcept {
  const std::size_t m = face.axes[1];
  const std::size_t n = face.axes[2];
  const auto p = static_cast<double>(z[m] * unit - face.first[m]);
  const auto q = static_cast<double>(z[n] * unit - face.first[n]);
  const auto p2 = static_cast<double>(face.second[m] - face.first[m]);
  const auto q2 = static_cast<double>(face.second[n] - face.first[n]);
  const auto p3 = static_cast<double>(face.third[m] - face.first[m]);
  const auto q3 = static_cast<double>(face.third[n] - face.first[n]);
  const double squares = p2 * p2 + q2 * q2 + p3 * p3 + q3 * q3;
  const double perSum = 1 / (p2 * q3 - p3 * q2);
  const double second = (p * q3 - p3 * q) * perSum;
  const double third = (p2 * q - p * q2) * perSum;
  const double first = 1 - second - third;
  constexpr double kLeastShare = 0x1p-36;
  const bool inside = squares * std::abs(perSum) < 0x1p10 &&
                      std::min(std::min(first, second), third) > kLeastShare;
  return {{first, second, third}, inside};
}

/// @param corners  of the face's owner
/// @param edge     in the owner's chart; its line meets the closed face
/// @param unit     a power of two
[[nodiscard]] inline FaceCrossing crossFace(const LatticeTet& corners, int face,
                                            const ChartEdge& edge, std::int64_t unit) noexcept {
  const FaceView view(corners, face, edge.along);
  FaceShares shares = shareRoughly(view, edge.z, unit);
  if (!shares.inside) [[unlikely]] shares = shareExactly(view, edge.z, unit);
  const std::size_t axis = view.axes[0];
  const bool ascends = signOf(edge.along) > 0;
  const auto second = static_cast<double>(view.second[axis] - view.first[axis]);
  const auto third = static_cast<double>(view.third[axis] - view.first[axis]);
  const auto first = static_cast<double>(
      view.first[axis] - (std::int64_t{edge.z[axis]} - (ascends ? 0 : 1)) * unit);
  const double perUnit = 1 / static_cast<double>(unit);
  const double place = (first + (shares.of[1] * second + shares.of[2] * third)) * perUnit;
  // A multiple of 2^-53, so that the way back is as exact as the way there.
  const double rest = 1 - place;
  const double parameter = ascends ? 1 - rest : rest;
  const double error =
      (0x1p-36 * (std::abs(second) + std::abs(third)) + 0x1p-50 * std::abs(first)) * perUnit +
      0x1p-52;
  return {shares.of, parameter, error, shares.inside};
}

/// In space.
/// @param tet  the face's owner
[[nodiscard]] inline Vec3 pointInFace(const std::array<double, 3>& shares, const Tet& tet, int face,
                                      std::span<const Vec3> points) noexcept {
  const std::array<int, 3>& f = kFaceCorners[static_cast<std::size_t>(face)];
  const Vec3& a = points[tet[static_cast<std::size_t>(f[0])]];
  const Vec3& b = points[tet[static_cast<std::size_t>(f[1])]];
  const Vec3& c = points[tet[static_cast<std::size_t>(f[2])]];
  Vec3 point;
  for (std::size_t k = 0; k < 3; ++k)
    point[k] = shares[0] * a[k] + shares[1] * b[k] + shares[2] * c[k];
  return point;
}

/// A face as its owner has it, with an edge that crosses it.
struct OwnedCrossing {
  OwnedSimplex face;
  int local;  ///< the same face: by its opposite corner
  ChartEdge edge;

  /// @param edge  in the chart of the tet
  OwnedCrossing(const PreparedMap& map, Index tet, int localFace, const ChartEdge& inTet) noexcept
      : face{tet, faceMask(localFace)}, local(localFace), edge(inTet) {
    const HalfFace halfFace = halfFaceOf(tet, localFace);
    const HalfFace mate = map.topology.mate[halfFace];
    if (mate == kNone || tet < tetOf(mate)) return;
    local = localOf(mate);
    face = {tetOf(mate), faceMask(local)};
    edge = inTet.across(map.exact.transitions, halfFace);
  }
};

}  // namespace hexhex
