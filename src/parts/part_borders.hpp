// What a part shares with its neighbours.
#pragma once

#include <cstdint>
#include <span>

#include <hexhex/parts.hpp>

namespace hexhex::parts {

/// A cell of another part with a vertex of this part.
struct BorderCell {
  std::uint64_t number;
  std::uint32_t part;
  Hex corners;  ///< local vertices; kNone for vertices of no own cell
};

/// Fills part.neighbours.
/// @param part   with own cells and points
/// @param around  all cells of other parts that share a vertex with own cells, ascending by number
void findNeighbours(MeshPart& part, std::span<const BorderCell> around);

}  // namespace hexhex::parts
