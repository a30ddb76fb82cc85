#include <algorithm>
#include <vector>

#include <base/parallel.hpp>
#include <io/parts/part_groups.hpp>

namespace hexhex::io {
namespace {

CellGroups groupOwnCells(const MeshPart& part, const PartsInfo& info) {
  if (info.regions.empty())
    return {{{1, "hexahedra", 0, static_cast<std::size_t>(part.ownCells)}}, {}};
  HexMesh own;  // regions alone
  own.cells.resize(part.ownCells);
  own.regions.assign(part.mesh.regions.begin(),
                     part.mesh.regions.begin() + static_cast<std::ptrdiff_t>(part.ownCells));
  CellGroups cells = groupCells(own);
  std::vector<std::int32_t> tags = info.regions;
  const bool hasZero = std::erase(tags, 0) > 0;
  if (part.ownCells == 0) cells.groups.clear();
  addMissingGroups(cells.groups, tags, hasZero, "region", "hexahedra");
  return cells;
}

}  // namespace

MeshGroups groupPart(const MeshPart& part, const PartsInfo& info, Stage& stage) {
  std::vector<std::uint64_t> between;
  for (const PartNeighbour& neighbour : part.neighbours) {
    for (const PartFace& face : neighbour.faces) {
      between.push_back(8 * std::uint64_t{face.cell} + face.side);
    }
  }
  std::sort(between.begin(), between.end());
  const auto isInside = [&](std::uint64_t place) {
    return place / 8 >= part.ownCells || std::binary_search(between.begin(), between.end(), place);
  };
  VertexGroups vertices = groupVertices(part.mesh);
  EdgeGroups edges = groupEdges(part.mesh);
  QuadGroups quads;
  withThreads(stage.context().threads(),
              [&] { quads = groupQuads(part.mesh, 0, stage, isInside); });
  addMissingGroups(vertices.groups, info.vertexTags, false, "point", "");
  addMissingGroups(edges.groups, info.edgeTags, false, "curve", "");
  addMissingGroups(quads.groups, info.quadTags, true, "surface", "boundary");
  return {std::move(vertices), std::move(edges), std::move(quads), groupOwnCells(part, info)};
}

}  // namespace hexhex::io
