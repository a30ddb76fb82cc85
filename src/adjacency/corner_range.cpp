#include <algorithm>
#include <string>

#include <adjacency/corner_range.hpp>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>

namespace hexhex::adjacency {

std::size_t firstCellOutOfRange(const HexMesh& mesh, Stage& stage) {
  const auto vertices = static_cast<Index>(std::min<std::size_t>(mesh.points.size(), kNone));
  return firstFault(stage, mesh.cells.size(), [&](std::size_t c) {
    unsigned outside = 0;
    for (const Index corner : mesh.cells[c]) outside |= corner >= vertices ? 1U : 0U;
    return outside == 0;
  });
}

void requireCornersInRange(const HexMesh& mesh, Stage& stage) {
  const std::size_t bad = firstCellOutOfRange(mesh, stage);
  if (bad == mesh.cells.size()) return;
  throw Error(ErrorCode::InvalidArgument,
              "Cell " + std::to_string(bad) +
                  " of the hexahedral mesh names a vertex that does not exist (the mesh has " +
                  std::to_string(mesh.points.size()) + " vertices). Correct the cell.",
              Place{PlaceKind::Cell, bad, 0});
}

void requireCornersInRange(const TetMapView& map, Stage& stage) {
  const std::size_t bad = firstFault(stage, map.tets.size(), [&](std::size_t t) {
    return std::all_of(map.tets[t].begin(), map.tets[t].end(),
                       [&](Index v) { return v < map.points.size(); });
  });
  if (bad == map.tets.size()) return;
  throw Error(ErrorCode::IndexOutOfRange,
              "Tet " + std::to_string(bad) + " names a vertex that does not exist.",
              Place{PlaceKind::Tet, bad});
}

}  // namespace hexhex::adjacency
