// Coordinates of one hex edge, face or cell, wherever it goes.
#pragma once

#include <array>
#include <cstdint>

#include <igm/transitions.hpp>
#include <lattice/tet_geometry.hpp>
#include <lattice/transition.hpp>

namespace hexhex {

/// A hex edge in the chart of a tet: from a grid point to its neighbour.
struct ChartEdge {
  GridPoint z;
  Direction along;

  /// Carries it across a face.
  [[nodiscard]] ChartEdge across(const Transitions& transitions, HalfFace halfFace) const noexcept {
    if (!transitions.isNonTrivial(halfFace)) return *this;
    const Transition& transition = transitions.across(halfFace);
    return {transition(z), transition(along)};
  }
};

/// A right-handed coordinate system of the grid, in the chart of some tet: edges run from the
/// origin along axis 0, squares between axes 0 and 1, cubes along all three. Carried from tet to
/// tet, it shows every corner of a tet at the same place, whatever the charts.
struct Frame {
  GridPoint origin{};
  std::array<Direction, 3> axes{};

  /// The frame of a grid point whose first axis is the given one, the others following cyclically.
  [[nodiscard]] static constexpr Frame along(const GridPoint& z, int axis) noexcept {
    return {z, {direction(axis, 1), direction((axis + 1) % 3, 1), direction((axis + 2) % 3, 1)}};
  }

  [[nodiscard]] constexpr Frame carried(const Transition& transition) const noexcept {
    return {transition(origin), {transition(axes[0]), transition(axes[1]), transition(axes[2])}};
  }

  /// Carries it across a face, if charts differ there.
  /// @return whether they do
  bool cross(const Transitions& transitions, HalfFace halfFace) noexcept {
    if (!transitions.isNonTrivial(halfFace)) return false;
    *this = carried(transitions.across(halfFace));
    return true;
  }

  /// The frame of the same edge from its other end.
  [[nodiscard]] constexpr Frame reversed() const noexcept {
    return {at({1, 0, 0}), {opposite(axes[0]), opposite(axes[1]), axes[2]}};
  }

  /// The edge along the first axis.
  [[nodiscard]] constexpr ChartEdge edge() const noexcept { return {origin, axes[0]}; }

  /// The grid point at integer coordinates of the frame, in the chart.
  [[nodiscard]] constexpr GridPoint at(const GridPoint& c) const noexcept {
    GridPoint z = origin;
    for (std::size_t k = 0; k < 3; ++k) {
      z[static_cast<std::size_t>(axisOf(axes[k]))] += signOf(axes[k]) * c[k];
    }
    return z;
  }

  /// A lattice point in the frame's coordinates, exact.
  [[nodiscard]] constexpr LatticePoint see(const LatticePoint& p,
                                           std::int64_t unit) const noexcept {
    LatticePoint seen;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(axisOf(axes[k]));
      seen[k] = signOf(axes[k]) * (p[axis] - origin[axis] * unit);
    }
    return seen;
  }
  [[nodiscard]] constexpr LatticeTet see(const LatticeTet& tet, std::int64_t unit) const noexcept {
    LatticeTet seen;  // not cleared first
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(axisOf(axes[k]));
      const std::int64_t zero = origin[axis] * unit;
      for (std::size_t i = 0; i < 4; ++i) {
        const std::int64_t offset = tet[i][axis] - zero;
        seen[i][k] = signOf(axes[k]) < 0 ? -offset : offset;
      }
    }
    return seen;
  }

  [[nodiscard]] constexpr bool operator==(const Frame&) const = default;
};

}  // namespace hexhex
