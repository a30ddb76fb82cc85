// Is a mesh in canonical order the mesh of a map? A proof: every lattice point and every cell
// centre of the map is looked at once.
//
//  1. Lattice points: those that a sweep over the tets names are in their tets by exact predicates,
//     no two are the same, and they are as many as the Euler characteristic, the boundary's area
//     and the lengths of singular curves demand. So they are all. Vertex i is the i-th, if it is
//     there in space.
//  2. Centres: likewise, as many as the volume demands. Cell i is the one around the i-th.
//  3. Corners: the half diagonal from the centre to each corner ends at the lattice point that the
//     cell's vertex is.
//
// The sweep is that of the engines, and so is the numbering: both are hints, which the steps above
// prove or refute. What is believed are the prepared map and the exact predicates.
#pragma once

#include <cstdint>
#include <span>

#include <verify/lattice_places.hpp>

#include <hexhex/check.hpp>

#include <sweep/cell_centers.hpp>

namespace hexhex::verification {

/// What follows from a scaled map, whose topology gets stars.
[[nodiscard]] Expectation expectationOf(igm::PreparedMap& map, Stage& stage);

/// How many vertices, edges and faces the mesh of a map has.
struct ExpectedElements {
  std::uint64_t vertices = 0;
  std::uint64_t edges = 0;
  std::uint64_t faces = 0;
};
[[nodiscard]] ExpectedElements expectedElements(const Expectation& expected) noexcept;

/// Looks at a mesh, as a whole or piece by piece. It has as many points and cells as expected.
class Proof {
 public:
  /// @param map       scaled; must outlive this
  /// @param expected  of the scaled map
  /// @param indexed   as of LatticePlaces
  Proof(const igm::PreparedMap& map, const Expectation& expected, bool indexed, Stage& stage);

  /// Points from number `first` on. To be called only as long as the hints are right.
  void compare(std::uint64_t first, std::span<const Vec3> points, Stage& stage) {
    places_.compare(first, points, stage, positions_);
  }
  /// Cells from number `first` on; likewise.
  template <class Cell>
  void compare(std::uint64_t first, std::span<const Cell> cells, Stage& stage);

  [[nodiscard]] const Faults& hints() const noexcept { return hints_; }  ///< tets
  [[nodiscard]] const Faults& positions() const noexcept { return positions_; }
  [[nodiscard]] const Faults& cells() const noexcept { return cells_; }
  /// All that was compared so far.
  [[nodiscard]] bool passed() const noexcept {
    return hints_.count() + positions_.count() + cells_.count() == 0;
  }

 private:
  const igm::PreparedMap& map_;
  LatticePlaces places_;
  sweep::CellCenters centers_;
  Faults hints_;
  Faults positions_;
  Faults cells_;
};

/// Looks at a whole mesh. Only one in canonical order can pass.
[[nodiscard]] bool isProven(const igm::PreparedMap& map, const Expectation& expected,
                            const HexMesh& mesh, Stage& stage);

}  // namespace hexhex::verification
