// The lattice points of a map by canonical number: hints of the sweep over the tets, which are
// proven before they are used.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <verify/face_sides.hpp>

#include <base/parallel.hpp>
#include <sweep/vertex_numbers.hpp>

namespace hexhex::verification {

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

/// A lattice point of a closed tet, in the tet's chart.
struct LatticePlace {
  Index tet = kNone;
  lattice::GridPoint z{};
  lattice::CornerMask simplex =
      lattice::kNoSimplex;  ///< of the tet: the one that has the point in its interior
};

/// Lattice points of a tet in the interior of one of its simplices, along an axis, with consecutive
/// numbers.
struct PlaceRun {
  Index first;  ///< number of the first point, counted from the first that the tet owns
  Index count;
  lattice::GridPoint z;  ///< the first point
  lattice::CornerMask simplex;
  std::uint8_t axis;
};

class LatticePlaces {
 public:
  /// @param indexed  whether to keep two bytes per lattice point, with which each is found at once
  LatticePlaces(const igm::PreparedMap& map, bool indexed, Stage& stage);
  /// For parts of a mesh: lattice points are known of the tets that were proven last.
  /// @param numbers  hints; outlives this
  LatticePlaces(const igm::PreparedMap& map, const sweep::VertexNumbers& numbers);

  [[nodiscard]] std::uint64_t count() const noexcept { return begin_.back(); }

  /// Whether all points of each tet are in it, and have different numbers of its own. To be called
  /// once, before all that follows.
  /// @param wrong  receives tets where this is not so
  void prove(Stage& stage, Faults& wrong);
  /// The same for some tets, ascending.
  void proveOnly(std::span<const Index> tets, Stage& stage, Faults& wrong);
  /// Are points where the map has their lattice points?
  /// @param first  number of the first
  void compare(std::uint64_t first, std::span<const Vec3> points, Stage& stage,
               Faults& wrong) const;
  /// The same for points with numbers of their own, ascending.
  void compare(std::span<const std::uint64_t> numbers, std::span<const Vec3> points, Stage& stage,
               Faults& wrong) const;
  [[nodiscard]] bool owns(Index tet, std::uint64_t number) const noexcept {
    return begin_[tet] <= number && number < begin_[tet + 1];
  }
  [[nodiscard]] Index ownerOf(std::uint64_t number) const;
  /// Where a lattice point is.
  [[nodiscard]] LatticePlace placeIn(Index owner, std::uint64_t number) const;

  /// The lattice points that a tet owns, ascending.
  [[nodiscard]] std::span<const PlaceRun> runsOf(Index tet) const noexcept { return runs_.of(tet); }
  /// Per tet (+1): the first lattice point that it owns.
  [[nodiscard]] const Array<std::uint64_t>& begin() const noexcept { return begin_; }
  /// The number of the first one.
  [[nodiscard]] std::uint64_t firstOf(Index tet) const noexcept { return begin_[tet]; }

 private:
  /// In the index: a run is to be searched.
  static constexpr std::uint16_t kUnknownRun = 0xffff;

  void proveTet(Index tet, const sweep::VertexNumbers& numbers,
                std::span<const lattice::SweptLine> lines, sweep::BlockLists<PlaceRun>& runs,
                Faults& wrong);
  void collectRuns(Index tet, const sweep::VertexNumbers& numbers,
                   std::span<const lattice::SweptLine> lines, std::vector<PlaceRun>& runs) const;
  [[nodiscard]] const PlaceRun& runWith(Index owner, std::uint64_t number) const;
  void enterInIndex(Index tet, std::span<const PlaceRun> runs);

  const igm::PreparedMap& map_;
  bool indexed_;
  sweep::SweptVertices swept_;  ///< until they are proven
  const sweep::VertexNumbers* given_ = nullptr;
  Array<std::uint64_t> begin_;  ///< per tet (+1): the first lattice point that it owns
  sweep::TetLists<PlaceRun> runs_;
  Array<std::uint16_t> runOf_;  ///< per lattice point: its run among those of the tet; or empty
};

/// The tets that own something of [first, end), as a range.
/// @param begin  per tet (+1): the first that it owns
[[nodiscard]] std::pair<std::size_t, std::size_t> tetsWith(const Array<std::uint64_t>& begin,
                                                           std::uint64_t first, std::uint64_t end);

/// Whether lines of a tet are in order, and the simplices at their ends are right; then, by
/// convexity, so are those of all points between.
/// @param shift  of the points, in lattice units along each axis: a half grid unit for centres
[[nodiscard]] bool areInTet(const igm::PreparedMap& map, const FaceSides& sides,
                            std::span<const lattice::SweptLine> lines, std::int64_t shift);

}  // namespace hexhex::verification
