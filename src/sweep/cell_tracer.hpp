// From the centre of a cell straight to its corners, tet by tet, by exact predicates.
//
// Inside the open unit cube of a cell the map is one to one, so the way is unambiguous whatever the
// charts. It does not end at the corner itself but beside it, at corner + e d1 + e^2 d2 + e^3 d3
// with an infinitesimal e and the directions d1, d2, d3 of the cell's edges at the corner. A way
// that is tilted like that meets no edge and no vertex of the tet mesh, so every decision has one
// answer, and it ends in a tet that holds the beginning of edge d1 and of the square between d1 and
// d2.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <map/prepare.hpp>

namespace hexhex {

/// Where a way from a centre to a corner ends.
struct CornerPlace {
  Index tet;          ///< contains the corner, and the way's end beside it
  GridPoint z;        ///< the corner in that tet's chart
  Rotation rotation;  ///< from the chart of the centre's owner to that of `tet`
};

class CellTracer {
 public:
  explicit CellTracer(const PreparedMap& map) noexcept
      : topology_(map.topology), exact_(map.exact) {}

  /// Traces to one corner of the cell with smallest corner z in the chart of a tet that contains
  /// the cell's centre.
  /// @param generator  the simplex of the tet in whose interior the centre lies
  /// @param offset     of the corner from z, each 0 or 1
  [[nodiscard]] CornerPlace trace(Index tet, const GridPoint& z, CornerMask generator,
                                  const GridPoint& offset);

 private:
  /// A way through a tet: everything in the tet's chart, in lattice units.
  struct Way {
    Index tet;
    LatticePoint center;
    std::array<int, 3> along;        ///< from the centre to the corner: +1 or -1 in each axis
    std::array<Direction, 3> tilts;  ///< d1, d2, d3: the corner's edges
    Rotation rotation;               ///< from the first tet's chart
  };

  [[nodiscard]] Way across(const Way& way, int face) const;
  [[nodiscard]] Way startAroundCenter(const Way& way);
  [[nodiscard]] bool leadsInto(const Way& way) const;
  [[nodiscard]] int exitFace(const Way& way) const;
  [[nodiscard]] bool endsBefore(const Way& way, int face, const LatticePoint& corner) const;
  [[noreturn]] static void fail(Index tet, const char* what);

  const TetTopology& topology_;
  const ExactMap& exact_;
  std::vector<Way> star_;  ///< working memory
};

}  // namespace hexhex
