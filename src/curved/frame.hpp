// Coordinates of one hex edge, face or cell, wherever it goes.
#pragma once

#include <array>
#include <cstdint>

#include <igm/transitions.hpp>
#include <lattice/grid_motion.hpp>
#include <lattice/tet_geometry.hpp>

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
  lattice::Transition toChart;

  /// The frame of a grid point whose first axis is the given one, the others following cyclically.
  [[nodiscard]] static constexpr Frame along(const lattice::GridPoint& z, int axis) noexcept {
    return {{lattice::Rotation::fromAxes(lattice::direction(axis, 1),
                                         lattice::direction((axis + 1) % 3, 1)),
             z}};
  }

  [[nodiscard]] constexpr const lattice::GridPoint& origin() const noexcept {
    return toChart.translation;
  }
  /// Where an axis goes in the chart.
  [[nodiscard]] constexpr lattice::Direction axis(std::size_t k) const noexcept {
    return toChart(lattice::direction(static_cast<int>(k), 1));
  }

  /// Carries it across a face, if charts differ there.
  /// @return whether they do
  bool cross(const igm::Transitions& transitions, adjacency::HalfFace halfFace) noexcept {
    if (!transitions.isNonTrivial(halfFace)) return false;
    toChart = transitions.across(halfFace) * toChart;
    return true;
  }

  /// The frame of the same edge from its other end.
  [[nodiscard]] constexpr Frame reversed() const noexcept {
    constexpr lattice::Transition kTurned{
        lattice::Rotation::fromAxes(lattice::direction(0, -1), lattice::direction(1, -1)),
        {1, 0, 0}};
    return {toChart * kTurned};
  }

  /// The edge along the first axis.
  [[nodiscard]] constexpr ChartEdge edge() const noexcept { return {origin(), axis(0)}; }

  /// A lattice point, or the corners of a tet, in the frame's coordinates, exact.
  template <class Points>
  [[nodiscard]] constexpr Points see(const Points& points, std::int64_t unit) const noexcept {
    return toChart.inverse()(points, unit);
  }

  [[nodiscard]] constexpr bool operator==(const Frame&) const = default;
};

}  // namespace hexhex::curved
