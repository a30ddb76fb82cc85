// Faces are the same if they have the same four vertices, so that both cells list them at their
// smallest vertex: it suffices to sort the few faces there.
#include <algorithm>
#include <string>
#include <vector>

#include <adjacency/face_neighbours.hpp>
#include <adjacency/hex_topology.hpp>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>

namespace hexhex {
namespace {

constexpr std::size_t kGrain = 2048;

/// A face of a cell around its smallest vertex, by the three others in ascending order.
struct Side {
  std::array<Index, 3> others;
  Index cell;
  std::uint8_t face;
};

/// Collects the faces that have `vertex` as their smallest.
void collect(const HexMesh& mesh, const VertexCells& around, Index vertex,
             std::vector<Side>& sides) {
  sides.clear();
  Index previous = kNone;
  for (const Index cell : around.around(vertex)) {
    if (cell == previous) continue;  // a cell with repeated vertices
    previous = cell;
    for (std::uint8_t face = 0; face < 6; ++face) {
      Quad quad = faceVertices(mesh.cells[cell], face);
      std::sort(quad.begin(), quad.end());
      if (quad[0] == vertex) sides.push_back({{quad[1], quad[2], quad[3]}, cell, face});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    if (a.others != b.others) return a.others < b.others;
    return a.cell != b.cell ? a.cell < b.cell : a.face < b.face;
  });
}

}  // namespace

FaceNeighbours findFaceNeighbours(const HexMesh& mesh, Stage& stage) {
  const VertexCells around(mesh, stage);
  FaceNeighbours neighbours(mesh.cells.size());
  parallelBlocks(stage, mesh.points.size(), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t) {
                   std::vector<Side> sides;
                   for (std::size_t v = begin; v < end; ++v) {
                     collect(mesh, around, static_cast<Index>(v), sides);
                     for (std::size_t i = 0; i < sides.size();) {
                       std::size_t next = i + 1;
                       while (next < sides.size() && sides[next].others == sides[i].others) ++next;
                       const Side& a = sides[i];
                       const Side& b = sides[next - 1];
                       if (next - i > 2) {
                         throw Error(ErrorCode::InvalidArgument,
                                     "A face of cell " + std::to_string(a.cell) + " belongs to " +
                                         std::to_string(next - i) + " cells, but two are the most.",
                                     Place{PlaceKind::Cell, a.cell});
                       }
                       neighbours[a.cell][a.face] = next - i == 2 ? b.cell : kNone;
                       if (next - i == 2) neighbours[b.cell][b.face] = a.cell;
                       i = next;
                     }
                   }
                 });
  return neighbours;
}

}  // namespace hexhex
