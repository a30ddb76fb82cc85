// Structures made of meshes: tets cut into four blocks each, and extracted hexahedra.
#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <vector>

#include <hexhex/extract.hpp>

#include <base/vector3.hpp>

#include "campaign/block_structure.hpp"

namespace hexhex::campaign {

namespace {

using samples::BlockCorners;
using samples::BlockModel;

/// The four blocks of each tet; a vertex for every set of corners, in their middle.
BlockModel cutAtMidpoints(const TetMesh& mesh) {
  // The block's corner and the ends of its three edges: even permutations, so right-handed.
  constexpr std::array<std::array<std::size_t, 4>, 4> kFrames = {
      {{0, 1, 2, 3}, {1, 0, 3, 2}, {2, 3, 0, 1}, {3, 2, 1, 0}}};
  BlockModel model;
  std::map<std::vector<Index>, Index> numbers;
  for (const Tet& tet : mesh.tets) {
    for (const std::array<std::size_t, 4>& frame : kFrames) {
      BlockCorners& block = model.blocks.emplace_back();
      std::array<Vec3, 8>& shape = model.shapes.emplace_back();
      for (std::size_t c = 0; c < 8; ++c) {
        std::vector<Index> corners = {tet[frame[0]]};
        for (std::size_t a = 0; a < 3; ++a) {
          if ((c >> a & 1) == 1) corners.push_back(tet[frame[a + 1]]);
        }
        std::sort(corners.begin(), corners.end());
        block[c] = numbers.try_emplace(corners, static_cast<Index>(numbers.size())).first->second;
        for (const Index corner : corners) shape[c] = plus(shape[c], mesh.points[corner]);
        for (double& coordinate : shape[c]) coordinate /= static_cast<double>(corners.size());
      }
    }
  }
  return model;
}

/// Cuts one of the tets into four around a new vertex.
void cutTet(TetMesh& mesh, Random& random) {
  const std::size_t chosen = random.below(mesh.tets.size());
  const Tet tet = mesh.tets[chosen];
  Vec3 mean{};
  for (const Index corner : tet) mean = plus(mean, mesh.points[corner]);
  for (double& coordinate : mean) coordinate /= 4;
  const auto vertex = static_cast<Index>(mesh.points.size());
  mesh.points.push_back(mean);
  for (std::size_t c = 0; c < 4; ++c) {
    Tet part = tet;
    part[c] = vertex;
    if (c == 0) {
      mesh.tets[chosen] = part;
    } else {
      mesh.tets.push_back(part);
    }
  }
}

/// Puts a tet upon one of those faces that belong to one tet only.
void addTet(TetMesh& mesh, Random& random) {
  std::map<std::array<Index, 3>, std::vector<Tet>> tetsAt;
  // Corners such that replacing the first one by its mirror image gives a tet on the other side.
  for (const Tet& tet : mesh.tets) {
    for (std::size_t c = 0; c < 4; ++c) {
      std::array<Index, 3> face = {tet[(c + 1) % 4], tet[(c + 2) % 4], tet[(c + 3) % 4]};
      // (c, c+1, c+2, c+3) is an odd permutation for odd c.
      if (c % 2 == 1) std::swap(face[0], face[1]);
      const Tet turned = {tet[c], face[0], face[1], face[2]};
      std::sort(face.begin(), face.end());
      tetsAt[face].push_back(turned);
    }
  }
  std::vector<Tet> free;
  for (const auto& [face, tets] : tetsAt) {
    if (tets.size() == 1) free.push_back(tets[0]);
  }
  const Tet below = free[random.below(free.size())];
  Vec3 sum{};
  for (std::size_t c = 1; c < 4; ++c) sum = plus(sum, mesh.points[below[c]]);
  Vec3 apex{};
  for (std::size_t a = 0; a < 3; ++a) apex[a] = 2 * sum[a] / 3 - mesh.points[below[0]][a];
  mesh.tets.push_back({static_cast<Index>(mesh.points.size()), below[2], below[1], below[3]});
  mesh.points.push_back(apex);
}

TetMesh drawTets(Random& random) {
  if (random.below(6) == 0) {
    const Sample sample = generateSample(SampleKind::Star, {.cells = 1, .refine = 1, .valence = 3});
    return {sample.map.points, sample.map.tets};
  }
  TetMesh mesh{{{-1, -1, -1}, {1, 1, -1}, {-1, 1, 1}, {1, -1, 1}}, {{0, 1, 2, 3}}};
  const std::size_t changes = random.below(oftenOr(4, 8, random));
  for (std::size_t i = 0; i < changes; ++i) {
    if (random.below(2) == 0) {
      cutTet(mesh, random);
    } else {
      addTet(mesh, random);
    }
  }
  return mesh;
}

}  // namespace

BlockStructure drawCutTets(Random& random) {
  return {"cut tets", cutAtMidpoints(drawTets(random))};
}

BlockStructure drawHexMesh(Random& random) {
  const auto kinds = sampleKinds();
  SampleOptions options;
  options.cells = static_cast<int>(oftenOr(1, 2, random));
  options.refine = 1;
  options.valence = static_cast<int>(3 + random.below(4));
  const Sample sample = generateSample(kinds[random.below(kinds.size())].kind, options);
  const HexMesh mesh = extract(sample.map);
  BlockStructure structure{"extracted mesh", {}};
  for (const Hex& cell : mesh.cells) {
    BlockCorners& block = structure.model.blocks.emplace_back();
    std::array<Vec3, 8>& shape = structure.model.shapes.emplace_back();
    for (std::size_t c = 0; c < 8; ++c) {
      // A cell lists its corners around its bottom and its top.
      block[c] = cell[c ^ (c >> 1 & 1)];
      shape[c] = mesh.points[block[c]];
    }
  }
  return structure;
}

}  // namespace hexhex::campaign
