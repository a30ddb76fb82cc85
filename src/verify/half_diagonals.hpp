// Follows half diagonals, from the centre of a cell straight to its corners, to tell which lattice
// points the corners are. Verification has a way of its own (the engines follow them in
// sweep/cell_tracer), so that it shares no decision with what it verifies.
//
// Inside the open unit cube of a cell the map is one to one. So whichever triangles a path crosses,
// it comes to the same lattice point, if each of them has a point inside of the cube. Here that is
// a point of the segment itself, which may well be on an edge of the triangle: no segment is
// tilted, and where there are several triangles to cross, any of them will do.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <verify/lattice_places.hpp>

namespace hexhex::verification {

/// Whether two places are the same point of the map.
[[nodiscard]] bool areSamePoint(const igm::PreparedMap& map, const LatticePlace& a,
                                const LatticePlace& b);

/// One per thread.
class HalfDiagonals {
 public:
  /// @param places  proven
  HalfDiagonals(const igm::PreparedMap& map, const LatticePlaces& places) noexcept
      : map_(map), places_(places), half_(map.exact.unit / 2) {}

  /// A half diagonal, or what is left of it, as a tet sees it, in lattice units.
  struct Segment {
    Index tet;
    lattice::LatticePoint start;  ///< in the tet, or, seen from farther tets, before it
    lattice::LatticePoint end;
  };

  /// Whether a half diagonal ends at a lattice point.
  /// @param exit   the face through which it leaves the tet, or kNoExit: unknown
  /// @param point  its number
  [[nodiscard]] bool endsAt(Segment segment, int exit, std::uint64_t point);
  /// Whether a place is that of a lattice point.
  [[nodiscard]] bool isAt(const LatticePlace& place, std::uint64_t point);

 private:
  /// What floating point proves about a tet on the way.
  enum class Step : std::uint8_t { EndsInside, Leaves, IsUncertain };
  [[nodiscard]] Step look(const Segment& segment, int& exit) const noexcept;
  [[nodiscard]] bool isAtEnd(const Segment& segment, const lattice::GridPoint& z) const noexcept;
  [[nodiscard]] static bool crossesFirst(const Segment& segment, const lattice::LatticeTet& tet,
                                         int face);
  [[nodiscard]] bool cross(Segment& segment, int face) const noexcept;
  [[nodiscard]] std::optional<LatticePlace> followExactly(const Segment& segment);
  [[nodiscard]] LatticePlace endOf(const Segment& segment,
                                   lattice::CornerMask simplex) const noexcept;

  const igm::PreparedMap& map_;
  const LatticePlaces& places_;
  std::int64_t half_;              ///< of a grid unit, in lattice units
  Index owner_ = 0;                ///< of the point that was looked for last
  std::vector<Segment> segments_;  ///< working memory
};

}  // namespace hexhex::verification
