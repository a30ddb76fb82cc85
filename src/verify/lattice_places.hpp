// The lattice points of a map by canonical number: hints of the sweep over the tets, which are
// proven before they are used.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <verify/face_sides.hpp>
#include <verify/half_diagonals.hpp>

#include <base/parallel.hpp>
#include <sweep/vertex_numbers.hpp>

namespace hexhex {

/// Things that are wrong, found by several threads: how many, and the first.
class Faults {
 public:
  void add(std::size_t place) noexcept {
    ++count_;
    lowerTo(place, first_);
  }
  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  [[nodiscard]] std::size_t first() const noexcept { return first_; }

 private:
  std::atomic<std::uint64_t> count_{0};
  std::atomic<std::size_t> first_{static_cast<std::size_t>(-1)};
};

class LatticePlaces {
 public:
  LatticePlaces(const PreparedMap& map, Stage& stage)
      : map_(map), swept_(sweepVertices(map, stage)) {}

  [[nodiscard]] std::uint64_t count() const noexcept { return swept_.numbers.count(); }

  /// Whether all points of each tet are in it, and have different numbers of its own.
  /// @param listed  whether to make a list of all places
  /// @param wrong   receives tets where this is not so
  void prove(bool listed, Stage& stage, Faults& wrong);
  /// Are points where the map has their lattice points?
  /// @param first  number of the first
  void compare(std::uint64_t first, std::span<const Vec3> points, Stage& stage,
               Faults& wrong) const;
  /// Gives the lines of the tets back: only listed places are needed from now on.
  void forgetLines() { swept_.lines = TetLines(0); }

  /// Calls visit(number, z) for the lattice points that a tet owns.
  template <class Visit>
  void forEachOwned(Index tet, const Visit& visit) const {
    if (places_.empty()) {
      forEachRun(tet, [&visit](const VertexRun& run) {
        GridPoint z = run.line->point(run.offset);
        for (std::uint64_t v = run.first; v < run.first + run.count; ++v) {
          visit(v, z);
          ++z[run.line->axes()[2]];
        }
      });
      return;
    }
    for (std::uint64_t v = swept_.numbers.begin[tet]; v < swept_.numbers.begin[tet + 1]; ++v) {
      visit(v, places_[v].z);
    }
  }

 private:
  friend class PlaceFinder;

  /// Calls visit(VertexRun) for the lattice points that a tet owns.
  template <class Visit>
  void forEachRun(Index tet, const Visit& visit) const {
    const std::span<const SweptLine> lines = swept_.lines.of(tet);
    if (lines.empty()) return;
    TetNumbering(map_, swept_.numbers, tet, lines.front().axes)
        .run(lines, [&](const VertexRun& run) {
          if (run.owned) visit(run);
        });
  }
  [[nodiscard]] bool isProven(Index tet, std::vector<char>& seen);
  void list(Index tet, const VertexRun& run);

  const PreparedMap& map_;
  SweptVertices swept_;
  /// Or empty. (With a search for each place instead, verification takes twice as long.)
  Array<LatticePlace> places_;
};

/// One per thread.
class PlaceFinder {
 public:
  explicit PlaceFinder(const LatticePlaces& places)
      : places_(places), tets_(places.places_.empty() ? kTets : 0) {}

  /// @param corner  of a cell of `tet`: that of the next cell is often the next point of a line
  [[nodiscard]] LatticePlace find(std::uint64_t point, Index tet, std::size_t corner) {
    if (!places_.places_.empty()) return places_.places_[point];
    Found& last = last_[corner];
    if (point - last.run.first >= last.run.count) last = search(point, tet);
    const auto behind = static_cast<std::uint32_t>(point - last.run.first);
    return {last.tet, last.run.line->point(last.run.offset + behind), last.run.simplex};
  }

 private:
  static constexpr std::size_t kTets = 256;

  /// The lattice points of one tet, ascending.
  struct TetRuns {
    Index tet = kNone;
    std::vector<VertexRun> runs = {};
  };
  struct Found {
    Index tet = kNone;
    VertexRun run{};
  };
  /// @param likely  a tet that may have the point
  [[nodiscard]] Found search(std::uint64_t point, Index likely);

  const LatticePlaces& places_;
  std::array<Found, 8> last_;
  std::vector<TetRuns> tets_;  ///< by number, modulo kTets
};

/// The tets that own something of [first, end), as a range.
/// @param begin  per tet (+1): the first that it owns
[[nodiscard]] std::pair<std::size_t, std::size_t> tetsWith(const Array<std::uint64_t>& begin,
                                                           std::uint64_t first, std::uint64_t end);

/// Whether lines of a tet are in order, and the simplices at their ends are right; then, by
/// convexity, so are those of all points between.
/// @param shift  of the points, in lattice units along each axis: a half grid unit for centres
[[nodiscard]] bool areInTet(const PreparedMap& map, const FaceSides& sides,
                            std::span<const SweptLine> lines, std::int64_t shift);

}  // namespace hexhex
