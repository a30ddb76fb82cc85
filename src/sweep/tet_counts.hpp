// How many vertices and cells each tet owns, which names all of them: the only thing that the parts
// of a mesh need to know of each other.
#pragma once

#include <hexhex/team.hpp>
#include <hexhex/types.hpp>

#include <igm/prepare.hpp>
#include <sweep/vertex_numbers.hpp>

namespace hexhex::sweep {

struct ElementCounts {
  VertexNumbers vertices;
  Array<std::uint64_t> cells;  ///< per tet (+1): the first cell that it owns
};

/// From the first of many items to behind the last one.
struct ItemRange {
  std::size_t first;
  std::size_t end;
};
/// Those of which a process of a team takes care; all, if there is no team.
[[nodiscard]] ItemRange shareOf(const ProcessTeam* team, std::size_t items);

/// Sweeps all tets, and keeps nothing but counts.
/// @param team  if not null, its processes, which all call this, share the work
/// @throws Error Internal if there are not as many cells as the map's parametric volume
[[nodiscard]] ElementCounts countElements(const igm::PreparedMap& map, std::uint64_t expectedCells,
                                          ProcessTeam* team, Stage& stage);

}  // namespace hexhex::sweep
