// How many vertices and cells each tet owns, which numbers all of them: the only thing that the
// parts of a mesh need to know about each other.
#pragma once

#include <hexhex/team.hpp>
#include <hexhex/types.hpp>

#include <igm/igm.hpp>
#include <sweep/vertex_numbers.hpp>

namespace hexhex::sweep {

struct ElementCounts {
  VertexNumbers vertices;
  Array<std::uint64_t> cells;  ///< per tet (+1): the first cell that it owns
};

/// A half-open range of items.
struct ItemRange {
  std::size_t first;
  std::size_t end;
};
/// The items that a process of a team takes care of; all if there is no team.
[[nodiscard]] ItemRange shareOf(const ProcessTeam* team, std::size_t items);

/// Sweeps all tets, and keeps only counts.
/// @param team  if not null, its processes, which must all call this, share the work
/// @throws Error Internal if the number of cells is not the map's parametric volume
[[nodiscard]] ElementCounts countElements(const igm::PreparedMap& map, std::uint64_t expectedCells,
                                          ProcessTeam* team, Stage& stage);

}  // namespace hexhex::sweep
