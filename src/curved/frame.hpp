// Coordinates of one hex edge, face or cell, wherever it goes.
#pragma once

#include <array>
#include <cstdint>

#include <igm/transitions.hpp>
#include <lattice/tet_geometry.hpp>
#include <lattice/transition.hpp>

namespace hexhex::curved {

/// A hex edge in the chart of a tet: from a grid point to its neighbour.
struct ChartEdge {
  lattice::GridPoint z;
  lattice::Direction along;

  /// Carries it across a face.
  [[nodiscard]] ChartEdge across(const igm::Transitions& transitions,
                                 adjacency::HalfFace halfFace) const noexcept {
    if (!transitions.isNonTrivial(halfFace)) return *this;
    const lattice::Transition& transition = transitions.across(halfFace);
    return {transition(z), transition(along)};
  }
};

/// A right-handed coordinate system of the grid, in the chart of some tet: edges run from the
/// origin along axis 0, squares between axes 0 and 1, cubes along all three. Carried from tet to
/// tet, it shows every corner of a tet at the same place, whatever the charts.
struct Frame {
  lattice::GridPoint origin{};
  std::array<lattice::Direction, 3> axes{};

  /// The frame of a grid point whose first axis is the given one, the others following cyclically.
  [[nodiscard]] static constexpr Frame along(const lattice::GridPoint& z, int axis) noexcept {
    return {z,
            {lattice::direction(axis, 1), lattice::direction((axis + 1) % 3, 1),
             lattice::direction((axis + 2) % 3, 1)}};
  }

  [[nodiscard]] constexpr Frame carried(const lattice::Transition& transition) const noexcept {
    return {transition(origin), {transition(axes[0]), transition(axes[1]), transition(axes[2])}};
  }

  /// Carries it across a face, if charts differ there.
  /// @return whether they do
  bool cross(const igm::Transitions& transitions, adjacency::HalfFace halfFace) noexcept {
    if (!transitions.isNonTrivial(halfFace)) return false;
    *this = carried(transitions.across(halfFace));
    return true;
  }

  /// The frame of the same edge from its other end.
  [[nodiscard]] constexpr Frame reversed() const noexcept {
    return {at({1, 0, 0}), {lattice::opposite(axes[0]), lattice::opposite(axes[1]), axes[2]}};
  }

  /// The edge along the first axis.
  [[nodiscard]] constexpr ChartEdge edge() const noexcept { return {origin, axes[0]}; }

  /// The grid point at integer coordinates of the frame, in the chart.
  [[nodiscard]] constexpr lattice::GridPoint at(const lattice::GridPoint& c) const noexcept {
    lattice::GridPoint z = origin;
    for (std::size_t k = 0; k < 3; ++k) {
      z[static_cast<std::size_t>(lattice::axisOf(axes[k]))] += lattice::signOf(axes[k]) * c[k];
    }
    return z;
  }

  /// A lattice point in the frame's coordinates, exact.
  [[nodiscard]] constexpr lattice::LatticePoint see(const lattice::LatticePoint& p,
                                                    std::int64_t unit) const noexcept {
    lattice::LatticePoint seen;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(lattice::axisOf(axes[k]));
      seen[k] = lattice::signOf(axes[k]) * (p[axis] - origin[axis] * unit);
    }
    return seen;
  }
  [[nodiscard]] constexpr lattice::LatticeTet see(const lattice::LatticeTet& tet,
                                                  std::int64_t unit) const noexcept {
    lattice::LatticeTet seen;  // not cleared first
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(lattice::axisOf(axes[k]));
      const std::int64_t zero = origin[axis] * unit;
      for (std::size_t i = 0; i < 4; ++i) {
        const std::int64_t offset = tet[i][axis] - zero;
        seen[i][k] = lattice::signOf(axes[k]) < 0 ? -offset : offset;
      }
    }
    return seen;
  }

  [[nodiscard]] constexpr bool operator==(const Frame&) const = default;
};

}  // namespace hexhex::curved
