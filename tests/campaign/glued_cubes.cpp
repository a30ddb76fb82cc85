// Structures of cubes: beside each other in space, glued at random, or without a boundary.
#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include <hexhex/error.hpp>

#include <base/disjoint_sets.hpp>

#include "campaign/block_structure.hpp"

namespace hexhex::campaign {

namespace {

using samples::BlockComplex;
using samples::BlockCorners;
using samples::BlockModel;
using samples::BlockPart;

/// Per face (axis, side) of a cube its corners, counter-clockwise from outside.
constexpr std::array<std::array<std::size_t, 4>, 6> kFaces = {
    {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};

lattice::GridPoint cornerOf(const lattice::GridPoint& cube, std::size_t corner) {
  lattice::GridPoint point = cube;
  for (std::size_t a = 0; a < 3; ++a) point[a] += static_cast<std::int32_t>(corner >> a & 1);
  return point;
}

/// Blocks on the integer grid that share the vertices with the same number.
template <class NumberOf>
BlockModel cubesOnGrid(const std::set<lattice::GridPoint>& cubes, const NumberOf& numberOf) {
  BlockModel model;
  for (const lattice::GridPoint& cube : cubes) {
    BlockCorners& block = model.blocks.emplace_back();
    std::array<Vec3, 8>& shape = model.shapes.emplace_back();
    for (std::size_t c = 0; c < 8; ++c) {
      const lattice::GridPoint corner = cornerOf(cube, c);
      block[c] = numberOf(corner);
      for (std::size_t a = 0; a < 3; ++a) shape[c][a] = corner[a];
    }
  }
  return model;
}

/// Gives every vertex a random place.
void scatter(BlockModel& model, Random& random) {
  std::vector<Vec3> places;
  model.shapes.resize(model.blocks.size());
  for (std::size_t block = 0; block < model.blocks.size(); ++block) {
    for (std::size_t c = 0; c < 8; ++c) {
      while (places.size() <= model.blocks[block][c]) {
        places.push_back({random.share(), random.share(), random.share()});
      }
      model.shapes[block][c] = places[model.blocks[block][c]];
    }
  }
}

/// A face of a block.
struct Side {
  std::size_t block = 0;
  std::size_t face = 0;
};

/// Cubes whose vertices are identified step by step.
class Gluer {
 public:
  Gluer(std::size_t cubes, Random& random) : sets_(8 * cubes), random_(random) {
    grow(1);
    while (blocks_.size() < cubes) {
      grow(blocks_.size() + 1);
      const std::vector<Side> free = freeSides();
      const std::size_t newest = blocks_.size() - 1;
      Side old = free[random_.below(free.size())];
      while (old.block == newest) old = free[random_.below(free.size())];
      glue(old, {newest, random_.below(6)});
    }
  }

  /// Glues two free faces, of those that share an edge if there are any, or of all.
  void glueAnyTwo(bool beside) {
    const std::vector<Side> free = freeSides();
    std::vector<std::pair<Side, Side>> pairs;
    for (const Side& a : free) {
      for (const Side& b : free) {
        if (a.block < b.block && (!beside || sharedVertices(a, b) >= 2)) pairs.emplace_back(a, b);
      }
    }
    if (pairs.empty()) return;
    const auto& [a, b] = pairs[random_.below(pairs.size())];
    glue(a, b);
  }

  [[nodiscard]] BlockModel model() const { return {blocks_, {}, nullptr}; }

 private:
  void grow(std::size_t count) {
    for (std::size_t i = blocks_.size(); i < count; ++i) {
      BlockCorners& block = blocks_.emplace_back();
      for (std::size_t c = 0; c < 8; ++c) block[c] = static_cast<Index>(8 * i + c);
    }
  }

  [[nodiscard]] std::vector<Side> freeSides() const {
    const BlockComplex complex(blocks_);
    std::vector<Side> sides;
    for (std::size_t block = 0; block < blocks_.size(); ++block) {
      for (std::size_t face = 0; face < 6; ++face) {
        if (!complex.neighbour(block, face / 2, static_cast<int>(face % 2))) {
          sides.push_back({block, face});
        }
      }
    }
    return sides;
  }

  [[nodiscard]] Index vertexAt(const Side& side, std::size_t corner) const {
    return blocks_[side.block][kFaces[side.face][corner % 4]];
  }

  [[nodiscard]] int sharedVertices(const Side& a, const Side& b) const {
    int shared = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < 4; ++j) shared += vertexAt(a, i) == vertexAt(b, j) ? 1 : 0;
    }
    return shared;
  }

  /// In the first of the four ways, from a random one on, that leaves a manifold; or not at all.
  void glue(const Side& a, const Side& b) {
    const std::size_t first = random_.below(4);
    for (std::size_t turn = 0; turn < 4; ++turn) {
      DisjointSets sets = sets_;
      // Faces meet with opposite directions.
      for (std::size_t i = 0; i < 4; ++i) {
        sets.unite(vertexAt(a, i), vertexAt(b, 4 + first + turn - i));
      }
      std::vector<BlockCorners> blocks = blocks_;
      for (BlockCorners& block : blocks) {
        for (Index& vertex : block) vertex = sets.find(vertex);
      }
      if (!isValid(blocks)) continue;
      blocks_ = std::move(blocks);
      sets_ = std::move(sets);
      return;
    }
  }

  [[nodiscard]] static bool isValid(const std::vector<BlockCorners>& blocks) {
    std::map<std::set<Index>, int> blocksAtFace;
    for (const BlockCorners& block : blocks) {
      if (std::set<Index>(block.begin(), block.end()).size() < 8) return false;
      for (const std::array<std::size_t, 4>& face : kFaces) {
        std::set<Index> corners;
        for (const std::size_t c : face) corners.insert(block[c]);
        if (++blocksAtFace[corners] > 2) return false;
      }
    }
    try {
      return isManifold(BlockComplex(blocks));
    } catch (const Error&) {
      return false;  // of opposite orientation where faces have the same vertices by chance
    }
  }

  DisjointSets sets_;
  std::vector<BlockCorners> blocks_;
  Random& random_;
};

}  // namespace

BlockStructure drawPolycube(Random& random) {
  std::set<lattice::GridPoint> cubes = {{0, 0, 0}};
  const std::size_t count = 1 + random.below(random.below(10) == 0 ? 40 : 12);
  while (cubes.size() < count) {
    auto cube = cubes.begin();
    std::advance(cube, static_cast<std::ptrdiff_t>(random.below(cubes.size())));
    cubes.insert(
        lattice::step(*cube, static_cast<lattice::Direction>(random.below(lattice::kDirections))));
  }
  return {"polycube", cubesOnGrid(cubes, [](const lattice::GridPoint& corner) {
            constexpr int kMiddle = 64;
            return static_cast<Index>(corner[0] + kMiddle + 2 * kMiddle * (corner[1] + kMiddle) +
                                      4 * kMiddle * kMiddle * (corner[2] + kMiddle));
          })};
}

BlockStructure drawGluedCubes(Random& random) {
  const std::uint64_t most = oftenOr(5, 12, random);
  Gluer gluer(1 + random.below(most), random);
  const std::size_t gluings = random.below(most + 4);
  for (std::size_t i = 0; i < gluings; ++i) gluer.glueAnyTwo(random.below(3) > 0);
  BlockStructure structure{"glued cubes", gluer.model()};
  scatter(structure.model, random);
  return structure;
}

BlockStructure drawClosedManifold(Random& random) {
  if (random.below(2) == 0) {
    lattice::GridPoint size{};
    for (std::int32_t& length : size)
      length = static_cast<std::int32_t>(3 + random.below(oftenOr(1, 3, random)));
    std::set<lattice::GridPoint> cubes;
    for (lattice::GridPoint cube{}; cube[2] < size[2]; ++cube[2]) {
      for (cube[1] = 0; cube[1] < size[1]; ++cube[1]) {
        for (cube[0] = 0; cube[0] < size[0]; ++cube[0]) cubes.insert(cube);
      }
    }
    return {"torus of three dimensions", cubesOnGrid(cubes, [&](const lattice::GridPoint& corner) {
              return static_cast<Index>(
                  corner[0] % size[0] +
                  size[0] * (corner[1] % size[1] + size[1] * (corner[2] % size[2])));
            })};
  }
  BlockStructure structure{"surface of a cube of four dimensions", {}};
  for (std::size_t axis = 0; axis < 4; ++axis) {
    for (std::size_t side = 0; side < 2; ++side) {
      BlockCorners& block = structure.model.blocks.emplace_back();
      for (std::size_t c = 0; c < 8; ++c) {
        std::size_t vertex = side << axis;
        for (std::size_t a = 0; a < 3; ++a) {
          // Two axes change places where the orientation of the surface asks for it.
          const std::size_t own = (axis + side) % 2 == 1 && a < 2 ? 1 - a : a;
          vertex |= (c >> own & 1) << (a < axis ? a : a + 1);
        }
        block[c] = static_cast<Index>(vertex);
      }
    }
  }
  scatter(structure.model, random);
  return structure;
}

}  // namespace hexhex::campaign
