// Most neighbours number their corners alike and find each other at once. A face that is found in
// otherwise, or could be another cell's as well, has all its vertices on seams: such faces are
// few in most meshes, and are compared at their smallest vertices.
#include <algorithm>
#include <atomic>
#include <bit>

#include <adjacency/cell_faces.hpp>
#include <adjacency/hex_faces.hpp>
#include <adjacency/vertex_lists.hpp>

#include <base/parallel.hpp>
#include <base/low_level.hpp>

namespace hexhex {
namespace {

constexpr std::size_t kGrain = 2048;

/// By face: its corners as bits.
constexpr std::array<unsigned, 6> makeCornersOfFaces() {
  std::array<unsigned, 6> result{};
  for (std::size_t f = 0; f < 6; ++f) {
    for (const std::uint8_t corner : kHexFaces[f]) result[f] |= 1U << corner;
  }
  return result;
}
constexpr std::array<unsigned, 6> kCornersOfFaces = makeCornersOfFaces();

/// The corners of the faces 0, 2 and 4 of a cell, each with the corner of the cell before it that
/// is the same vertex if both number their corners alike: face 1, 3 or 5 of that cell.
constexpr std::array<std::array<std::array<std::uint8_t, 2>, 4>, 3> kAlignedCorners = {
    {{{{0, 1}, {3, 2}, {7, 6}, {4, 5}}},
     {{{0, 3}, {1, 2}, {5, 6}, {4, 7}}},
     {{{0, 4}, {1, 5}, {2, 6}, {3, 7}}}}};

/// Cells beside each other that number their corners alike, as most neighbours do in most meshes:
/// one look-up finds each, wherever it stands in the mesh, by the last cell that has a vertex at
/// corner 0.
class AlignedCells {
 public:
  /// @param cells  with corners below vertexCount; must outlive this object
  AlignedCells(std::size_t vertexCount, std::span<const Hex> cells, Stage& stage)
      : cells_(cells), cellAt_(vertexCount) {
    parallelFor(stage, vertexCount, 8 * kGrain, [this](std::size_t v) { cellAt_[v] = kNone; });
    const auto enter = [this](std::size_t c) {
      const auto cell = static_cast<Index>(c);
      const std::atomic_ref place(cellAt_[cells_[c][0]]);
      Index known = place.load(std::memory_order_relaxed);
      while (known == kNone || known < cell) {
        if (place.compare_exchange_weak(known, cell, std::memory_order_relaxed)) return;
      }
    };
    // Cells beyond what an index can name are not found.
    parallelFor(stage, std::min<std::size_t>(cells.size(), kNone), 8 * kGrain, enter);
  }

  /// A cell with face 2 * axis where this cell has face 2 * axis + 1, whose four corners there are
  /// what its neighbour along the axis is in this cell; or kNone. Cells that share a vertex at
  /// corner 0 with a later cell are not found.
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

  /// Calls f(cell, {behind(cell, 0), behind(cell, 1), behind(cell, 2)}) for the cells of
  /// [begin, end). Quicker than asking for one after the other, as neighbours may be far from each
  /// other in memory: they are fetched ahead.
  template <class F>
  void forEach(std::size_t begin, std::size_t end, const F& f) const {
    constexpr std::size_t kAhead = 16;
    for (std::size_t c = begin; c < end; ++c) {
      if (c + kAhead < end) fetch(c + kAhead);
      f(c, std::array<Index, 3>{behind(c, 0), behind(c, 1), behind(c, 2)});
    }
  }

 private:
  void fetch(std::size_t cell) const noexcept {
    for (const auto& corners : kAlignedCorners) {
      const Index candidate = cellAt_[cells_[cell][corners[0][1]]];
      if (candidate != kNone) prefetch(&cells_[candidate]);
    }
  }

  std::span<const Hex> cells_;
  Array<Index> cellAt_;  ///< per vertex: the last cell that has it at corner 0, or kNone
};

/// Calls link(cell, axis, next) where face 2 * axis + 1 of a cell is face 2 * axis of the next one.
template <class Link>
void linkAlignedCells(std::size_t vertexCount, std::span<const Hex> cells, Stage& stage,
                      const Link& link) {
  const AlignedCells aligned(vertexCount, cells, stage);
  parallelBlocks(
      stage, cells.size(), kGrain, [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
        aligned.forEach(begin, end, [&](std::size_t cell, const std::array<Index, 3>& behind) {
          for (std::size_t axis = 0; axis < 3; ++axis) {
            const Index next = behind[axis];
            if (next == kNone) continue;
            // In a ring of two cells, two edges have the same vertices: a seam.
            if (cells[next][kNextCorner[axis]] == cells[cell][0]) continue;
            link(cell, axis, next);
          }
        });
      });
}

/// Per cell: bit k if corner k is a vertex of a face that is not linked.
/// @param balance  grows by how many more faces at corner 6 than at corner 0 are linked
template <class IsLinked>
Array<std::uint8_t> findSeamCorners(std::size_t vertexCount, std::span<const Hex> cells,
                                    Stage& stage, const IsLinked& isLinked,
                                    std::atomic<std::int64_t>& balance) {
  Array<std::uint8_t> onSeam(vertexCount);
  parallelFor(stage, vertexCount, 8 * kGrain, [&](std::size_t v) { onSeam[v] = 0; });
  parallelFor(stage, cells.size(), kGrain, [&](std::size_t c) {
    unsigned linked = 0;
    for (std::size_t face = 0; face < 6; ++face) linked |= unsigned{isLinked(c, face)} << face;
    if (linked == 63) return;  // as of most cells
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
  parallelFor(stage, cells.size(), kGrain, [&](std::size_t c) {
    unsigned corners = 0;
    for (std::size_t k = 0; k < 8; ++k) corners |= unsigned{onSeam[cells[c][k]]} << k;
    seamCorners[c] = static_cast<std::uint8_t>(corners);
  });
  return seamCorners;
}

/// Calls visit(its half-faces) for each face with all its vertices on seams, from any thread.
template <class Visit>
void forEachSeamFace(std::size_t vertexCount, std::span<const Hex> cells,
                     std::span<const std::uint8_t> seamCorners, Stage& stage, const Visit& visit) {
  const auto isOnSeam = [seamCorners](std::size_t cell, std::size_t face) {
    return (seamCorners[cell] & kCornersOfFaces[face]) == kCornersOfFaces[face];
  };
  const VertexLists<Index, std::uint64_t> around(vertexCount, stage, [&](const auto& add) {
    parallelFor(stage, cells.size(), kGrain, [&](std::size_t c) {
      if (seamCorners[c] == 0) return;
      for (std::size_t face = 0; face < 6; ++face) {
        if (!isOnSeam(c, face)) continue;
        const Quad quad = faceVertices(cells[c], face);
        add(*std::min_element(quad.begin(), quad.end()), static_cast<Index>(c));
      }
    });
  });
  parallelBlocks(stage, vertexCount, kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   FacesAtVertices<Hex> faces(cells);
                   for (std::size_t v = begin; v < end; ++v) {
                     faces.forEach(static_cast<Index>(v), around.at(v), isOnSeam, visit);
                   }
                 });
}

}  // namespace

std::optional<HexMates> matchHexFaces(std::size_t vertexCount, std::span<const Hex> cells,
                                      Stage& stage) {
  HexMates result;
  Array<Index>& mates = result.mates;
  mates.resize(6 * cells.size());
  parallelFor(stage, mates.size(), 6 * kGrain, [&](std::size_t i) { mates[i] = kNone; });
  linkAlignedCells(vertexCount, cells, stage, [&](std::size_t cell, std::size_t axis, Index next) {
    const std::size_t far = 6 * cell + 2 * axis + 1;
    const std::size_t near = 6 * std::size_t{next} + 2 * axis;
    mates[far] = static_cast<Index>(near);
    std::atomic_ref(mates[near]).store(static_cast<Index>(far), std::memory_order_relaxed);
  });
  std::atomic<std::int64_t> balance{0};
  result.seamCorners = findSeamCorners(
      vertexCount, cells, stage,
      [&](std::size_t cell, std::size_t face) { return mates[6 * cell + face] != kNone; }, balance);
  // In a broken mesh, two cells may claim the same half-face: then fewer are claimed than claim.
  if (balance != 0) return std::nullopt;
  std::atomic<bool> isSound{true};
  forEachSeamFace(vertexCount, cells, result.seamCorners, stage,
                  [&](std::span<const CellFace<Hex>> halfFaces) {
                    if (halfFaces.size() == 1) return;
                    const auto& [a, b] = std::pair(halfFaces.front(), halfFaces.back());
                    mates[6 * std::size_t{a.cell} + a.face] = 6 * b.cell + b.face;
                    mates[6 * std::size_t{b.cell} + b.face] = 6 * a.cell + a.face;
                    if (halfFaces.size() > 2 || !areOpposite(faceVertices(cells[a.cell], a.face),
                                                             faceVertices(cells[b.cell], b.face))) {
                      isSound.store(false, std::memory_order_relaxed);
                    }
                  });
  if (!isSound) return std::nullopt;
  return result;
}

Array<std::uint64_t> boundaryPlaces(const HexMesh& mesh, Stage& stage) {
  enum class Kind : std::uint8_t { Unknown, Shared, Boundary };
  // One byte each, so that threads need not wait for each other.
  Array<std::array<Kind, 6>> kinds(mesh.cells.size());
  parallelFor(stage, kinds.size(), kGrain, [&](std::size_t c) { kinds[c].fill(Kind::Unknown); });
  const auto set = [&kinds](std::size_t cell, std::size_t face, Kind kind) {
    std::atomic_ref(kinds[cell][face]).store(kind, std::memory_order_relaxed);
  };
  linkAlignedCells(mesh.points.size(), mesh.cells, stage,
                   [&](std::size_t cell, std::size_t axis, Index next) {
                     set(cell, 2 * axis + 1, Kind::Shared);
                     set(next, 2 * axis, Kind::Shared);
                   });
  std::atomic<std::int64_t> balance{0};  // of no interest here
  const Array<std::uint8_t> seamCorners = findSeamCorners(
      mesh.points.size(), mesh.cells, stage,
      [&](std::size_t cell, std::size_t face) { return kinds[cell][face] == Kind::Shared; },
      balance);
  forEachSeamFace(mesh.points.size(), mesh.cells, seamCorners, stage,
                  [&](std::span<const CellFace<Hex>> halfFaces) {
                    const CellFace<Hex>& first = halfFaces.front();
                    if (halfFaces.size() == 1) set(first.cell, first.face, Kind::Boundary);
                  });
  Array<std::uint64_t> places;
  for (std::size_t c = 0; c < kinds.size(); ++c) {
    if (seamCorners[c] == 0) continue;
    for (std::size_t face = 0; face < 6; ++face) {
      if (kinds[c][face] == Kind::Boundary) places.push_back(8 * c + face);
    }
  }
  return places;
}

Array<Quad> quadsAt(const HexMesh& mesh, std::span<const std::uint64_t> places) {
  Array<Quad> quads(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    quads[i] = faceVertices(mesh.cells[places[i] / 8], places[i] % 8);
  }
  return quads;
}

}  // namespace hexhex
