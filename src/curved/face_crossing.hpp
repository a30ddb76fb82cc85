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

/// The place of a point along an edge, times unit: a corner of the face, and how far behind it the
/// point is.
struct EdgePlace {
  std::int64_t corner = 0;
  double beyond = 0;

  [[nodiscard]] double fromBegin() const noexcept { return static_cast<double>(corner) + beyond; }
  /// From the edge's other end.
  [[nodiscard]] EdgePlace reversed(std::int64_t unit) const noexcept {
    return {unit - corner, -beyond};
  }
};

struct FaceCrossing {
  std::array<double, 3> shares{};  ///< of the face's corners, with sum 1
  EdgePlace place;
  double error = 0;     ///< bound for that of the place, its own roundings included
  bool inside = false;  ///< whether the edge's line crosses the interior of the face: exact
};

/// A face seen along an edge: all relative to its first corner, along the edge, then across.
struct FaceView {
  LatticePoint begin;  ///< of the edge
  LatticePoint second;
  LatticePoint third;

  FaceView(const LatticeTet& corners, int face, const ChartEdge& edge, std::int64_t unit) noexcept {
    constexpr std::array<std::array<std::uint8_t, 3>, 3> kAxes = {
        {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}}};
    const std::array<std::uint8_t, 3>& axes = kAxes[static_cast<std::size_t>(axisOf(edge.along))];
    const std::array<int, 3>& f = kFaceCorners[static_cast<std::size_t>(face)];
    const LatticePoint& a = corners[static_cast<std::size_t>(f[0])];
    const LatticePoint& b = corners[static_cast<std::size_t>(f[1])];
    const LatticePoint& c = corners[static_cast<std::size_t>(f[2])];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t axis = axes[k];
      begin[k] = edge.z[axis] * unit - a[axis];
      second[k] = b[axis] - a[axis];
      third[k] = c[axis] - a[axis];
    }
  }
};

/// Shares of the corners, by exact arithmetic up to their own roundings.
/// @return whether the edge's line crosses the interior of the face
[[nodiscard]] bool shareExactly(const FaceView& view, std::array<double, 3>& shares) noexcept;

/// The same in floating point.
///
/// In units of u = 2^-53 and of M, the largest coordinate of a corner across the edge, which is none
/// of the line either, as that meets the closed face. Coordinates carry one rounding, so products
/// are known to 3 M^2 and their differences to 8 M^2. M^2 is less than the sum of squares. Where the
/// sum of all weights is above 2^-10 of that, the shares of the second and the third corner are known
/// to 2^14 units and their own roundings, the share that is left to twice that: less than 2^-37.
/// @return whether that is certain to be inside, and so well known
[[nodiscard]] inline bool shareRoughly(const FaceView& view,
                                       std::array<double, 3>& shares) noexcept {
  const auto p = static_cast<double>(view.begin[1]);
  const auto q = static_cast<double>(view.begin[2]);
  const auto p2 = static_cast<double>(view.second[1]);
  const auto q2 = static_cast<double>(view.second[2]);
  const auto p3 = static_cast<double>(view.third[1]);
  const auto q3 = static_cast<double>(view.third[2]);
  const double squares = p2 * p2 + q2 * q2 + p3 * p3 + q3 * q3;
  const double perSum = 1 / (p2 * q3 - p3 * q2);
  shares[1] = (p * q3 - p3 * q) * perSum;
  shares[2] = (p2 * q - p * q2) * perSum;
  shares[0] = 1 - shares[1] - shares[2];
  constexpr double kLeastShare = 0x1p-36;
  return squares * std::abs(perSum) < 0x1p10 &&
         std::min(std::min(shares[0], shares[1]), shares[2]) > kLeastShare;
}

/// @param corners  of the face's owner
/// @param edge     in the owner's chart; its line meets the closed face
[[nodiscard]] inline FaceCrossing crossFace(const LatticeTet& corners, int face,
                                            const ChartEdge& edge, std::int64_t unit) noexcept {
  const FaceView view(corners, face, edge, unit);
  FaceCrossing crossing;
  crossing.inside = shareRoughly(view, crossing.shares) || shareExactly(view, crossing.shares);
  const std::int64_t sign = signOf(edge.along);
  const auto second = static_cast<double>(sign * view.second[0]);
  const auto third = static_cast<double>(sign * view.third[0]);
  const std::int64_t corner = -sign * view.begin[0];
  crossing.place = {corner, crossing.shares[1] * second + crossing.shares[2] * third};
  crossing.error = 0x1p-36 * (std::abs(second) + std::abs(third)) +
                   0x1p-50 * std::abs(static_cast<double>(corner));
  return crossing;
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
