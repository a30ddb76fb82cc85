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
#include <vector>

#include <verify/lattice_places.hpp>

#include <hexhex/check.hpp>
#include <hexhex/parts.hpp>

#include <sweep/cell_centers.hpp>
#include <sweep/tet_counts.hpp>

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

// Is a part of a mesh a part of the mesh of a map? The proof of proof.hpp, one part after the
// other, in memory that does not grow with the whole mesh: each part proves the tets that own
// something of it. As the numbers of vertices and cells are those that the map demands, tets that
// own nothing of any part own nothing at all. That all is there, PartSurvey sees by the numbers.

class PartProof {
 public:
  /// @param map       scaled; outlives this, and so do the counts
  /// @param expected  of the scaled map
  /// @param counts    hints
  /// @throws Error VerificationFailed if there are more or fewer vertices or cells than expected
  PartProof(const igm::PreparedMap& map, const Expectation& expected,
            const sweep::ElementCounts& counts);

  /// Looks at all vertices and cells of a part, ghosts too.
  /// @throws Error VerificationFailed, naming the first that is wrong
  void compare(const MeshPart& part, Stage& stage);

 private:
  [[nodiscard]] std::vector<Index> tetsOf(const MeshPart& part, Faults& wrongPoints,
                                          Faults& wrongCells) const;
  void comparePoints(const MeshPart& part, Stage& stage, Faults& wrong) const;
  void compareCells(const MeshPart& part, Stage& stage, Faults& hints, Faults& wrong) const;

  const igm::PreparedMap& map_;
  LatticePlaces places_;
  sweep::CellCenters centers_;
};

}  // namespace hexhex::verification
