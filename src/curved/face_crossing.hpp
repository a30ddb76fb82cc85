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

/// The corners of a face relative to where an edge begins: along it, then across.
using SeenCorners = std::array<LatticePoint, 3>;

/// Cross products of pairs of corners, by exact arithmetic.
/// @return whether the line crosses the interior of the face
[[nodiscard]] bool weighExactly(const SeenCorners& seen, std::array<double, 3>& weights) noexcept;

/// The same in floating point.
///
/// In units of u = 2^-53 and of M, the largest coordinate across the edge: coordinates carry one
/// rounding, so products are known to 3 M^2 and their differences to 8 M^2, or 2^-50 M^2. M^2 is
/// less than the sum of all squares. Where the sum of weights, which is known to three times that
/// and its own roundings, is above 2^-10 of that, shares of it are known to 2^-37.
/// @return whether that is certain to be inside, and so well known
[[nodiscard]] inline bool weighRoughly(const SeenCorners& seen,
                                       std::array<double, 3>& weights) noexcept {
  std::array<double, 3> p;
  std::array<double, 3> q;
  std::array<double, 3> squares;
  for (std::size_t i = 0; i < 3; ++i) {
    p[i] = static_cast<double>(seen[i][1]);
    q[i] = static_cast<double>(seen[i][2]);
    squares[i] = p[i] * p[i] + q[i] * q[i];
  }
  weights[0] = p[1] * q[2] - p[2] * q[1];
  weights[1] = p[2] * q[0] - p[0] * q[2];
  weights[2] = p[0] * q[1] - p[1] * q[0];
  const double square = squares[0] + squares[1] + squares[2];
  const double leastWeight = 0x1p-49 * square;
  const double least = std::min(std::min(weights[0], weights[1]), weights[2]);
  const double greatest = std::max(std::max(weights[0], weights[1]), weights[2]);
  const bool hasOneSign = least > leastWeight || greatest < -leastWeight;
  return hasOneSign && std::abs(weights[0] + weights[1] + weights[2]) > 0x1p-10 * square;
}

/// @param corners  of the face's owner
/// @param edge     in the owner's chart
[[nodiscard]] inline FaceCrossing crossFace(const LatticeTet& corners, int face,
                                            const ChartEdge& edge, std::int64_t unit) noexcept {
  const auto along = static_cast<std::size_t>(axisOf(edge.along));
  const std::array<std::size_t, 3> axes = {along, along == 2 ? 0 : along + 1,
                                           along == 0 ? 2 : along - 1};
  const std::array<int, 3>& f = kFaceCorners[static_cast<std::size_t>(face)];
  SeenCorners seen;
  for (std::size_t i = 0; i < 3; ++i) {
    const LatticePoint& corner = corners[static_cast<std::size_t>(f[i])];
    for (std::size_t k = 0; k < 3; ++k) seen[i][k] = corner[axes[k]] - edge.z[axes[k]] * unit;
  }
  FaceCrossing crossing;
  std::array<double, 3> weights;
  crossing.inside = weighRoughly(seen, weights) || weighExactly(seen, weights);
  if (!crossing.inside) return crossing;
  const double perSum = 1 / (weights[0] + weights[1] + weights[2]);
  for (std::size_t i = 0; i < 3; ++i) crossing.shares[i] = weights[i] * perSum;
  const std::int64_t sign = signOf(edge.along);
  const auto first = static_cast<double>(sign * (seen[1][0] - seen[0][0]));
  const auto second = static_cast<double>(sign * (seen[2][0] - seen[0][0]));
  crossing.place = {sign * seen[0][0], crossing.shares[1] * first + crossing.shares[2] * second};
  crossing.error = 0x1p-36 * (std::abs(first) + std::abs(second)) +
                   0x1p-50 * std::abs(static_cast<double>(seen[0][0]));
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
