// Is a part of a mesh a part of the mesh of a map? The proof of proof.hpp, one part after the
// other, in memory that does not grow with the whole mesh: each part proves the tets that own
// something of it. As the numbers of vertices and cells are those that the map demands, tets that
// own nothing of any part own nothing at all. That all is there, PartSurvey sees by the numbers.
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
