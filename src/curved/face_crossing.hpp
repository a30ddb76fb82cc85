// Where a hex edge crosses the interior of a face of the tets.
//
// Every way to trace an edge finds the same point, bit for bit: it is computed from the face as its
// owner has it. The chart, and the direction in which the edge is followed, only permute and negate
// the integers that all begins with, and what follows is the same for them.
#pragma once

#include <array>
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

/// @param corners  of the face's owner
/// @param edge     in the owner's chart
[[nodiscard]] FaceCrossing crossFace(const LatticeTet& corners, int face, const ChartEdge& edge,
                                     std::int64_t unit) noexcept;

/// In space.
/// @param tet  the face's owner
[[nodiscard]] inline Vec3 pointInFace(const std::array<double, 3>& shares, const Tet& tet, int face,
                                      std::span<const Vec3> points) noexcept {
  Vec3 point{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto corner = static_cast<std::size_t>(kFaceCorners[static_cast<std::size_t>(face)][i]);
    const Vec3& p = points[tet[corner]];
    for (std::size_t k = 0; k < 3; ++k) point[k] += shares[i] * p[k];
  }
  return point;
}

/// A face as its owner has it, with an edge that crosses it.
struct OwnedCrossing {
  OwnedSimplex face;
  ChartEdge edge;

  /// @param edge  in the chart of the tet
  OwnedCrossing(const PreparedMap& map, Index tet, int localFace, const ChartEdge& inTet) noexcept
      : face{tet, faceMask(localFace)}, edge(inTet) {
    const HalfFace halfFace = halfFaceOf(tet, localFace);
    const HalfFace mate = map.topology.mate[halfFace];
    if (mate == kNone || tet < tetOf(mate)) return;
    face = {tetOf(mate), faceMask(localOf(mate))};
    edge = inTet.across(map.exact.transitions, halfFace);
  }
};

}  // namespace hexhex
