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

#include <atomic>
#include <cstdint>

#include <hexhex/check.hpp>

#include <base/parallel.hpp>
#include <igm/prepare.hpp>

namespace hexhex {

/// Things that are wrong, found by several threads: how many, and the first.
class Faults {
 public:
  void add(std::size_t place) noexcept {
    ++count_;
    lowerTo(place, first_);
  }
  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  [[nodiscard]] std::size_t first() const noexcept { return first_; }

 private:
  std::atomic<std::uint64_t> count_{0};
  std::atomic<std::size_t> first_{static_cast<std::size_t>(-1)};
};

/// How many vertices, edges and faces the mesh of a map has.
struct ElementCounts {
  std::uint64_t vertices = 0;
  std::uint64_t edges = 0;
  std::uint64_t faces = 0;
};
[[nodiscard]] ElementCounts expectedElements(const Expectation& expected) noexcept;

struct Proof {
  Faults sweep;               ///< tets of which the hints are wrong
  Faults positions;           ///< vertices that are not where their lattice points are
  Faults cells;               ///< cells with wrong corners
  bool numbersAgree = false;  ///< as many vertices and cells as expected

  [[nodiscard]] bool passed() const noexcept {
    return numbersAgree && sweep.count() + positions.count() + cells.count() == 0;
  }
};

/// Fills `proof`.
/// @param map       scaled
/// @param expected  of the scaled map
/// @param mesh      with corners in range; in any order, but only one in canonical order can pass
void prove(const PreparedMap& map, const Expectation& expected, const HexMesh& mesh, Stage& stage,
           Proof& proof);

}  // namespace hexhex
