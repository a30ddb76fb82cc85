// Where a hex edge crosses the interior of a face of the tets.
//
// Every way to trace an edge finds the same point, bit for bit: it is computed from the face as its
// owner has it. The chart, and the direction in which the edge is followed, only permute and negate
// the integers that all begins with, and what follows is the same for them.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>

#include <hexhex/types.hpp>

#include <curved/owned_simplex.hpp>
#include <igm/prepare.hpp>

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

/// A face in the chart of its owner, to be crossed once.
class OwnersFace {
 public:
  OwnersFace(const LatticeTet& ofOwner, int face) noexcept
      : corners_(&ofOwner), indices_(&kFaceCorners[static_cast<std::size_t>(face)]) {}

  [[nodiscard]] const LatticePoint& corner(std::size_t i) const noexcept {
    return (*corners_)[static_cast<std::size_t>((*indices_)[i])];
  }
  /// Coordinate k of its first corner,
  [[nodiscard]] std::int64_t first(std::size_t k) const noexcept { return corner(0)[k]; }
  /// and those of the others, relative to that.
  [[nodiscard]] double second(std::size_t k) const noexcept {
    return static_cast<double>(corner(1)[k] - corner(0)[k]);
  }
  [[nodiscard]] double third(std::size_t k) const noexcept {
    return static_cast<double>(corner(2)[k] - corner(0)[k]);
  }

 private:
  const LatticeTet* corners_;
  const std::array<int, 3>* indices_;
};

/// The same, ready to be crossed often.
class CrossedFace : public OwnersFace {
 public:
  CrossedFace(const LatticeTet& ofOwner, int face) noexcept : OwnersFace(ofOwner, face) {
    for (std::size_t k = 0; k < 3; ++k) {
      second_[k] = OwnersFace::second(k);
      third_[k] = OwnersFace::third(k);
    }
  }
  [[nodiscard]] double second(std::size_t k) const noexcept { return second_[k]; }
  [[nodiscard]] double third(std::size_t k) const noexcept { return third_[k]; }

 private:
  std::array<double, 3> second_;
  std::array<double, 3> third_;
};

/// A parameter, or 1 minus it if the other argument is 1 and not 0; without a branch.
[[nodiscard]] inline double fromOtherEnd(double parameter, unsigned other) noexcept {
  static constexpr std::array<double, 2> kEnd = {0, 1};
  const auto bits = std::bit_cast<std::uint64_t>(parameter);
  return kEnd[other] + std::bit_cast<double>(bits ^ (std::uint64_t{other} << 63));
}

/// Where the line of an edge meets the plane of a face, by exact arithmetic up to the last
/// roundings.
[[nodiscard]] FaceShares shareExactly(const OwnersFace& face, const ChartEdge& edge,
                                      std::int64_t unit) noexcept;

/// The same in floating point.
///
/// In units of u = 2^-53 and of M, the largest coordinate of a corner across the edge relative to
/// the first one; none of the line is larger, as it meets the closed face. Coordinates carry one
/// rounding, so products are known to 3 M^2 and their differences to 8 M^2. M^2 is less than the
/// sum of squares. Where the sum of all weights is above 2^-10 of that, the shares of the second
/// and the third corner are known to 2^14 and their own roundings, the share that is left to twice
/// that: less than 2^-37.
/// @param edge  a ChartEdge, or what has its members
/// @return outside if it is not certain, or not known so well
template <class Face, class Edge>
[[nodiscard]] FaceShares shareRoughly(const Face& face, const Edge& edge,
                                      std::int64_t unit) noexcept {
  static constexpr std::array<std::array<std::uint8_t, 2>, 3> kAcross = {{{1, 2}, {2, 0}, {0, 1}}};
  const std::array<std::uint8_t, 2>& across = kAcross[static_cast<std::size_t>(axisOf(edge.along))];
  const std::size_t m = across[0];
  const std::size_t n = across[1];
  const auto p = static_cast<double>(edge.z[m] * unit - face.first(m));
  const auto q = static_cast<double>(edge.z[n] * unit - face.first(n));
  const double p2 = face.second(m);
  const double q2 = face.second(n);
  const double p3 = face.third(m);
  const double q3 = face.third(n);
  const double squares = p2 * p2 + q2 * q2 + p3 * p3 + q3 * q3;
  const double perSum = 1 / (p2 * q3 - p3 * q2);
  const double second = (p * q3 - p3 * q) * perSum;
  const double third = (p2 * q - p * q2) * perSum;
  const double first = 1 - second - third;
  constexpr double kLeastShare = 0x1p-36;
  const bool inside =
      squares * std::abs(perSum) < 0x1p10 && std::min(std::min(first, second), third) > kLeastShare;
  return {{first, second, third}, inside};
}

/// @param shares  of the face's corners, where the line of the edge meets it
/// @param edge    in the owner's chart: a ChartEdge, or what has its members
/// @param unit    a power of two
/// @param perUnit  1 / unit
template <class Face, class Edge>
[[nodiscard]] FaceCrossing crossAt(const FaceShares& shares, const Face& face, const Edge& edge,
                                   std::int64_t unit, double perUnit) noexcept {
  const auto axis = static_cast<std::size_t>(axisOf(edge.along));
  // No branch may depend on the direction, which is as good as random.
  const unsigned back = descends(edge.along);
  const std::int64_t begin = std::int64_t{edge.z[axis]} - std::int64_t{back};
  const auto first = static_cast<double>(face.first(axis) - begin * unit);
  const double second = face.second(axis);
  const double third = face.third(axis);
  const double beyond = shares.of[1] * second + shares.of[2] * third;
  // A multiple of 2^-53, so that the way back is as exact as the way there.
  const double rest = 1 - (first + beyond) * perUnit;
  const double parameter = fromOtherEnd(rest, 1 - back);
  const double reach = std::abs(second) + std::abs(third);
  const double error = (0x1p-36 * reach + 0x1p-50 * std::abs(first)) * perUnit + 0x1p-52;
  return {shares.of, parameter, error, shares.inside};
}

/// @param edge  in the owner's chart; its line meets the closed face
template <class Face>
[[nodiscard]] FaceCrossing crossFace(const Face& face, const ChartEdge& edge,
                                     std::int64_t unit) noexcept {
  FaceShares shares = shareRoughly(face, edge, unit);
  if (!shares.inside) [[unlikely]]
    shares = shareExactly(face, edge, unit);
  return crossAt(shares, face, edge, unit, 1 / static_cast<double>(unit));
}

/// The corners of a face in space.
using FacePoints = std::array<const Vec3*, 3>;

/// @param tet  the face's owner
[[nodiscard]] inline FacePoints pointsOf(const Tet& tet, int face,
                                         std::span<const Vec3> points) noexcept {
  const std::array<int, 3>& f = kFaceCorners[static_cast<std::size_t>(face)];
  return {&points[tet[static_cast<std::size_t>(f[0])]],
          &points[tet[static_cast<std::size_t>(f[1])]],
          &points[tet[static_cast<std::size_t>(f[2])]]};
}

[[nodiscard]] inline Vec3 pointInFace(const std::array<double, 3>& shares,
                                      const FacePoints& corners) noexcept {
  Vec3 point;
  for (std::size_t k = 0; k < 3; ++k) {
    point[k] =
        shares[0] * (*corners[0])[k] + shares[1] * (*corners[1])[k] + shares[2] * (*corners[2])[k];
  }
  return point;
}

/// A face by its owner.
struct FaceOfOwner {
  Index tet;
  int local;         ///< by its opposite corner
  HalfFace crossed;  ///< on the side that it was seen from if the owner is on the other; else kNone

  FaceOfOwner(const TetTopology& topology, Index seenFrom, int face) noexcept
      : FaceOfOwner(ownedFace(topology, seenFrom, face), halfFaceOf(seenFrom, face)) {}

  [[nodiscard]] OwnedSimplex simplex() const noexcept { return {tet, faceMask(local)}; }
  /// @param edge  in the chart of the tet that the face was seen from
  [[nodiscard]] ChartEdge carry(const ChartEdge& edge,
                                const Transitions& transitions) const noexcept {
    return crossed == kNone ? edge : edge.across(transitions, crossed);
  }

 private:
  FaceOfOwner(const OwnedSimplex& owned, HalfFace seen) noexcept
      : tet(owned.tet),
        local(oppositeCorner(owned.corners)),
        crossed(owned.tet == tetOf(seen) ? kNone : seen) {}
};

}  // namespace hexhex
