// Do parts make up the mesh in one piece, and know their neighbours? Compared with what follows
// from the whole mesh by definition.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <hexhex/extract.hpp>
#include <hexhex/parts.hpp>

namespace hexhex::test {

/// Compares all parts of a mesh with it.
class PartCheck {
 public:
  PartCheck(const HexMesh& whole, const std::vector<MeshPart>& parts, const PartOptions& options)
      : whole_(whole), parts_(parts), options_(options) {}

  /// The first thing that is wrong, or nothing.
  [[nodiscard]] std::string firstFault() {
    if (parts_.size() != options_.parts) return "number of parts";
    findOwners();
    if (!fault_.empty()) return fault_;
    for (const MeshPart& part : parts_) {
      checkOwn(part);
      if (fault_.empty()) checkGhosts(part);
      if (fault_.empty()) checkNeighbours(part);
      if (fault_.empty()) checkTags(part);
      if (!fault_.empty()) return "part " + std::to_string(part.part) + ": " + fault_;
    }
    return checkFacePairs();
  }

 private:
  void require(bool isRight, const char* what) {
    if (!isRight && fault_.empty()) fault_ = what;
  }

  /// Every cell is in one part.
  void findOwners() {
    partOfCell_.assign(whole_.cells.size(), kNone);
    for (std::uint32_t p = 0; p < parts_.size(); ++p) {
      const MeshPart& part = parts_[p];
      require(part.part == p && part.parts == parts_.size(), "its number");
      for (std::size_t c = 0; c < part.ownCells && fault_.empty(); ++c) {
        const std::uint64_t number = part.globalCells[c];
        require(number < whole_.cells.size() && partOfCell_[number] == kNone, "a cell twice");
        if (fault_.empty()) partOfCell_[number] = p;
      }
    }
    require(std::find(partOfCell_.begin(), partOfCell_.end(), kNone) == partOfCell_.end(),
            "a cell in no part");
    cellsAt_.resize(whole_.points.size());
    for (Index c = 0; c < whole_.cells.size(); ++c) {
      for (const Index v : whole_.cells[c]) cellsAt_[v].insert(c);
    }
  }

  void checkOwn(const MeshPart& part) {
    require(part.globalCells.size() == part.mesh.cells.size(), "cell numbers");
    require(part.globalPoints.size() == part.mesh.points.size(), "point numbers");
    require(part.pointOwners.size() == part.mesh.points.size(), "owners");
    if (!fault_.empty()) return;
    const auto ascending = [](const auto& list, std::uint64_t begin, std::uint64_t end) {
      return std::adjacent_find(list.begin() + static_cast<std::ptrdiff_t>(begin),
                                list.begin() + static_cast<std::ptrdiff_t>(end),
                                [](auto a, auto b) { return a >= b; }) ==
             list.begin() + static_cast<std::ptrdiff_t>(end);
    };
    require(ascending(part.globalCells, 0, part.ownCells), "order of cells");
    require(ascending(part.globalPoints, 0, part.ownPoints), "order of points");
    require(ascending(part.globalPoints, part.ownPoints, part.globalPoints.size()),
            "order of ghosts' points");
    std::set<std::uint64_t> used;
    for (std::size_t c = 0; c < part.mesh.cells.size(); ++c) {
      for (std::size_t k = 0; k < 8; ++k) {
        const Index v = part.mesh.cells[c][k];
        require(v < part.mesh.points.size(), "a corner");
        if (!fault_.empty()) return;
        require(part.globalPoints[v] == whole_.cells[part.globalCells[c]][k], "a cell's corners");
        if (c < part.ownCells) used.insert(part.globalPoints[v]);
      }
    }
    require(std::equal(used.begin(), used.end(), part.globalPoints.begin(),
                       part.globalPoints.begin() + static_cast<std::ptrdiff_t>(part.ownPoints)),
            "own points");
    for (std::size_t v = 0; v < part.mesh.points.size(); ++v) {
      const std::uint64_t number = part.globalPoints[v];
      // Bits, not values.
      require(std::memcmp(&part.mesh.points[v], &whole_.points[number], sizeof(Vec3)) == 0,
              "a position");
      require(part.mesh.generatorTet[v] == whole_.generatorTet[number], "a generator's tet");
      require(part.mesh.generatorCorners[v] == whole_.generatorCorners[number], "a generator");
      std::uint32_t owner = kNone;
      for (const Index c : cellsAt_[number]) owner = std::min(owner, partOfCell_[c]);
      require(part.pointOwners[v] == owner, "an owner");
    }
  }

  void checkGhosts(const MeshPart& part) {
    std::set<std::uint64_t> inside(
        part.globalCells.begin(),
        part.globalCells.begin() + static_cast<std::ptrdiff_t>(part.ownCells));
    std::vector<std::uint64_t> cells;
    std::vector<std::uint32_t> layers;
    for (std::uint32_t layer = 1; layer <= options_.ghostLayers; ++layer) {
      std::set<std::uint64_t> next;
      for (const std::uint64_t cell : inside) {
        for (const Index v : whole_.cells[cell]) {
          for (const Index c : cellsAt_[v]) {
            if (!inside.contains(c)) next.insert(c);
          }
        }
      }
      cells.insert(cells.end(), next.begin(), next.end());
      layers.insert(layers.end(), next.size(), layer);
      inside.insert(next.begin(), next.end());
    }
    require(std::equal(cells.begin(), cells.end(),
                       part.globalCells.begin() + static_cast<std::ptrdiff_t>(part.ownCells),
                       part.globalCells.end()),
            "ghosts");
    require(
        std::equal(layers.begin(), layers.end(), part.ghostLayers.begin(), part.ghostLayers.end()),
        "layers of ghosts");
    require(part.ghostParts.size() == cells.size(), "parts of ghosts");
    for (std::size_t i = 0; i < cells.size() && fault_.empty(); ++i) {
      require(part.ghostParts[i] == partOfCell_[cells[i]], "the part of a ghost");
    }
  }

  void checkNeighbours(const MeshPart& part) {
    std::map<std::uint32_t, std::vector<Index>> shared;
    for (Index v = 0; v < part.ownPoints; ++v) {
      std::set<std::uint32_t> parts;
      for (const Index c : cellsAt_[part.globalPoints[v]]) parts.insert(partOfCell_[c]);
      parts.erase(part.part);
      for (const std::uint32_t other : parts) shared[other].push_back(v);
    }
    require(shared.size() == part.neighbours.size(), "number of neighbours");
    auto expected = shared.begin();
    for (const PartNeighbour& neighbour : part.neighbours) {
      if (!fault_.empty()) return;
      require(neighbour.part == expected->first, "a neighbour");
      require(std::equal(neighbour.vertices.begin(), neighbour.vertices.end(),
                         expected->second.begin(), expected->second.end()),
              "vertices shared with a neighbour");
      ++expected;
    }
  }

  void checkTags(const MeshPart& part) {
    if (!whole_.regions.empty()) {
      require(part.mesh.regions.size() == part.mesh.cells.size(), "regions");
      for (std::size_t c = 0; c < part.mesh.regions.size() && fault_.empty(); ++c) {
        require(part.mesh.regions[c] == whole_.regions[part.globalCells[c]], "a region");
      }
    }
    checkFeatures(part);
  }

  /// Those of the whole that a cell of the part has.
  void checkFeatures(const MeshPart& part) {
    const auto global = [&part](auto vertices) {
      std::array<std::uint64_t, std::tuple_size_v<decltype(vertices)>> numbers{};
      for (std::size_t i = 0; i < vertices.size(); ++i) numbers[i] = part.globalPoints[vertices[i]];
      return numbers;
    };
    const auto has = [&](const auto& vertices) {
      for (const Index c : cellsAt_[vertices[0]]) {
        if (partOfCell_[c] != part.part) continue;
        if (std::all_of(vertices.begin(), vertices.end(),
                        [&](Index v) { return cellsAt_[v].contains(c); })) {
          return true;
        }
      }
      return false;
    };
    const auto compare = [&](const auto& wholes, const auto& parts, const char* what) {
      std::size_t next = 0;
      for (const auto& feature : wholes) {
        if (!has(feature.vertices)) continue;
        require(next < parts.size(), what);
        if (!fault_.empty()) return;
        const auto numbers = global(parts[next].vertices);
        require(std::equal(numbers.begin(), numbers.end(), feature.vertices.begin()) &&
                    parts[next].tag == feature.tag,
                what);
        ++next;
      }
      require(next == parts.size(), what);
    };
    compare(whole_.features.edges, part.mesh.features.edges, "tagged edges");
    compare(whole_.features.quads, part.mesh.features.quads, "tagged quads");
    std::size_t vertices = 0;
    for (const FeatureVertex& feature : whole_.features.vertices) {
      const auto end = part.globalPoints.begin() + static_cast<std::ptrdiff_t>(part.ownPoints);
      if (std::binary_search(part.globalPoints.begin(), end, feature.vertex)) ++vertices;
    }
    require(vertices == part.mesh.features.vertices.size(), "tagged vertices");
  }

  static std::array<std::uint64_t, 4> quadOf(const MeshPart& part, const PartFace& face) {
    constexpr std::array<std::array<std::size_t, 4>, 6> kFaces = {
        {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}}};
    std::array<std::uint64_t, 4> quad{};
    for (std::size_t i = 0; i < 4; ++i) {
      quad[i] = part.globalPoints[part.mesh.cells[face.cell][kFaces[face.side][i]]];
    }
    std::sort(quad.begin(), quad.end());
    return quad;
  }

  /// Faces of two neighbours correspond one by one, and all that are inside the mesh are there.
  std::string checkFacePairs() {
    std::uint64_t pairs = 0;
    for (const MeshPart& part : parts_) {
      for (const PartNeighbour& neighbour : part.neighbours) {
        const MeshPart& other = parts_[neighbour.part];
        const auto back = std::find_if(other.neighbours.begin(), other.neighbours.end(),
                                       [&](const PartNeighbour& n) { return n.part == part.part; });
        if (back == other.neighbours.end()) return "a neighbour on one side only";
        if (back->faces.size() != neighbour.faces.size()) return "numbers of faces";
        for (std::size_t i = 0; i < neighbour.faces.size(); ++i) {
          if (quadOf(part, neighbour.faces[i]) != quadOf(other, back->faces[i])) {
            return "faces of neighbours";
          }
        }
        pairs += neighbour.faces.size();
      }
    }
    return pairs == facesBetweenParts() ? "" : "number of faces between parts";
  }
  /// Counted from both sides; where more than two cells have the same four vertices, not at all.
  [[nodiscard]] std::uint64_t facesBetweenParts() const {
    constexpr std::array<std::array<std::size_t, 4>, 6> kFaces = {
        {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}}};
    std::map<std::array<Index, 4>, std::vector<std::uint32_t>> partsAt;
    for (std::size_t c = 0; c < whole_.cells.size(); ++c) {
      for (const auto& face : kFaces) {
        std::array<Index, 4> quad{};
        for (std::size_t i = 0; i < 4; ++i) quad[i] = whole_.cells[c][face[i]];
        std::sort(quad.begin(), quad.end());
        partsAt[quad].push_back(partOfCell_[c]);
      }
    }
    std::uint64_t count = 0;
    for (const auto& [quad, parts] : partsAt) {
      if (parts.size() > 2) return totalOfNeighbours();
      if (parts.size() == 2 && parts[0] != parts[1]) count += 2;
    }
    return count;
  }
  [[nodiscard]] std::uint64_t totalOfNeighbours() const {
    std::uint64_t count = 0;
    for (const MeshPart& part : parts_) {
      for (const PartNeighbour& neighbour : part.neighbours) count += neighbour.faces.size();
    }
    return count;
  }

  const HexMesh& whole_;
  const std::vector<MeshPart>& parts_;
  const PartOptions& options_;
  std::vector<std::uint32_t> partOfCell_;
  std::vector<std::set<Index>> cellsAt_;
  std::string fault_;
};

/// Extracts a map as a whole and in parts, and says what differs.
inline std::string comparePartsWithWhole(const TetMap& map, const ExtractOptions& options,
                                         const PartOptions& parts, int threads = 0) {
  Context context(threads);
  const HexMesh whole = extract(map, options, context);
  const std::vector<MeshPart> all = extractParts(map, options, parts, context);
  return PartCheck(whole, all, parts).firstFault();
}

}  // namespace hexhex::test
