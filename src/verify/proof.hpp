// Is a mesh in canonical order the mesh of a map? A proof that looks at every lattice point and
// every cell centre of the map once.
//
// 1. Lattice points: exact predicates show that those named by a sweep over the tets are in their
//    tets, no two are the same, and their number is what the Euler characteristic, the boundary's
//    area and the lengths of singular curves imply. So the list is complete. Vertex i is the i-th
//    lattice point if it is at that point's position in space.
// 2. Centres: likewise; their number is what the volume implies. Cell i is the one around centre i.
// 3. Corners: the half diagonal from the centre to each corner ends at the lattice point of the
//    cell's vertex.
//
// The sweep and the numbering are those of the engines: both are hints, which the steps above prove
// or refute. The proof trusts only the prepared map and the exact predicates.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <verify/lattice_places.hpp>

#include <hexhex/check.hpp>
#include <hexhex/parts.hpp>

#include <sweep/cell_order.hpp>
#include <sweep/tet_counts.hpp>

namespace hexhex::verification {

/// What a scaled map implies. Adds stars to its topology.
[[nodiscard]] Expectation expectationOf(igm::PreparedMap& map, Stage& stage);

/// Numbers of vertices, edges and faces of the mesh that a map implies.
struct ExpectedElements {
  std::uint64_t vertices = 0;
  std::uint64_t edges = 0;
  std::uint64_t faces = 0;
};
[[nodiscard]] ExpectedElements expectedElements(const Expectation& expected) noexcept;

/// Checks a mesh, as a whole or piece by piece. It has as many points and cells as expected.
class Proof {
 public:
  /// For a whole mesh.
  /// @param map       scaled; must outlive this
  /// @param expected  of the scaled map
  Proof(const igm::PreparedMap& map, const Expectation& expected, Stage& stage);
  /// For pieces: each proves anew what it needs, so that only this is in memory.
  /// @param counts  hints; outlive this
  Proof(const igm::PreparedMap& map, const Expectation& expected,
        const sweep::ElementCounts& counts);

  /// Points from number `first` on. Call only while the hints hold.
  void compare(std::uint64_t first, std::span<const Vec3> points, Stage& stage);
  /// Cells from number `first` on; likewise.
  template <class Cell>
  void compare(std::uint64_t first, std::span<const Cell> cells, Stage& stage);

  [[nodiscard]] const Faults& hints() const noexcept { return hints_; }  ///< wrong tets
  [[nodiscard]] const Faults& positions() const noexcept { return positions_; }
  [[nodiscard]] const Faults& cells() const noexcept { return cells_; }
  /// Whether everything compared so far is right.
  [[nodiscard]] bool passed() const noexcept {
    return hints_.count() + positions_.count() + cells_.count() == 0;
  }

 private:
  void requireCounts(const Expectation& expected);
  template <class Cell>
  [[nodiscard]] std::vector<Index> ownersOf(std::span<const Cell> cells, Stage& stage) const;

  const igm::PreparedMap& map_;
  LatticePlaces places_;
  sweep::CellCenters centers_;
  bool inPieces_;
  Faults hints_;
  Faults positions_;
  Faults cells_;
};

/// Checks a whole mesh. Only a mesh in canonical order can pass.
[[nodiscard]] bool isProven(const igm::PreparedMap& map, const Expectation& expected,
                            const HexMesh& mesh, Stage& stage);

// Is a part of a mesh a part of the mesh of a map? The proof of proof.hpp, part by part, in memory
// that does not grow with the whole mesh: each part proves the tets that own something of it. Since
// the numbers of vertices and cells are those that the map implies, tets that own nothing of any
// part own nothing at all. PartSummarySink checks by the numbers that nothing is missing.

class PartProof {
 public:
  /// @param map       scaled; outlives this, as do the counts
  /// @param expected  of the scaled map
  /// @param counts    hints
  /// @throws Error VerificationFailed if there are more or fewer vertices or cells than expected
  PartProof(const igm::PreparedMap& map, const Expectation& expected,
            const sweep::ElementCounts& counts);

  /// Checks all vertices and cells of a part, including ghosts.
  /// @throws Error VerificationFailed, naming the first that is wrong
  void compare(const MeshPart& part, Stage& stage);

 private:
  [[nodiscard]] std::vector<Index> tetsOf(const MeshPart& part, Faults& wrongPoints,
                                          Faults& wrongCells) const;
  void comparePoints(const MeshPart& part, Stage& stage, Faults& wrong) const;
  template <class Cell>
  void compareCells(const MeshPart& part, Stage& stage, Faults& hints, Faults& wrong) const;

  const igm::PreparedMap& map_;
  LatticePlaces places_;
  sweep::CellCenters centers_;
};

}  // namespace hexhex::verification
