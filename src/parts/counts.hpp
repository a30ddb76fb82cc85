// How many vertices and cells each tet owns, which names all of them: the only thing that the parts
// of a mesh need to know of each other.
#pragma once

#include <hexhex/types.hpp>

#include <igm/prepare.hpp>
#include <sweep/vertex_numbers.hpp>

namespace hexhex {

struct ElementCounts {
  VertexNumbers vertices;
  Array<std::uint64_t> cells;  ///< per tet (+1): the first cell that it owns
};

/// Sweeps all tets, and keeps nothing but counts.
/// @throws Error Internal if there are not as many cells as the map's parametric volume
[[nodiscard]] ElementCounts countElements(const PreparedMap& map, std::uint64_t expectedCells,
                                          Stage& stage);

}  // namespace hexhex
