// Sheets, chords and blocks from faces, and singular curves from singular edges.
#include <algorithm>
#include <bit>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include <adjacency/cell_faces.hpp>
#include <adjacency/hex_topology.hpp>

#include <hexhex/base_complex.hpp>
#include <hexhex/error.hpp>

#include <base/disjoint_sets.hpp>
#include <base/numbered_sets.hpp>
#include <base/parallel.hpp>
#include <mesh/cell_measures.hpp>
#include <mesh/singular_graph.hpp>

namespace hexhex::mesh {
namespace {

using adjacency::kHexEdges;
using adjacency::kHexFaces;

/// Position of a cell's corner in the unit cube: bit i is its coordinate along axis i. The table is
/// its own inverse.
constexpr std::size_t placesOf(std::size_t corner) { return kVtkCorner[corner]; }

/// The axis along which a cell has the edge between two of its vertices.
std::size_t axisBetween(const Hex& cell, Index a, Index b) {
  std::size_t between = 0;
  for (std::size_t k = 0; k < 8; ++k) {
    if (cell[k] == a || cell[k] == b) between ^= placesOf(k);
  }
  return static_cast<std::size_t>(std::countr_zero(between));
}

/// The face of a cell, other than `face`, that contains the edge of `face` between two vertices.
std::size_t faceAcross(const Hex& cell, std::size_t face, Index a, Index b) {
  const std::size_t edgeAxis = axisBetween(cell, a, b);
  const std::size_t axis = 3 - edgeAxis - face / 2;  // the third axis
  const auto corner =
      static_cast<std::size_t>(std::find(cell.begin(), cell.end(), a) - cell.begin());
  return 2 * axis + (placesOf(corner) >> axis & 1U);
}

/// What is known about a mesh's faces, by half-face: 6 * cell + face.
class Walls {
 public:
  Walls(const HexMesh& mesh, std::span<const Index> mates,
        std::span<const SingularHexEdge> singular)
      : mesh_(mesh),
        mates_(mates),
        singular_(singular),
        onSingular_(mesh.points.size(), 0),
        isWall_(mates.size(), 0) {
    for (const SingularHexEdge& edge : singular) {
      onSingular_[edge.vertex0] = onSingular_[edge.vertex1] = 1;
    }
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) startAt(c);
    while (!front_.empty()) {
      const Index halfFace = front_.back();
      front_.pop_back();
      goOn(halfFace);
    }
  }

  /// Whether a block ends there.
  [[nodiscard]] bool isEnd(std::size_t halfFace) const {
    return mates_[halfFace] == kNone || isWall_[halfFace] != 0;
  }

 private:
  [[nodiscard]] bool isSingular(Index a, Index b) const {
    if (onSingular_[a] == 0 || onSingular_[b] == 0) return false;
    const auto ends = adjacency::ascending(a, b);
    const auto endsOf = [](const SingularHexEdge& e) { return std::array{e.vertex0, e.vertex1}; };
    const auto found = std::lower_bound(
        singular_.begin(), singular_.end(), ends,
        [&](const SingularHexEdge& e, const auto& wanted) { return endsOf(e) < wanted; });
    return found != singular_.end() && endsOf(*found) == ends;
  }

  void add(std::size_t halfFace) {
    const Index mate = mates_[halfFace];
    if (mate == kNone || isWall_[halfFace] != 0) return;
    isWall_[halfFace] = isWall_[mate] = 1;
    front_.push_back(static_cast<Index>(halfFace));
  }

  /// Faces at singular edges are walls.
  void startAt(std::size_t c) {
    const Hex& cell = mesh_.cells[c];
    for (const auto& edge : kHexEdges) {
      const Index a = cell[edge[0]];
      const Index b = cell[edge[1]];
      if (!isSingular(a, b)) continue;
      const std::size_t axis = axisBetween(cell, a, b);
      for (const std::size_t other : {(axis + 1) % 3, (axis + 2) % 3}) {
        add(6 * c + 2 * other + (placesOf(edge[0]) >> other & 1U));
      }
    }
  }

  /// At a regular interior edge, the opposite face is two cells further on.
  void goOn(Index halfFace) {
    const std::size_t face = halfFace % 6;
    const Hex& cell = mesh_.cells[halfFace / 6];
    const Quad quad = adjacency::faceVertices(cell, face);
    for (std::size_t i = 0; i < 4; ++i) {
      const Index a = quad[i];
      const Index b = quad[(i + 1) % 4];
      if (isSingular(a, b)) continue;
      const Index next = mates_[halfFace - face + faceAcross(cell, face, a, b)];
      if (next == kNone) continue;
      const std::size_t nextFace = next % 6;
      add(next - nextFace + faceAcross(mesh_.cells[next / 6], nextFace, a, b));
    }
  }

  const HexMesh& mesh_;
  std::span<const Index> mates_;
  std::span<const SingularHexEdge> singular_;
  std::vector<std::uint8_t> onSingular_;  ///< per vertex
  std::vector<std::uint8_t> isWall_;      ///< per half-face
  std::vector<Index> front_;              ///< half-faces whose edges have not been visited
};

/// Classes of the three axes of all cells, indexed 3 * cell + axis; `unite` says which belong
/// together.
std::pair<Array<std::array<Index, 3>>, Index> axisSets(std::size_t cells, const auto& unite) {
  DisjointSets sets(3 * cells);
  unite(sets);
  const NumberedSets numbered = numberSets(sets, 3 * cells);
  std::pair<Array<std::array<Index, 3>>, Index> result(Array<std::array<Index, 3>>(cells),
                                                       numbered.count);
  for (std::size_t i = 0; i < 3 * cells; ++i) result.first[i / 3][i % 3] = numbered.setOf[i];
  return result;
}

/// Calls visit(cell, face, the other half-face) once for each interior face.
void forEachInnerFace(std::span<const Index> mates, const auto& visit) {
  for (std::size_t h = 0; h < mates.size(); ++h) {
    if (mates[h] != kNone && h < mates[h]) visit(h / 6, h % 6, mates[h]);
  }
}

void findSheetsAndChords(const HexMesh& mesh, std::span<const Index> mates, BaseComplex& result) {
  const auto node = [](std::size_t cell, std::size_t axis) {
    return static_cast<Index>(3 * cell + axis);
  };
  std::tie(result.cellSheets, result.sheets) = axisSets(mesh.cells.size(), [&](auto& sets) {
    forEachInnerFace(mates, [&](std::size_t c, std::size_t face, Index mate) {
      const Quad quad = adjacency::faceVertices(mesh.cells[c], face);
      for (const auto& [a, b] : {std::pair(quad[0], quad[1]), std::pair(quad[1], quad[2])}) {
        sets.unite(node(c, axisBetween(mesh.cells[c], a, b)),
                   node(mate / 6, axisBetween(mesh.cells[mate / 6], a, b)));
      }
    });
  });
  std::tie(result.cellChords, result.chords) = axisSets(mesh.cells.size(), [&](auto& sets) {
    forEachInnerFace(mates, [&](std::size_t c, std::size_t face, Index mate) {
      sets.unite(node(c, face / 2), node(mate / 6, mate % 6 / 2));
    });
  });
}

/// Number of cells in a row along an axis, from a cell to the end of its block.
std::uint64_t lengthAlong(std::size_t cell, std::size_t axis, std::span<const Index> mates,
                          const Walls& walls) {
  std::uint64_t length = 1;
  for (const std::size_t first : {6 * cell + 2 * axis, 6 * cell + 2 * axis + 1}) {
    for (std::size_t h = first; !walls.isEnd(h);) {
      const Index mate = mates[h];
      h = mate ^ 1U;                  // faces of one axis are 2 * axis and 2 * axis + 1
      if (h == first) return length;  // a ring
      ++length;
    }
  }
  return length;
}

void findBlocks(std::size_t cells, std::span<const Index> mates, const Walls& walls,
                BaseComplex& result) {
  DisjointSets sets(cells);
  forEachInnerFace(mates, [&](std::size_t c, std::size_t face, Index mate) {
    if (!walls.isEnd(6 * c + face)) sets.unite(static_cast<Index>(c), mate / 6);
  });
  NumberedSets numbered = numberSets(sets, cells);
  result.blocks.resize(numbered.count);
  for (std::size_t c = 0; c < cells; ++c) {
    MeshBlock& block = result.blocks[numbered.setOf[c]];
    if (block.cells++ > 0) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      block.size[axis] = lengthAlong(c, axis, mates, walls);
    }
  }
  for (MeshBlock& block : result.blocks) {
    if (block.size[0] * block.size[1] * block.size[2] != block.cells) block.size = {};
  }
  result.cellBlocks = std::move(numbered.setOf);
}

/// The mates of all half-faces.
adjacency::HexMates matesOf(const HexMesh& mesh, Stage& stage) {
  constexpr std::size_t kMost = kNone / 6;  // limit of matchHexFaces()
  if (mesh.cells.size() >= kMost) {
    throw Error(ErrorCode::TooLarge, "The mesh has " + std::to_string(mesh.cells.size()) +
                                         " cells; a base complex is found for fewer than " +
                                         std::to_string(kMost) + ".");
  }
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    if (!adjacency::namesAVertexTwice(mesh.cells[c])) continue;
    throw Error(ErrorCode::InvalidArgument,
                "Cell " + std::to_string(c) + " names a vertex twice, so it has no three axes.",
                Place{PlaceKind::Cell, c});
  }
  std::optional<adjacency::HexMates> mates =
      adjacency::matchHexFaces(mesh.points.size(), mesh.cells, stage);
  if (mates) return std::move(*mates);
  throw Error(ErrorCode::InvalidArgument,
              "A face belongs to more than two cells, or two cells pass it in the same direction: "
              "`hexhex info` says which, and `hexhex convert --reorient` turns mirrored cells.");
}

}  // namespace
}  // namespace hexhex::mesh

namespace hexhex {

BaseComplex findBaseComplex(const HexMesh& mesh, Context& context) {
  return inStage(context, "findBaseComplex", "base complex", [&](Stage& stage) {
    BaseComplex result;
    withThreads(context.threads(), [&] {
      const adjacency::VertexCells around = adjacency::cellsAroundVertices(mesh, stage);
      const adjacency::HexFaces faces = adjacency::findFaces(mesh, around, stage);
      const adjacency::HexEdges edges = adjacency::findEdges(mesh, around, faces, stage);
      const adjacency::HexMates mates = mesh::matesOf(mesh, stage);
      const mesh::Walls walls(mesh, mates.mates, edges.singular);
      mesh::findSheetsAndChords(mesh, mates.mates, result);
      mesh::findBlocks(mesh.cells.size(), mates.mates, walls, result);
      mesh::findSingularGraph(mesh, mates.mates, edges.singular, stage, result);
    });
    return result;
  });
}

}  // namespace hexhex
