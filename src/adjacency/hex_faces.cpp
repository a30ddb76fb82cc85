// Matches the faces of hexahedra. Most neighbours number their corners alike and find each other at
// once. Other faces are few in most meshes, and are compared at their smallest vertices.
#include <algorithm>
#include <atomic>
#include <bit>
#include <cassert>

#include <adjacency/cell_faces.hpp>
#include <adjacency/hex_topology.hpp>
#include <adjacency/vertex_lists.hpp>

#include <base/low_level.hpp>
#include <base/parallel.hpp>

namespace hexhex::adjacency {
namespace {

constexpr std::size_t kHexFacesGrain = 2048;

/// Per face: its corners as bits.
constexpr std::array<unsigned, 6> makeCornersOfFaces() {
  std::array<unsigned, 6> result{};
  for (std::size_t f = 0; f < 6; ++f) {
    for (const std::uint8_t corner : kHexFaces[f]) result[f] |= 1U << corner;
  }
  return result;
}
constexpr std::array<unsigned, 6> kCornersOfFaces = makeCornersOfFaces();

/// The corners of faces 0, 2 and 4 of a cell, each with the corner of the preceding cell that is
/// the same vertex if both number their corners alike, on face 1, 3 or 5 of that cell.
constexpr std::array<std::array<std::array<std::uint8_t, 2>, 4>, 3> kAlignedCorners = {
    {{{{0, 1}, {3, 2}, {7, 6}, {4, 5}}},
     {{{0, 3}, {1, 2}, {5, 6}, {4, 7}}},
     {{{0, 4}, {1, 5}, {2, 6}, {3, 7}}}}};

/// Adjacent cells that number their corners alike, as most neighbours do in most meshes: one
/// look-up finds each, wherever it is in the mesh, by the last cell that has a vertex at corner 0.
class AlignedCells {
 public:
  /// @param cells  with corners below vertexCount; must outlive this object
  AlignedCells(std::size_t vertexCount, std::span<const Hex> cells, Stage& stage)
      : cells_(cells), cellAt_(vertexCount) {
    parallelFor(stage, vertexCount, 8 * kHexFacesGrain,
                [this](std::size_t v) { cellAt_[v] = kNone; });
    const auto enter = [this](std::size_t c) {
      const auto cell = static_cast<Index>(c);
      const std::atomic_ref place(cellAt_[cells_[c][0]]);
      Index known = place.load(std::memory_order_relaxed);
      while (known == kNone || known < cell) {
        if (place.compare_exchange_weak(known, cell, std::memory_order_relaxed)) return;
      }
    };
    // Cells beyond the range of an index are not found.
    parallelFor(stage, std::min<std::size_t>(cells.size(), kNone), 8 * kHexFacesGrain, enter);
  }

  /// Calls link(cell, axis, next) where face 2 * axis + 1 of a cell is face 2 * axis of the next,
  /// from any thread.
  template <class Link>
  void forEachPair(Stage& stage, const Link& link) const {
    parallelFor(stage, cells_.size(), kHexFacesGrain, [&](std::size_t c) {
      // Neighbours may be far apart in memory.
      constexpr std::size_t kAhead = 16;
      if (c + kAhead < cells_.size()) fetch(c + kAhead);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const Index next = behind(c, axis);
        if (next != kNone) link(c, axis, next);
      }
    });
  }

  /// Calls visit(cell, axis) for the cells that forEachPair() may have reported as the next behind
  /// a face with these vertices, until it returns true; returns whether it did.
  template <class Visit>
  [[nodiscard]] bool anyBehind(Quad quad, const Visit& visit) const {
    std::sort(quad.begin(), quad.end());
    return std::any_of(quad.begin(), quad.end(), [&](Index vertex) {
      const Index cell = cellAt_[vertex];
      for (std::size_t axis = 0; axis < 3 && cell != kNone; ++axis) {
        Quad face = faceVertices(cells_[cell], 2 * axis);
        std::sort(face.begin(), face.end());
        if (face == quad && visit(cell, axis)) return true;
      }
      return false;
    });
  }

 private:
  /// The neighbour along the axis: a cell whose face 2 * axis is this cell's face 2 * axis + 1,
  /// with corners numbered alike; or kNone. Cells that share the vertex at corner 0 with a later
  /// cell are not found.
  [[nodiscard]] Index behind(std::size_t cell, std::size_t axis) const noexcept {
    const Hex& here = cells_[cell];
    const Index candidate = cellAt_[here[kAlignedCorners[axis][0][1]]];
    if (candidate == kNone) return kNone;
    const Hex& there = cells_[candidate];
    Index different = 0;
    for (const auto& [behind, before] : kAlignedCorners[axis]) {
      different |= there[behind] ^ here[before];
    }
    return different == 0 ? candidate : kNone;
  }

  void fetch(std::size_t cell) const noexcept {
    for (const auto& corners : kAlignedCorners) {
      const Index candidate = cellAt_[cells_[cell][corners[0][1]]];
      if (candidate != kNone) prefetch(&cells_[candidate]);
    }
  }

  std::span<const Hex> cells_;
  Array<Index> cellAt_;  ///< per vertex: the last cell that has it at corner 0, or kNone
};

/// Per cell: bit k if corner k is a vertex of a face without a mate.
/// @param balance  grows by the number of faces with mates at corner 6, minus that at corner 0
Array<std::uint8_t> findSeamCorners(std::size_t vertexCount, std::span<const Hex> cells,
                                    const Array<Index>& mates, Stage& stage,
                                    std::atomic<std::int64_t>& balance) {
  Array<std::uint8_t> onSeam(vertexCount);
  parallelFor(stage, vertexCount, 8 * kHexFacesGrain, [&](std::size_t v) { onSeam[v] = 0; });
  parallelFor(stage, cells.size(), kHexFacesGrain, [&](std::size_t c) {
    unsigned linked = 0;
    for (std::size_t face = 0; face < 6; ++face) {
      linked |= unsigned{mates[6 * c + face] != kNone} << face;
    }
    if (linked == 63) return;  // as for most cells
    balance.fetch_add(std::popcount(linked & 0b101010U) - std::popcount(linked & 0b010101U),
                      std::memory_order_relaxed);
    for (std::size_t face = 0; face < 6; ++face) {
      if ((linked >> face & 1U) != 0) continue;
      for (const Index v : faceVertices(cells[c], face)) {
        std::atomic_ref(onSeam[v]).store(1, std::memory_order_relaxed);
      }
    }
  });
  Array<std::uint8_t> seamCorners(cells.size());
  parallelFor(stage, cells.size(), kHexFacesGrain, [&](std::size_t c) {
    unsigned corners = 0;
    for (std::size_t k = 0; k < 8; ++k) corners |= unsigned{onSeam[cells[c][k]]} << k;
    seamCorners[c] = static_cast<std::uint8_t>(corners);
  });
  return seamCorners;
}

/// Calls visit(its half-faces, list) for each wanted face, from any thread.
/// @param mayHave  mayHave(cell): false if none of its faces is wanted
/// @param isWanted  isWanted(cell, face)
/// @return everything that was appended to the lists
template <class MayHave, class Filter, class Visit>
std::vector<std::uint64_t> collectFromFaces(std::size_t vertexCount, std::span<const Hex> cells,
                                            Stage& stage, const MayHave& mayHave,
                                            const Filter& isWanted, const Visit& visit) {
  const VertexLists<Index, std::uint64_t> around(vertexCount, stage, [&](const auto& add) {
    parallelFor(stage, cells.size(), kHexFacesGrain, [&](std::size_t c) {
      if (!mayHave(c)) return;
      for (std::size_t face = 0; face < 6; ++face) {
        if (!isWanted(c, face)) continue;
        const Quad quad = faceVertices(cells[c], face);
        add(*std::min_element(quad.begin(), quad.end()), static_cast<Index>(c));
      }
    });
  });
  return collectFromBlocks<std::uint64_t>(
      stage, vertexCount, kHexFacesGrain,
      [&](std::size_t begin, std::size_t end, std::vector<std::uint64_t>& list) {
        forEachFace(cells, begin, end, around, isWanted,
                    [&](std::span<const CellFace<Hex>> halfFaces) { visit(halfFaces, list); });
      });
}

}  // namespace

std::optional<HexMates> matchHexFaces(std::size_t vertexCount, std::span<const Hex> cells,
                                      Stage& stage) {
  assert(cells.size() < kNone / 6);
  HexMates result;
  Array<Index>& mates = result.mates;
  mates.resize(6 * cells.size());
  parallelFor(stage, mates.size(), 6 * kHexFacesGrain, [&](std::size_t i) { mates[i] = kNone; });
  const AlignedCells aligned(vertexCount, cells, stage);
  aligned.forEachPair(stage, [&](std::size_t cell, std::size_t axis, Index next) {
    // In a ring of two cells, two edges have the same vertices: a seam.
    if (cells[next][kNextCorner[axis]] == cells[cell][0]) return;
    const std::size_t far = 6 * cell + 2 * axis + 1;
    const std::size_t near = 6 * std::size_t{next} + 2 * axis;
    mates[far] = static_cast<Index>(near);
    std::atomic_ref(mates[near]).store(static_cast<Index>(far), std::memory_order_relaxed);
  });
  std::atomic<std::int64_t> balance{0};
  result.seamCorners = findSeamCorners(vertexCount, cells, mates, stage, balance);
  // In a broken mesh, two cells may claim the same half-face: fewer are then claimed than claim.
  if (balance != 0) return std::nullopt;
  const auto hasSeams = [&](std::size_t cell) { return result.seamCorners[cell] != 0; };
  const auto isOnSeam = [&](std::size_t cell, std::size_t face) {
    return (result.seamCorners[cell] & kCornersOfFaces[face]) == kCornersOfFaces[face];
  };
  const auto join = [&](std::span<const CellFace<Hex>> halfFaces,
                        std::vector<std::uint64_t>& faults) {
    if (halfFaces.size() == 1) return;
    const auto& [a, b] = std::pair(halfFaces.front(), halfFaces.back());
    mates[6 * std::size_t{a.cell} + a.face] = 6 * b.cell + b.face;
    mates[6 * std::size_t{b.cell} + b.face] = 6 * a.cell + a.face;
    if (halfFaces.size() > 2 ||
        !areOpposite(faceVertices(cells[a.cell], a.face), faceVertices(cells[b.cell], b.face))) {
      faults.push_back(a.cell);
    }
  };
  if (!collectFromFaces(vertexCount, cells, stage, hasSeams, isOnSeam, join).empty()) {
    return std::nullopt;
  }
  return result;
}

std::vector<std::uint64_t> boundaryPlaces(const HexMesh& mesh, Stage& stage) {
  // Per cell: which of its faces are linked to others; one byte each, so that threads need not wait
  // for each other. The last two bytes are always set.
  using Linked = std::array<std::uint8_t, 8>;
  constexpr auto kAllLinked = std::bit_cast<std::uint64_t>(Linked{1, 1, 1, 1, 1, 1, 1, 1});
  Array<Linked> linked(mesh.cells.size());
  parallelFor(stage, linked.size(), kHexFacesGrain,
              [&](std::size_t c) { linked[c] = {0, 0, 0, 0, 0, 0, 1, 1}; });
  const AlignedCells aligned(mesh.points.size(), mesh.cells, stage);
  aligned.forEachPair(stage, [&](std::size_t cell, std::size_t axis, Index next) {
    std::atomic_ref(linked[cell][2 * axis + 1]).store(1, std::memory_order_relaxed);
    std::atomic_ref(linked[next][2 * axis]).store(1, std::memory_order_relaxed);
  });
  const auto mayHave = [&](std::size_t cell) {
    return std::bit_cast<std::uint64_t>(linked[cell]) != kAllLinked;
  };
  const auto isOpen = [&](std::size_t cell, std::size_t face) { return linked[cell][face] == 0; };
  const auto isNear = [&](Index cell, std::size_t axis) { return linked[cell][2 * axis] != 0; };
  const auto add = [&](std::span<const CellFace<Hex>> halfFaces,
                       std::vector<std::uint64_t>& places) {
    const CellFace<Hex>& first = halfFaces.front();
    // In a broken mesh, other cells may be linked across it.
    if (halfFaces.size() == 1 &&
        !aligned.anyBehind(faceVertices(mesh.cells[first.cell], first.face), isNear)) {
      places.push_back(8 * std::uint64_t{first.cell} + first.face);
    }
  };
  std::vector<std::uint64_t> places =
      collectFromFaces(mesh.points.size(), mesh.cells, stage, mayHave, isOpen, add);
  std::sort(places.begin(), places.end());
  return places;
}

Array<Quad> quadsAt(const HexMesh& mesh, std::span<const std::uint64_t> places) {
  Array<Quad> quads(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    quads[i] = faceVertices(mesh.cells[places[i] / 8], places[i] % 8);
  }
  return quads;
}

}  // namespace hexhex::adjacency
