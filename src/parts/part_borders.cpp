#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include <adjacency/cell_faces.hpp>
#include <parts/part_borders.hpp>

namespace hexhex {

namespace {

/// A face of a cell, own or not, all of whose vertices are shared.
struct SharedSide {
  Quad sorted;           ///< its vertices
  std::uint64_t number;  ///< global, of its cell
  std::uint8_t side;
  Index cell;   ///< own, or kNone
  Index other;  ///< place in the list of other cells, or kNone
};

struct Pairing {
  std::uint32_t part;    ///< the neighbour
  std::uint64_t number;  ///< the face, as the smaller part has it: the same order in both
  std::uint8_t side;
  PartFace face;  ///< as this part has it
};

void addSides(const Hex& corners, std::uint64_t number, Index cell, Index other,
              const std::vector<bool>& isShared, std::vector<SharedSide>& sides) {
  for (std::uint8_t side = 0; side < 6; ++side) {
    Quad quad = faceVertices(corners, side);
    if (!std::all_of(quad.begin(), quad.end(),
                     [&](Index v) { return v != kNone && isShared[v]; })) {
      continue;
    }
    std::sort(quad.begin(), quad.end());
    sides.push_back({quad, number, side, cell, other});
  }
}

class FacePairs {
 public:
  FacePairs(const MeshPart& part, std::span<const BorderCell> around)
      : part_(part), around_(around) {}

  /// All faces between an own cell and another one. Usually two cells have the same four vertices;
  /// where more do, because cells meet themselves, both parts pair them in the same order.
  [[nodiscard]] std::vector<Pairing> find(std::vector<SharedSide>& sides) {
    std::sort(sides.begin(), sides.end(), [](const SharedSide& a, const SharedSide& b) {
      if (a.sorted != b.sorted) return a.sorted < b.sorted;
      return a.number != b.number ? a.number < b.number : a.side < b.side;
    });
    forEachRun(
        std::span<const SharedSide>(sides),
        [](const SharedSide& a, const SharedSide& b) { return a.sorted == b.sorted; },
        [&](std::span<const SharedSide> run) { pairUp(run); });
    return std::move(pairs_);
  }

 private:
  [[nodiscard]] Quad quadOf(const SharedSide& side) const {
    const Hex& corners =
        side.cell != kNone ? part_.mesh.cells[side.cell] : around_[side.other].corners;
    return faceVertices(corners, side.side);
  }
  void pairUp(std::span<const SharedSide> run) {
    std::vector<bool> taken(run.size(), false);
    for (std::size_t i = 0; i < run.size(); ++i) {
      for (std::size_t j = i + 1; j < run.size() && !taken[i]; ++j) {
        if (taken[j] || !areOpposite(quadOf(run[i]), quadOf(run[j]))) continue;
        taken[i] = taken[j] = true;
        add(run[i], run[j]);
      }
    }
  }
  void add(const SharedSide& a, const SharedSide& b) {
    if ((a.cell == kNone) == (b.cell == kNone)) return;
    const SharedSide& own = a.cell != kNone ? a : b;
    const SharedSide& other = a.cell != kNone ? b : a;
    const std::uint32_t neighbour = around_[other.other].part;
    const SharedSide& named = part_.part < neighbour ? own : other;
    pairs_.push_back({neighbour, named.number, named.side, {own.cell, own.side, other.number}});
  }

  const MeshPart& part_;
  std::span<const BorderCell> around_;
  std::vector<Pairing> pairs_;
};

}  // namespace

void findNeighbours(MeshPart& part, std::span<const BorderCell> around) {
  struct Shared {
    std::uint32_t part;
    Index vertex;
    auto operator<=>(const Shared&) const = default;
  };
  std::vector<Shared> shared;
  std::vector<bool> isShared(part.ownPoints, false);
  for (const BorderCell& cell : around) {
    for (const Index v : cell.corners) {
      if (v == kNone) continue;
      shared.push_back({cell.part, v});
      isShared[v] = true;
    }
  }
  std::sort(shared.begin(), shared.end());
  shared.erase(std::unique(shared.begin(), shared.end()), shared.end());
  for (const Shared& each : shared) {
    if (part.neighbours.empty() || part.neighbours.back().part != each.part) {
      part.neighbours.push_back({each.part, {}, {}});
    }
    part.neighbours.back().vertices.push_back(each.vertex);
  }

  std::vector<SharedSide> sides;
  for (std::size_t c = 0; c < part.ownCells; ++c) {
    addSides(part.mesh.cells[c], part.globalCells[c], static_cast<Index>(c), kNone, isShared,
             sides);
  }
  for (std::size_t i = 0; i < around.size(); ++i) {
    addSides(around[i].corners, around[i].number, kNone, static_cast<Index>(i), isShared, sides);
  }
  std::vector<Pairing> pairs = FacePairs(part, around).find(sides);
  std::sort(pairs.begin(), pairs.end(), [](const Pairing& a, const Pairing& b) {
    if (a.part != b.part) return a.part < b.part;
    return a.number != b.number ? a.number < b.number : a.side < b.side;
  });
  auto neighbour = part.neighbours.begin();
  for (const Pairing& pair : pairs) {
    while (neighbour->part != pair.part) ++neighbour;
    neighbour->faces.push_back(pair.face);
  }
}

}  // namespace hexhex
