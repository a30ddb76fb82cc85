#include <algorithm>
#include <array>
#include <cassert>
#include <vector>

#include <adjacency/cell_faces.hpp>
#include <parts/part_borders.hpp>

#include <lattice/cell_corners.hpp>
#include <lattice/wide_int.hpp>

namespace hexhex::parts {

namespace {

/// A face of an own cell or another part's cell, all of whose vertices are shared.
struct SharedSide {
  lattice::UInt128 vertices;  ///< ascending
  std::uint64_t number;       ///< global, of its cell
  Index cell;                 ///< own, or an index in the list of other cells
  bool isOwn;
  std::uint8_t side;
};

struct Pairing {
  std::uint32_t part;    ///< the neighbour
  std::uint64_t number;  ///< of the cell in the smaller part, so that both parts sort alike
  std::uint8_t side;
  PartFace face;  ///< as this part sees it
};

lattice::UInt128 nameOf(Quad quad) {
  std::sort(quad.begin(), quad.end());
  lattice::UInt128 name = 0;
  for (const Index v : quad) name = name << 32U | v;
  return name;
}

/// The corners of each side, as a set.
constexpr std::array<lattice::CellCornerSet, 6> kSideCorners = [] {
  std::array<lattice::CellCornerSet, 6> sets{};
  for (std::size_t side = 0; side < 6; ++side) {
    for (const std::uint8_t corner : adjacency::kHexFaces[side]) sets[side] |= 1U << corner;
  }
  return sets;
}();

/// @param isShared  per vertex: 1 if it is
void addSides(const Hex& corners, std::uint64_t number, std::size_t cell, bool isOwn,
              const Array<std::uint8_t>& isShared, std::vector<SharedSide>& sides) {
  lattice::CellCornerSet shared = 0;
  for (std::size_t k = 0; k < 8; ++k) {
    if (corners[k] != kNone) shared |= lattice::CellCornerSet{isShared[corners[k]]} << k;
  }
  if (shared == 0) return;
  for (std::uint8_t side = 0; side < 6; ++side) {
    if ((kSideCorners[side] & ~shared) != 0) continue;
    sides.push_back({nameOf(adjacency::faceVertices(corners, side)), number,
                     static_cast<Index>(cell), isOwn, side});
  }
}

class FacePairs {
 public:
  FacePairs(const MeshPart& part, std::span<const BorderCell> around)
      : part_(part), around_(around) {}

  /// All faces between an own cell and a cell of another part. Usually only two cells have the same
  /// four vertices; where more do, because cells meet themselves, both parts pair them in the same
  /// order.
  [[nodiscard]] std::vector<Pairing> find(std::vector<SharedSide>& sides) {
    std::sort(sides.begin(), sides.end(), [](const SharedSide& a, const SharedSide& b) {
      if (a.vertices != b.vertices) return a.vertices < b.vertices;
      return a.number != b.number ? a.number < b.number : a.side < b.side;
    });
    adjacency::forEachRun(
        std::span<const SharedSide>(sides),
        [](const SharedSide& a, const SharedSide& b) { return a.vertices == b.vertices; },
        [&](std::span<const SharedSide> run) { pairUp(run); });
    return std::move(pairs_);
  }

 private:
  [[nodiscard]] Quad quadOf(const SharedSide& side) const {
    const Hex& corners = side.isOwn ? part_.mesh.cells[side.cell] : around_[side.cell].corners;
    return adjacency::faceVertices(corners, side.side);
  }
  void pairUp(std::span<const SharedSide> run) {
    taken_.assign(run.size(), false);
    for (std::size_t i = 0; i < run.size(); ++i) {
      for (std::size_t j = i + 1; j < run.size() && !taken_[i]; ++j) {
        if (taken_[j] || !adjacency::areOpposite(quadOf(run[i]), quadOf(run[j]))) continue;
        taken_[i] = taken_[j] = true;
        add(run[i], run[j]);
      }
    }
  }
  void add(const SharedSide& a, const SharedSide& b) {
    if (a.isOwn == b.isOwn) return;
    const SharedSide& own = a.isOwn ? a : b;
    const SharedSide& other = a.isOwn ? b : a;
    const std::uint32_t neighbour = around_[other.cell].part;
    const SharedSide& named = part_.part < neighbour ? own : other;
    pairs_.push_back({neighbour, named.number, named.side, {own.cell, own.side, other.number}});
  }

  const MeshPart& part_;
  std::span<const BorderCell> around_;
  std::vector<Pairing> pairs_;
  std::vector<bool> taken_;  ///< of a run
};

/// Lists the vertices shared with each part.
/// @return per vertex of own cells: 1 if any other part has it
Array<std::uint8_t> shareVertices(MeshPart& part, std::span<const BorderCell> around) {
  struct OfPart {
    std::uint32_t part;
    Index other;  ///< index in the list of other cells
    auto operator<=>(const OfPart&) const = default;
  };
  std::vector<OfPart> others;
  others.reserve(around.size());
  for (std::size_t i = 0; i < around.size(); ++i) {
    others.push_back({around[i].part, static_cast<Index>(i)});
  }
  std::sort(others.begin(), others.end());
  Array<std::uint32_t> sharedWith(part.ownPoints, part.part);  // the latest part seen
  Array<std::uint8_t> isShared(part.ownPoints, 0);
  for (const OfPart& each : others) {
    if (part.neighbours.empty() || part.neighbours.back().part != each.part) {
      part.neighbours.push_back({each.part, {}, {}});
    }
    for (const Index v : around[each.other].corners) {
      if (v == kNone || sharedWith[v] == each.part) continue;
      sharedWith[v] = each.part;
      isShared[v] = 1;
      part.neighbours.back().vertices.push_back(v);
    }
  }
  for (PartNeighbour& neighbour : part.neighbours) {
    std::sort(neighbour.vertices.begin(), neighbour.vertices.end());
  }
  return isShared;
}

}  // namespace

void findNeighbours(MeshPart& part, std::span<const BorderCell> around) {
  assert(std::ranges::is_sorted(around, {}, &BorderCell::number));
  const Array<std::uint8_t> isShared = shareVertices(part, around);
  std::vector<SharedSide> sides;
  // Nearly all are between two cells; growing would touch twice as many pages.
  constexpr std::size_t kSidesPerVertex = 3;
  sides.reserve(kSidesPerVertex *
                static_cast<std::size_t>(std::count(isShared.begin(), isShared.end(), 1)));
  for (std::size_t c = 0; c < part.ownCells; ++c) {
    addSides(part.mesh.cells[c], part.globalCells[c], c, true, isShared, sides);
  }
  for (std::size_t i = 0; i < around.size(); ++i) {
    addSides(around[i].corners, around[i].number, i, false, isShared, sides);
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

}  // namespace hexhex::parts
