// What a part has in common with its neighbours.
#pragma once

#include <cstdint>
#include <span>

#include <hexhex/parts.hpp>

namespace hexhex::parts {

/// A cell of another part with a vertex of this one.
struct BorderCell {
  std::uint64_t number;
  std::uint32_t part;
  Hex corners;  ///< local vertices, kNone where not of own cells
};

/// Fills part.neighbours.
/// @param part   with own cells and points
/// @param around  all cells of other parts with a vertex of its own cells, ascending by number
void findNeighbours(MeshPart& part, std::span<const BorderCell> around);

}  // namespace hexhex::parts
