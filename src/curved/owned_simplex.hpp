// Simplices by the smallest tet that contains them.
#pragma once

#include <map/tet_topology.hpp>

namespace hexhex {

struct OwnedSimplex {
  Index tet;
  CornerMask corners;
};

/// A simplex of a tet, by its owner.
[[nodiscard]] inline OwnedSimplex ownedBy(const TetTopology& topology, Index tet,
                                          CornerMask simplex) {
  const Index owner = ownerTet(topology, tet, simplex);
  return {owner, owner == tet ? simplex : topology.translated(simplex, tet, owner)};
}

}  // namespace hexhex
