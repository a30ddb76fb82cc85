#include <algorithm>
#include <array>
#include <bit>

#include <io/ovm/ovm_output.hpp>
#include <io/ovm/simplex_indices.hpp>

namespace hexhex {

SimplexIndices::SimplexIndices(std::span<const Vec3> points, std::span<const Tet> tets,
                               Stage& stage)
    : tets_(tets),
      topology_(ovmTopologyOf(points, tets, stage)),
      edges_(topology_.vertexCount, topology_.edges),
      loops_(topology_, stage) {}

Index SimplexIndices::of(Index tet, CornerSet corners) const {
  const Tet& t = tets_[tet];
  const auto corner = [&](CornerSet set) {
    return t[static_cast<std::size_t>(std::countr_zero(set))];
  };
  switch (generatorKind(corners)) {
    case GeneratorKind::Vertex:
      return corner(corners);
    case GeneratorKind::Edge:
      return edges_.find(corner(corners), corner(static_cast<CornerSet>(corners & (corners - 1))));
    case GeneratorKind::Face:
      return faceWithout(tet, corner(static_cast<CornerSet>(15 & ~corners)));
    case GeneratorKind::Cell:
      break;
  }
  return tet;
}

Index SimplexIndices::faceWithout(Index tet, Index vertex) const {
  for (const Index halfFace : topology_.cells[tet]) {
    const std::array<Index, 3>& loop = loops_.ofFace(halfFace / 2);
    if (std::find(loop.begin(), loop.end(), vertex) == loop.end()) return halfFace / 2;
  }
  return kNone;
}

}  // namespace hexhex
