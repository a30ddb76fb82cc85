// Which tets of a map are positive, and which can be used although the map is invalid.
#pragma once

#include <cstdint>
#include <vector>

#include <hexhex/types.hpp>

#include <base/disjoint_sets.hpp>
#include <igm/igm.hpp>
#include <igm/input.hpp>
#include <igm/sanitization.hpp>

namespace hexhex::repairs {

/// det(u1 - u0, u2 - u0, u3 - u0): six times the signed volume.
[[nodiscard]] double determinantOf(const TetParameters& u) noexcept;

/// Whether a tet is flipped or flat, as far as floating point can tell.
[[nodiscard]] bool isBad(const TetParameters& u) noexcept;

/// Whether moving corners by up to `noise` along each axis could make a tet bad: its angles are
/// meaningless.
[[nodiscard]] bool isThin(const TetParameters& u, double noise) noexcept;

/// All bad tets, ascending.
[[nodiscard]] std::vector<Index> findBadTets(std::size_t tets,
                                             const igm::LocalParameters& parameters, Stage& stage);

/// The tets that are not positive on the sanitized lattice, ascending.
[[nodiscard]] std::vector<Index> findExactlyBadTets(const igm::ExactMap& map, Stage& stage);

/// Unites tets that share a triangle and both pass a test.
template <class Test>
[[nodiscard]] DisjointSets componentsOf(const adjacency::TetTopology& topology, const Test& test) {
  DisjointSets sets(topology.tetCount());
  for (adjacency::HalfFace halfFace = 0; halfFace < topology.mate.size(); ++halfFace) {
    const adjacency::HalfFace mate = topology.mate[halfFace];
    if (mate == kNone || mate < halfFace) continue;
    if (test(adjacency::tetOf(halfFace)) && test(adjacency::tetOf(mate)))
      sets.unite(adjacency::tetOf(halfFace), adjacency::tetOf(mate));
  }
  return sets;
}

/// Whether the transition maps the three lattice corners of an inner triangle to those in the other
/// tet.
[[nodiscard]] bool isCarriedOver(const igm::PreparedMap& map,
                                 adjacency::HalfFace halfFace) noexcept;

/// Per tet: 1 if it is positive on the sanitized lattice and sanitization moved its corners by at
/// most the tolerance.
[[nodiscard]] std::vector<std::uint8_t> findValidTets(const igm::PreparedMap& map,
                                                      const igm::LocalParameters& parameters,
                                                      double tolerance, Stage& stage);

}  // namespace hexhex::repairs
