// Coordinates of one hex edge, face or cell, carried from chart to chart.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <adjacency/edge_fan.hpp>
#include <adjacency/key_table.hpp>

#include <igm/sanitization.hpp>
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

/// A right-handed coordinate system of the grid, expressed in the chart of some tet: edges run from
/// the origin along axis 0, squares between axes 0 and 1, cubes along all three. As it is carried
/// from tet to tet, every tet corner keeps its coordinates in it, whatever the charts.
struct Frame {
  lattice::Transition toChart;

  /// The frame at a grid point with the given axis first and the others following cyclically.
  [[nodiscard]] static constexpr Frame along(const lattice::GridPoint& z, int axis) noexcept {
    return {{lattice::Rotation::fromAxes(lattice::direction(axis, 1),
                                         lattice::direction((axis + 1) % 3, 1)),
             z}};
  }

  [[nodiscard]] constexpr const lattice::GridPoint& origin() const noexcept {
    return toChart.translation;
  }
  /// The direction of an axis in the chart.
  [[nodiscard]] constexpr lattice::Direction axis(std::size_t k) const noexcept {
    return toChart(lattice::direction(static_cast<int>(k), 1));
  }

  /// Carries the frame across a face if the charts differ there.
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

  /// A lattice point, or the corners of a tet, in exact frame coordinates.
  template <class Points>
  [[nodiscard]] constexpr Points see(const Points& points, std::int64_t unit) const noexcept {
    return toChart.inverse()(points, unit);
  }

  [[nodiscard]] constexpr bool operator==(const Frame&) const = default;
};

// Simplices of tets: their owners, and all tets around one, each with a frame carried to it.

/// A simplex, identified by the smallest tet that contains it.
struct OwnedSimplex {
  Index tet;
  lattice::CornerMask corners;
};

/// A face of a tet, identified by its owner.
[[nodiscard]] inline OwnedSimplex ownedFace(const adjacency::TetTopology& topology, Index tet,
                                            int face) {
  const adjacency::HalfFace mate = topology.mate[adjacency::halfFaceOf(tet, face)];
  if (mate == kNone || tet < adjacency::tetOf(mate)) return {tet, lattice::faceMask(face)};
  return {adjacency::tetOf(mate), lattice::faceMask(adjacency::localOf(mate))};
}

/// A simplex of a tet, identified by its owner.
[[nodiscard]] inline OwnedSimplex ownedBy(const adjacency::TetTopology& topology, Index tet,
                                          lattice::CornerMask simplex) {
  if (simplex == lattice::kWholeTet) return {tet, simplex};
  if (lattice::dimension(simplex) == 2)
    return ownedFace(topology, tet, lattice::oppositeCorner(simplex));
  const Index owner = adjacency::ownerTet(topology, tet, simplex);
  return {owner, owner == tet ? simplex : topology.translated(simplex, tet, owner)};
}

/// A simplex as seen from one of the tets around it.
struct SimplexInTet {
  Index tet = kNone;
  lattice::CornerMask simplex = lattice::kNoSimplex;
  Frame frame;
};

/// Crosses a face that is not on the boundary and contains the simplex; a whole tet becomes the
/// whole neighbour.
[[nodiscard]] inline SimplexInTet crossed(const adjacency::TetTopology& topology,
                                          const igm::ExactMap& map, const SimplexInTet& from,
                                          int face) {
  const adjacency::HalfFace halfFace = adjacency::halfFaceOf(from.tet, face);
  const Index next = adjacency::tetOf(topology.mate[halfFace]);
  SimplexInTet to{next, lattice::kWholeTet, from.frame};
  if (from.simplex != lattice::kWholeTet)
    to.simplex = adjacency::acrossFace(topology, halfFace, from.simplex);
  to.frame.cross(map.transitions, halfFace);
  return to;
}

/// Walks around simplices. One per thread.
class SimplexStar {
 public:
  SimplexStar(const adjacency::TetTopology& topology, const igm::ExactMap& map)
      : topology_(topology), map_(map) {}

  /// Visits all tets around a simplex, breadth first across faces, starting from one of them. Frame
  /// coordinates must be invariant under a walk around the simplex: those of the line of a hex edge
  /// if the edge contains a point of the simplex, those of the plane of a hex face if the face's
  /// interior does.
  /// @param visit  called with a SimplexInTet; returns true to stop
  /// @return whether it was stopped
  template <class Visit>
  bool visit(const SimplexInTet& start, const Visit& visit) {
    if (visit(start)) return true;
    switch (lattice::dimension(start.simplex)) {
      case 3:
        return false;
      case 2: {
        const int face = lattice::oppositeCorner(start.simplex);
        if (topology_.mate[adjacency::halfFaceOf(start.tet, face)] == kNone) return false;
        return visit(crossed(topology_, map_, start, face));
      }
      case 1:
        return visitAroundEdge(start, visit);
      default:
        return visitAroundVertex(start, visit);
    }
  }

 private:
  template <class Visit>
  bool visitAroundEdge(const SimplexInTet& start, const Visit& visit) const {
    bool isStopped = false;
    adjacency::visitAroundEdge(
        topology_, start.tet, start.simplex, start.frame,
        [this](Frame frame, adjacency::HalfFace out) {
          frame.cross(map_.transitions, out);
          return frame;
        },
        [&](const auto& turn, const Frame& frame) {
          isStopped = visit(SimplexInTet{turn.tet(), turn.edge(), frame});
          return !isStopped;
        });
    return isStopped;
  }

  template <class Visit>
  bool visitAroundVertex(const SimplexInTet& start, const Visit& visit) {
    seen_.clear();
    members_.assign(1, start);
    seen_.insert(start.tet);
    for (std::size_t head = 0; head < members_.size(); ++head) {
      const SimplexInTet here = members_[head];
      for (int face = 0; face < 4; ++face) {
        if (lattice::contains(here.simplex, face)) continue;
        const adjacency::HalfFace mate = topology_.mate[adjacency::halfFaceOf(here.tet, face)];
        if (mate == kNone || seen_.insert(adjacency::tetOf(mate)) < members_.size()) continue;
        members_.push_back(crossed(topology_, map_, here, face));
        const SimplexInTet next = members_.back();
        if (visit(next)) return true;
      }
    }
    return false;
  }

  const adjacency::TetTopology& topology_;
  const igm::ExactMap& map_;
  adjacency::KeyTable seen_;
  std::vector<SimplexInTet> members_;
};

}  // namespace hexhex::curved
