// Follows half diagonals straight from the centre of a cell to its corners, to find out which
// lattice points the corners are. Verification has its own implementation (the engines use
// sweep/cell_tracer), so that it shares no decision with what it verifies.
//
// Inside the open unit cube of a cell the map is injective. So whichever triangles a path crosses,
// it ends at the same lattice point, provided that each of them has a point inside the cube. Here
// that is a point of the segment itself, possibly on an edge of the triangle: the segment is not
// perturbed, and where it could cross any of several triangles, any of them will do.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>
#include <optional>
#include <vector>

#include <verify/lattice_places.hpp>

#include <lattice/cell_corners.hpp>
#include <sweep/cell_order.hpp>

namespace hexhex::verification {

/// Whether two places are the same point of the map.
[[nodiscard]] bool areSamePoint(const igm::PreparedMap& map, const LatticePlace& a,
                                const LatticePlace& b);

/// One per thread.
class HalfDiagonals {
 public:
  /// @param places  proven
  HalfDiagonals(const igm::PreparedMap& map, const LatticePlaces& places) noexcept
      : map_(map), places_(places), half_(map.exact.unit / 2) {}

  /// A half diagonal, or the rest of one, as seen from a tet, in lattice units.
  struct Segment {
    Index tet;
    lattice::LatticePoint start;  ///< in the tet; seen from later tets, before it
    lattice::LatticePoint end;
  };

  /// Whether a half diagonal ends at a lattice point.
  /// @param exit   the face through which it leaves the tet, or kNoExit if unknown
  /// @param point  the lattice point's number
  [[nodiscard]] bool endsAt(Segment segment, int exit, std::uint64_t point);
  /// Whether a place is that of a lattice point.
  [[nodiscard]] bool isAt(const LatticePlace& place, std::uint64_t point);

 private:
  /// What floating point proves about a tet along the way.
  enum class Step : std::uint8_t { EndsInside, Leaves, IsUncertain };
  [[nodiscard]] Step look(const Segment& segment, int& exit) const noexcept;
  [[nodiscard]] bool isAtEnd(const Segment& segment, const lattice::GridPoint& z) const noexcept;
  [[nodiscard]] static bool crossesFirst(const Segment& segment, const lattice::LatticeTet& tet,
                                         int face);
  [[nodiscard]] bool cross(Segment& segment, int face) const noexcept;
  [[nodiscard]] std::optional<LatticePlace> followExactly(const Segment& segment);
  [[nodiscard]] LatticePlace endOf(const Segment& segment,
                                   lattice::CornerMask simplex) const noexcept;

  const igm::PreparedMap& map_;
  const LatticePlaces& places_;
  std::int64_t half_;              ///< half a grid unit, in lattice units
  Index owner_ = 0;                ///< of the latest point looked up
  std::vector<Segment> segments_;  ///< working memory
};

// Whether cells are those of a map: checks centres and half diagonals, tet by tet.

/// The vertices at the corners of one tet's cells, by coordinates in its chart. Cells with centres
/// in the same tet agree on them: if two half diagonals can be bent to the same point without
/// leaving their cells, that point is midway between the two centres, so it is in the tet as well.
template <class Number>
class CornerTable {
 public:
  static constexpr Number kUnknown = std::numeric_limits<Number>::max();

  /// @param lines  of the tet's centres
  void begin(std::span<const lattice::SweptLine> lines) {
    std::size_t centers = 0;
    lattice::GridPoint last{};
    for (std::size_t l = 0; l < lines.size(); ++l) {
      centers += lines[l].count;
      for (const std::uint32_t i : {std::uint32_t{0}, lines[l].count - 1}) {
        const lattice::GridPoint z = lines[l].point(i);
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
    // The box of a long thin tet holds few centres: its corners are followed one by one. (If the
    // table is limited to 32 entries per centre, verification of s17c_sphere_r100 at scale 2 takes
    // 18 % more instructions.)
    isUsed_ = volume <= 512 * static_cast<double>(centers);
    if (!isUsed_) return;
    const std::array<std::uint8_t, 3>& axes = lines.front().axes();
    strides_[axes[2]] = 1;
    strides_[axes[1]] = size_[axes[2]];
    strides_[axes[0]] = size_[axes[2]] * size_[axes[1]];
    vertices_.assign(size_[0] * size_[1] * size_[2], kUnknown);
  }

  [[nodiscard]] bool isUsed() const noexcept { return isUsed_; }
  [[nodiscard]] const std::array<std::size_t, 3>& strides() const noexcept { return strides_; }

  /// The vertex at a corner; kUnknown if not known yet.
  [[nodiscard]] Number* at(const lattice::GridPoint& z) noexcept {
    std::size_t place = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      place += static_cast<std::size_t>(z[k] - first_[k]) * strides_[k];
    }
    return &vertices_[place];
  }

  /// Enters consecutively numbered vertices, as far as they are corners of any cells.
  /// @param vertex  number of the first one
  void enter(const PlaceRun& run, Number vertex) noexcept {
    std::int64_t begin = 0;
    std::int64_t end = run.count;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int64_t offset = std::int64_t{first_[k]} - run.z[k];
      const std::int64_t behind = offset + static_cast<std::int64_t>(size_[k]);
      if (k == run.axis) {
        begin = std::max(begin, offset);
        end = std::min(end, behind);
      } else if (offset > 0 || behind <= 0) {
        return;
      }
    }
    if (begin >= end) return;
    lattice::GridPoint z = run.z;
    z[run.axis] += static_cast<std::int32_t>(begin);
    Number* place = at(z);
    for (std::int64_t i = begin; i < end; ++i, place += strides_[run.axis]) {
      *place = static_cast<Number>(vertex + static_cast<Number>(i));
    }
  }

 private:
  bool isUsed_ = false;
  lattice::GridPoint first_{};
  std::array<std::size_t, 3> size_{};
  std::array<std::size_t, 3> strides_{};
  Array<Number> vertices_;
};

/// Cells with consecutive numbers.
template <class Cell>
struct ConsecutiveCells {
  std::uint64_t first;
  std::span<const Cell> cells;

  /// The cell with that number, or null.
  [[nodiscard]] const Cell* find(std::uint64_t number) const noexcept {
    return number < first || number - first >= cells.size() ? nullptr : &cells[number - first];
  }
};

/// Steps 2 and 3 of the proof (proof.hpp), tet by tet. One per thread.
template <class Cell>
class CellChecker {
 public:
  CellChecker(const igm::PreparedMap& map, const sweep::CellCenters& centers,
              const LatticePlaces& places, Faults& hints, Faults& wrong)
      : map_(map),
        centers_(centers),
        places_(places),
        diagonals_(map, places),
        hints_(hints),
        wrong_(wrong) {}

  /// @param cells  cells that include some of the tet's: cells.find(number) is called for all cells
  ///               of the tet, in ascending order
  template <class Cells>
  void prove(Index tet, Cells cells) {
    const std::span<const lattice::SweptLine> lines = centers_.linesOf(map_.exact, tet, lines_);
    std::uint64_t cell = centers_.begin[tet];
    const std::uint64_t end = centers_.begin[tet + 1];
    if (cell == end) return;
    if (lines.empty()) return hints_.add(tet);
    const FaceSides sides(map_.exact.corners[tet], map_.exact.unit / 2);
    bool right = areInTet(map_, sides, lines, map_.exact.unit / 2);
    begin(tet, lines);
    sweep::forEachOwnedCenter(map_.topology, tet, lines,
                              [&](const lattice::SweptLine& line, std::uint32_t i) {
                                right = right && cell < end;
                                if (!right) return;
                                const std::uint64_t number = cell++;
                                const Cell* const given = cells.find(number);
                                if (given != nullptr && !isRight(tet, sides, line.point(i), *given))
                                  wrong_.add(number);
                              });
    if (!right || cell != end) hints_.add(tet);
  }

 private:
  using Number = typename Cell::value_type;
  static constexpr Number kUnknown = CornerTable<Number>::kUnknown;

  void begin(Index tet, std::span<const lattice::SweptLine> lines) {
    known_.begin(lines);
    if (!known_.isUsed()) return;
    const std::array<std::size_t, 3>& strides = known_.strides();
    for (std::size_t c = 0; c < 8; ++c) {
      steps_[c] = 0;
      for (std::size_t k = 0; k < 3; ++k)
        steps_[c] += lattice::kCellCorners[c][k] != 0 ? strides[k] : 0;
    }
    // If the tet owns the lattice point, the half diagonal reaches it within the tet.
    for (const PlaceRun& run : places_.runsOf(tet)) {
      known_.enter(run, static_cast<Number>(places_.firstOf(tet) + run.first));
    }
  }

  bool isRight(Index tet, const FaceSides& sides, const lattice::GridPoint& z, const Cell& cell) {
    if (!known_.isUsed()) {
      for (std::size_t c = 0; c < 8; ++c) {
        if (!isCorner(tet, sides, z, c, cell[c])) return false;
      }
      return true;
    }
    Number* const known = known_.at(z);
    Number differences = 0;
    bool isKnown = true;
    for (std::size_t c = 0; c < 8; ++c) {
      differences |= known[steps_[c]] ^ cell[c];
      isKnown = isKnown && cell[c] != kUnknown;
    }
    if (differences == 0 && isKnown) return true;
    for (std::size_t c = 0; c < 8; ++c) {
      Number& vertex = known[steps_[c]];
      if (vertex == cell[c] && vertex != kUnknown) continue;
      if (vertex != kUnknown || !isCorner(tet, sides, z, c, cell[c])) return false;
      vertex = cell[c];
    }
    return true;
  }

  bool isCorner(Index tet, const FaceSides& sides, const lattice::GridPoint& z, std::size_t corner,
                Number vertex) {
    if (vertex >= places_.count()) return false;
    const std::int64_t unit = map_.exact.unit;
    const lattice::GridPoint& offset = lattice::kCellCorners[corner];
    lattice::GridPoint end;
    lattice::LatticePoint start;
    lattice::LatticePoint stop;
    for (std::size_t k = 0; k < 3; ++k) {
      end[k] = z[k] + offset[k];
      start[k] = z[k] * unit + unit / 2;
      stop[k] = end[k] * unit;
    }
    const FaceSides::Place where = sides.placeOf(stop);
    if (where.beyond == 0) return diagonals_.isAt({tet, end, where.simplex}, vertex);
    return diagonals_.endsAt({tet, start, stop}, sides.exit(start, where), vertex);
  }

  const igm::PreparedMap& map_;
  const sweep::CellCenters& centers_;
  const LatticePlaces& places_;
  HalfDiagonals diagonals_;
  Faults& hints_;
  Faults& wrong_;
  CornerTable<Number> known_;
  std::array<std::size_t, 8> steps_{};  ///< in the table, from a cell's smallest corner to each
  std::vector<lattice::SweptLine> lines_;
};

}  // namespace hexhex::verification
