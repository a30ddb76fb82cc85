#include <algorithm>

#include <verify/face_sides.hpp>
#include <verify/half_diagonals.hpp>
#include <verify/proof.hpp>
#include <verify/space_of_tet.hpp>

#include <base/workspaces.hpp>
#include <lattice/cell_corners.hpp>
#include <sweep/cell_centers.hpp>
#include <sweep/vertex_numbers.hpp>

namespace hexhex {

namespace {

LatticePoint vertexPoint(const GridPoint& z, std::int64_t unit) {
  return {z[0] * unit, z[1] * unit, z[2] * unit};
}

LatticePoint centerPoint(const GridPoint& z, std::int64_t unit) {
  const std::int64_t half = unit / 2;
  return {(2 * std::int64_t{z[0]} + 1) * half, (2 * std::int64_t{z[1]} + 1) * half,
          (2 * std::int64_t{z[2]} + 1) * half};
}

/// Whether lines are in order, and the simplices at their ends are right; then, by convexity, so
/// are those of all points between.
template <class PointOf>
bool areInTet(const FaceSides& sides, std::span<const SweptLine> lines, const PointOf& pointOf) {
  const SweptLine* before = nullptr;
  for (const SweptLine& line : lines) {
    if (before != nullptr &&
        std::pair(before->level, before->row) >= std::pair(line.level, line.row)) {
      return false;
    }
    before = &line;
    if (line.count == 0 || sides.simplexOf(pointOf(line.point(0))) != line.left ||
        (line.count > 1 && sides.simplexOf(pointOf(line.point(line.count - 1))) != line.right)) {
      return false;
    }
  }
  return true;
}

/// Step 1: the lattice points of vertices.
class Places {
 public:
  Places(const PreparedMap& map, const HexMesh& mesh, Stage& stage, Proof& proof)
      : map_(map), mesh_(mesh), swept_(sweepVertices(map, stage)), places_(mesh.points.size()) {
    if (swept_.numbers.count() != places_.size()) {
      places_ = {};
      return;
    }
    parallelFor(stage, map.topology.tetCount(), kSweepBlock,
                [&](std::size_t t) { place(static_cast<Index>(t), proof); });
    swept_.lines = TetLines(0);
  }

  [[nodiscard]] bool areKnown() const noexcept { return places_.size() == mesh_.points.size(); }
  [[nodiscard]] const LatticePlace& operator[](Index vertex) const noexcept {
    return places_[vertex];
  }

 private:
  void place(Index tet, Proof& proof) {
    const std::size_t first = swept_.numbers.begin[tet];
    const std::size_t end = swept_.numbers.begin[tet + 1];
    for (std::size_t v = first; v < end; ++v) places_[v].tet = kNone;
    const std::span<const SweptLine> lines = swept_.lines.of(tet);
    if (lines.empty()) {
      if (first != end) proof.sweep.add(tet);
      return;
    }
    std::uint64_t left = end - first;
    bool right = areInTet(FaceSides(map_.exact.corners[tet]), lines,
                          [this](const GridPoint& z) { return vertexPoint(z, map_.exact.unit); });
    const SpaceOfTet space(map_, tet);
    const SweepAxes axes = lines.front().axes;
    TetNumbering(map_, swept_.numbers, tet, axes).run(lines, [&](const VertexRun& run) {
      if (!run.owned) return;
      right = right && run.count <= left && run.first >= first && run.first + run.count <= end;
      if (!right) return;
      left -= run.count;
      GridPoint z = run.line->point(run.offset);
      space.compare(z, axes()[2], std::span(mesh_.points).subspan(run.first, run.count),
                    [&](std::size_t i) { proof.positions.add(run.first + i); });
      for (std::uint64_t v = run.first; v < run.first + run.count; ++v, ++z[axes()[2]]) {
        right = right && places_[v].tet == kNone;
        places_[v] = {tet, z, run.simplex};
      }
    });
    if (!right || left != 0) proof.sweep.add(tet);
  }

  const PreparedMap& map_;
  const HexMesh& mesh_;
  SweptVertices swept_;
  Array<LatticePlace> places_;
};

/// What is known about the corners of the cells of one tet. Cells whose centres are in one tet
/// agree about the lattice point at some coordinates: a point that both half diagonals can be bent
/// to, inside of their cells, is the middle between their centres, which is in the tet as well.
class CornerTable {
 public:
  /// @param lines  of the centres of a tet
  void begin(std::span<const SweptLine> lines) {
    std::size_t centers = 0;
    GridPoint last{};
    for (std::size_t l = 0; l < lines.size(); ++l) {
      centers += lines[l].count;
      for (const std::uint32_t i : {std::uint32_t{0}, lines[l].count - 1}) {
        const GridPoint z = lines[l].point(i);
        for (std::size_t k = 0; k < 3; ++k) {
          first_[k] = l == 0 && i == 0 ? z[k] : std::min(first_[k], z[k]);
          last[k] = l == 0 && i == 0 ? z[k] : std::max(last[k], z[k]);
        }
      }
    }
    double volume = 1;
    for (std::size_t k = 0; k < 3; ++k) {
      size_[k] = static_cast<std::size_t>(std::int64_t{last[k]} - first_[k] + 2);
      volume *= static_cast<double>(size_[k]);
    }
    // A long thin tet has few centres for its box: its corners are followed one by one.
    isUsed_ = volume <= 32 * static_cast<double>(centers) + 64;
    if (isUsed_) vertices_.assign(size_[0] * size_[1] * size_[2], kNone);
  }

  [[nodiscard]] bool isUsed() const noexcept { return isUsed_; }
  /// Where the vertex at a lattice point is: kNone if it is not known yet.
  [[nodiscard]] Index* at(const GridPoint& z) noexcept {
    const auto from = [&](std::size_t k) { return static_cast<std::size_t>(z[k] - first_[k]); };
    return &vertices_[(from(0) * size_[1] + from(1)) * size_[2] + from(2)];
  }
  /// From one to the next along each axis.
  [[nodiscard]] std::array<std::size_t, 3> strides() const noexcept {
    return {size_[1] * size_[2], size_[2], 1};
  }

 private:
  bool isUsed_ = false;
  GridPoint first_{};
  std::array<std::size_t, 3> size_{};
  std::vector<Index> vertices_;
};

/// Steps 2 and 3, for the cells of one tet after the other. One per thread.
class CellProver {
 public:
  CellProver(const PreparedMap& map, const HexMesh& mesh, const CellCenters& centers,
             const Places& places, Proof& proof)
      : map_(map),
        mesh_(mesh),
        centers_(centers),
        places_(places),
        diagonals_(map),
        proof_(proof) {}

  void prove(Index tet) {
    const std::span<const SweptLine> lines = centers_.linesOf(map_.exact, tet, lines_);
    std::uint64_t cell = centers_.begin[tet];
    const std::uint64_t end = centers_.begin[tet + 1];
    if (lines.empty()) {
      if (cell != end) proof_.sweep.add(tet);
      return;
    }
    const FaceSides sides(map_.exact.corners[tet]);
    bool right = areInTet(sides, lines,
                          [this](const GridPoint& z) { return centerPoint(z, map_.exact.unit); });
    if (cell != end) begin(lines);
    forEachOwnedCenter(map_.topology, tet, lines, [&](const SweptLine& line, std::uint32_t i) {
      right = right && cell < end;
      if (!right) return;
      if (!isRight(tet, sides, line.point(i), mesh_.cells[cell])) proof_.cells.add(cell);
      ++cell;
    });
    if (!right || cell != end) proof_.sweep.add(tet);
  }

 private:
  void begin(std::span<const SweptLine> lines) {
    known_.begin(lines);
    const std::array<std::size_t, 3> strides = known_.strides();
    for (std::size_t c = 0; c < 8; ++c) {
      steps_[c] = 0;
      for (std::size_t k = 0; k < 3; ++k) steps_[c] += kCellCorners[c][k] != 0 ? strides[k] : 0;
    }
  }

  bool isRight(Index tet, const FaceSides& sides, const GridPoint& z, const Hex& cell) {
    if (!known_.isUsed()) {
      for (std::size_t c = 0; c < 8; ++c) {
        if (!isCorner(tet, sides, z, c, cell[c])) return false;
      }
      return true;
    }
    Index* const known = known_.at(z);
    for (std::size_t c = 0; c < 8; ++c) {
      Index& vertex = known[steps_[c]];
      if (vertex == cell[c]) continue;
      if (vertex != kNone || !isCorner(tet, sides, z, c, cell[c])) return false;
      vertex = cell[c];
    }
    return true;
  }

  bool isCorner(Index tet, const FaceSides& sides, const GridPoint& z, std::size_t corner,
                Index vertex) {
    const LatticePlace& place = places_[vertex];
    const GridPoint& offset = kCellCorners[corner];
    const GridPoint end = {z[0] + offset[0], z[1] + offset[1], z[2] + offset[2]};
    // A lattice point of the tet is one that the half diagonal comes to within the tet.
    if (place.tet == tet && place.z[0] == end[0] && place.z[1] == end[1] && place.z[2] == end[2]) {
      return true;
    }
    if (place.simplex != kWholeTet) {
      const CornerMask simplex = sides.simplexOf(vertexPoint(end, map_.exact.unit));
      if (simplex != kNoSimplex) return areSamePoint(map_, {tet, end, simplex}, place);
    }
    return diagonals_.endsAt(tet, z, offset, place);
  }

  const PreparedMap& map_;
  const HexMesh& mesh_;
  const CellCenters& centers_;
  const Places& places_;
  HalfDiagonals diagonals_;
  Proof& proof_;
  CornerTable known_;
  std::array<std::size_t, 8> steps_{};  ///< in the table, from a cell's smallest corner to each
  std::vector<SweptLine> lines_;
};

}  // namespace

ElementCounts expectedElements(const Expectation& expected) noexcept {
  // The 12 edges of all cells are regular edges, of four cells or, on the boundary, of two, and
  // singular ones.
  std::uint64_t singular = 0;
  std::uint64_t singularBoundary = 0;
  std::uint64_t cellsAtSingular = 0;
  for (const auto& [valence, count] : expected.innerSingularEdges) {
    singular += count;
    cellsAtSingular += count * static_cast<std::uint64_t>(valence);
  }
  for (const auto& [valence, count] : expected.boundarySingularEdges) {
    singular += count;
    singularBoundary += count;
    cellsAtSingular += count * static_cast<std::uint64_t>(valence);
  }
  const std::uint64_t regularBoundary = 2 * expected.boundaryQuads - singularBoundary;
  const std::uint64_t regularInner =
      (12 * expected.cells - cellsAtSingular - 2 * regularBoundary) / 4;
  ElementCounts counts;
  counts.edges = singular + regularBoundary + regularInner;
  counts.faces = (6 * expected.cells + expected.boundaryQuads) / 2;
  counts.vertices = static_cast<std::uint64_t>(expected.eulerCharacteristic) + counts.edges +
                    expected.cells - counts.faces;
  return counts;
}

void prove(const PreparedMap& map, const Expectation& expected, const HexMesh& mesh, Stage& stage,
           Proof& proof) {
  proof.numbersAgree = mesh.cells.size() == expected.cells &&
                       mesh.points.size() == expectedElements(expected).vertices;
  if (!proof.numbersAgree) return;
  const Places places(map, mesh, stage, proof);
  const CellCenters centers = findCells(map, stage);
  if (!places.areKnown() || centers.count() != expected.cells) {
    proof.numbersAgree = false;
    return;
  }
  if (proof.sweep.count() > 0) return;
  parallelForWith(
      stage, map.topology.tetCount(), kSweepBlock / 8,
      [&] { return CellProver(map, mesh, centers, places, proof); },
      [](std::size_t tet, CellProver& prover) { prover.prove(static_cast<Index>(tet)); });
}

}  // namespace hexhex
