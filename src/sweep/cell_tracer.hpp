// Traces half diagonals, from the centre of a cell straight to its corners, tet by tet, with exact
// predicates.
//
// Inside the open unit cube of a cell the map is one to one, so the segment can be followed
// whatever the charts. It ends not at the corner itself but beside it, at corner + e d1 + e^2 d2 +
// e^3 d3, with an infinitesimal e and the directions d1, d2, d3 of the cell's edges at the corner.
// A segment tilted like that meets no edge and no vertex of the tet mesh, so every decision has one
// answer, and it ends in a tet that contains the beginning of edge d1 and of the square between d1
// and d2.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include <igm/igm.hpp>

namespace hexhex::sweep {

/// The axes of a cell in the order in which segments are tilted along them: d1, d2, d3.
using TiltOrder = std::array<std::uint8_t, 3>;

/// Where a segment from a centre to a corner ends.
struct CornerPlace {
  Index tet;                   ///< contains the corner, and the segment's end beside it
  lattice::GridPoint z;        ///< the corner in that tet's chart
  lattice::Rotation rotation;  ///< from the chart of the centre's owner to that of `tet`
};

/// Traces the corners of one cell after the other. One per thread.
class CellTracer {
 public:
  explicit CellTracer(const igm::PreparedMap& map) noexcept
      : topology_(map.topology),
        exact_(map.exact),
        half_(map.exact.unit / 2),
        shift_(std::countr_zero(static_cast<std::uint64_t>(map.exact.unit))) {}

  /// Selects the cell with smallest corner z in the chart of a tet that contains the cell's centre.
  /// @param generator  the simplex of the tet whose interior contains the centre
  void enter(Index tet, const lattice::GridPoint& z, lattice::CornerMask generator) noexcept;

  /// Traces to one corner of the cell.
  /// @param offset  of the corner from z, each 0 or 1
  [[nodiscard]] CornerPlace trace(const lattice::GridPoint& offset,
                                  const TiltOrder& tilts = {0, 1, 2});

 private:
  /// A corner of a tet seen along a segment: a point (x, y) of a plane with the segment at its
  /// origin, and a depth, rounded; relative to the cell's centre, in lattice units.
  struct Seen {
    double x;
    double y;
    double depth;
    double size;  ///< sum of magnitudes of the corner's coordinates
  };

  /// A segment through a tet: everything in the tet's chart, in lattice units.
  struct Segment {
    Index tet;
    int entered;  ///< face through which it entered, or -1
    lattice::LatticePoint center;
    std::array<int, 3> along;  ///< from the centre to the corner: +1 or -1 in each axis
    std::array<lattice::Direction, 3> tilts;  ///< d1, d2, d3: the corner's edges
    lattice::Rotation rotation;               ///< from the first tet's chart
    std::array<Seen, 4> seen;
  };

  [[nodiscard]] Segment begin(const lattice::GridPoint& offset, const TiltOrder& tilts);
  [[nodiscard]] lattice::LatticePoint relative(const Segment& segment, int corner) const noexcept;
  [[nodiscard]] lattice::LatticeTet relativeTet(const Segment& segment) const noexcept;
  [[nodiscard]] static Seen seenAs(const Segment& segment, const std::array<double, 3>& r) noexcept;
  void look(Segment& segment, std::size_t corner) const noexcept;
  [[nodiscard]] int side(const Segment& segment, int i, int j) const noexcept;
  [[nodiscard]] int exactSide(const Segment& segment, int i, int j) const noexcept;
  [[nodiscard]] int exitFromInside(const Segment& segment) const noexcept;
  [[nodiscard]] int exitAfterEntry(const Segment& segment) const noexcept;
  [[nodiscard]] bool endsBefore(const Segment& segment, int face) const noexcept;
  [[nodiscard]] bool endsExactlyBefore(const Segment& segment, int face) const noexcept;
  void cross(Segment& segment, int face) const;
  [[nodiscard]] Segment startAroundCenter(const Segment& segment);
  [[noreturn]] static void fail(Index tet, const char* what);

  const adjacency::TetTopology& topology_;
  const igm::ExactMap& exact_;
  std::int64_t half_;  ///< half a grid unit, in lattice units
  int shift_;          ///< the unit's binary logarithm

  // The cell:
  Index tet_ = 0;
  lattice::GridPoint z_{};
  lattice::CornerMask generator_ = lattice::kNoSimplex;
  lattice::LatticePoint center_{};
  std::array<std::array<double, 3>, 4> corners_{};  ///< of the tet, from the centre
  std::vector<Segment> star_;                       ///< working memory
};

}  // namespace hexhex::sweep
