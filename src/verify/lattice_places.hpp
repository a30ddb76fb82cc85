// On which sides of its faces do points near a tet lie, and through which face does a segment
// leave? For many points: by planes in floating point with a proven bound, and by the exact
// predicate where the bound does not decide.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <base/parallel.hpp>
#include <igm/igm.hpp>
#include <lattice/tet_geometry.hpp>
#include <sweep/vertex_numbers.hpp>

namespace hexhex::verification {

class FaceSides {
 public:
  /// Rounded values, one per face: positive inside.
  using Values = std::array<double, 4>;

  /// The position of a point relative to the tet.
  struct Place {
    lattice::CornerMask simplex;  ///< with the point in its interior, if the point is in the tet
    unsigned beyond;              ///< the faces beyond which the point lies: a bit each
    Values values;
  };

  /// @param step  all points are multiples of this, and at most this far from the tet's bounding
  ///              box
  FaceSides(const lattice::LatticeTet& tet, std::int64_t step) noexcept : tet_(tet) {
    std::int64_t bits = step;
    for (std::size_t k = 0; k < 3; ++k) {
      for (const lattice::LatticePoint& p : tet) bits |= p[k];
      const auto [low, high] = std::minmax({tet[0][k], tet[1][k], tet[2][k], tet[3][k]});
      low_[k] = low - step;
      high_[k] = high + step;
    }
    for (std::size_t f = 0; f < 4; ++f) {
      const auto corner = [&](std::size_t i) {
        return tet[static_cast<std::size_t>(lattice::kFaceCorners[f][i])];
      };
      const lattice::LatticePoint u = corner(1) - corner(0);
      const lattice::LatticePoint v = corner(2) - corner(0);
      double magnitude = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        normals_[k][f] = lattice::signedToDouble(lattice::crossComponent(u, v, k));
        // All faces but the first contain corner 0.
        if (f == 0) atOrigin_ -= normals_[k][0] * static_cast<double>(tet[1][k] - tet[0][k]);
        magnitude += 2 * std::abs(normals_[k][f]) * static_cast<double>(high_[k] - low_[k]);
      }
      // Each of six terms carries four roundings, and their sum five more: less than 2^-49.
      error_[f] = magnitude < lattice::exactBelow(bits) ? 0 : 0x1p-49 * magnitude;
    }
  }

  [[nodiscard]] Values valuesAt(const lattice::LatticePoint& point) const noexcept {
    Values values{atOrigin_};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto offset = static_cast<double>(point[k] - tet_[0][k]);
      for (std::size_t f = 0; f < 4; ++f) values[f] += normals_[k][f] * offset;
    }
    return values;
  }

  [[nodiscard]] Place placeOf(const lattice::LatticePoint& point) const noexcept {
    Place place{lattice::kNoSimplex, 0, valuesAt(point)};
    unsigned inside = 0;
    for (std::size_t f = 0; f < 4; ++f) {
      inside |= (place.values[f] > error_[f] ? 1U : 0U) << f;
      place.beyond |= (place.values[f] < -error_[f] ? 1U : 0U) << f;
    }
    const unsigned open = lattice::kWholeTet ^ inside ^ place.beyond;
    for (std::size_t f = 0; f < 4 && open != 0; ++f) {
      if ((open >> f & 1U) == 0 || error_[f] == 0) continue;
      const int side = lattice::sideOfFace(tet_, f, point);
      inside |= (side > 0 ? 1U : 0U) << f;
      place.beyond |= (side < 0 ? 1U : 0U) << f;
    }
    // A point off the face opposite a corner has a positive barycentric coordinate there.
    place.simplex = static_cast<lattice::CornerMask>(inside);
    return place;
  }

  /// The simplex whose interior contains a point, which may be anywhere; kNoSimplex outside the
  /// tet.
  [[nodiscard]] lattice::CornerMask simplexOf(const lattice::LatticePoint& point) const noexcept {
    for (std::size_t k = 0; k < 3; ++k) {
      if (point[k] < low_[k] || point[k] > high_[k]) return lattice::kNoSimplex;
    }
    const Place place = placeOf(point);
    return place.beyond == 0 ? place.simplex : lattice::kNoSimplex;
  }

  /// The face through which a segment leaves the tet, or any of several if it leaves through an
  /// edge or a vertex; kNoExit if that is not certain.
  /// @param start  in the closed tet
  /// @param end    outside of it
  [[nodiscard]] int exit(const lattice::LatticePoint& start, const Place& end) const noexcept {
    auto first = static_cast<std::size_t>(std::countr_zero(end.beyond));
    if (end.beyond == 1U << first) return static_cast<int>(first);
    const Values from = valuesAt(start);
    for (std::size_t f = first + 1; f < 4; ++f) {
      if ((end.beyond >> f & 1U) == 0) continue;
      // The segment meets a plane after a fraction from / (from - to) of its length.
      const double one = from[f] * end.values[first];
      const double other = from[first] * end.values[f];
      const double error = error_[f] * (std::abs(end.values[first]) + std::abs(from[first])) +
                           error_[first] * (std::abs(end.values[f]) + std::abs(from[f])) +
                           4 * error_[f] * error_[first] +
                           0x1p-50 * (std::abs(one) + std::abs(other));
      if (std::abs(one - other) <= error) return lattice::kNoExit;
      if (one > other) first = f;
    }
    return static_cast<int>(first);
  }

 private:
  const lattice::LatticeTet& tet_;
  lattice::LatticePoint low_;  ///< corners of the box in which the error bounds hold
  lattice::LatticePoint high_;
  std::array<Values, 3> normals_;  ///< inward, by axis and face, to within 2^-52
  double atOrigin_ = 0;            ///< value of the first face at corner 0
  Values error_;                   ///< bounds; 0 if all values are exact
};

// Positions in space of a tet's lattice points, to compare vertices with. (The engines compute them
// with sweep/tet_positions.)

class SpaceOfTet {
 public:
  SpaceOfTet(const igm::PreparedMap& map, Index tet);

  /// Calls strange(i) for each point that is not, up to rounding, where the map puts the tet's
  /// lattice point.
  /// @param z     the lattice point of the first
  /// @param axis  along which the others follow
  template <class Strange>
  void compare(const lattice::GridPoint& z, std::size_t axis, std::span<const Vec3> points,
               const Strange& strange) const {
    if (isFlat_) {
      lattice::GridPoint here = z;
      for (std::size_t i = 0; i < points.size(); ++i, ++here[axis]) {
        if (!isNear(points[i], exactly(here))) strange(i);
      }
      return;
    }
    const Vec3 first = preimage(z);
    const Vec3& step = steps_[axis];
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto n = static_cast<double>(i);
      if (!isNear(points[i],
                  {first[0] + n * step[0], first[1] + n * step[1], first[2] + n * step[2]})) {
        strange(i);
      }
    }
  }

 private:
  [[nodiscard]] Vec3 preimage(const lattice::GridPoint& z) const;
  [[nodiscard]] Vec3 exactly(const lattice::GridPoint& z) const;
  /// False for NaN.
  [[nodiscard]] bool isNear(const Vec3& p, const Vec3& q) const noexcept {
    return std::abs(p[0] - q[0]) <= error_ && std::abs(p[1] - q[1]) <= error_ &&
           std::abs(p[2] - q[2]) <= error_;
  }

  const lattice::LatticeTet& corners_;
  std::int64_t unit_;
  std::array<Vec3, 4> points_;
  lattice::GridPoint origin_{};  ///< a grid point near the tet
  Vec3 atOrigin_{};              ///< its preimage
  std::array<Vec3, 3> steps_{};  ///< change of the preimage along each axis
  double error_ = 0;             ///< error bound of preimages
  bool isFlat_ = false;          ///< so flat in the map that weights must be exact
};

// The lattice points of a map by canonical number: hints from the sweep over the tets, proven
// before they are used.

/// Faults found by several threads: their number, and the first.
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
      lattice::kNoSimplex;  ///< of the tet, with the point in its interior
};

/// Lattice points of a tet in the interior of one of its simplices, in a row along an axis, with
/// consecutive numbers.
struct PlaceRun {
  Index first;  ///< number of the first point, counted from the first one that the tet owns
  Index count;
  lattice::GridPoint z;  ///< the first point
  lattice::CornerMask simplex;
  std::uint8_t axis;
};

class LatticePlaces {
 public:
  /// Keeps two bytes per lattice point, so that each is found immediately.
  LatticePlaces(const igm::PreparedMap& map, Stage& stage);
  /// For parts and pieces of a mesh: only the lattice points of the tets proven last are known.
  /// @param numbers  hints; outlives this
  LatticePlaces(const igm::PreparedMap& map, const sweep::VertexNumbers& numbers);

  [[nodiscard]] std::uint64_t count() const noexcept { return begin_.back(); }

  /// Checks that all points of each tet are in it and have distinct numbers of its own. Call once,
  /// before everything below.
  /// @param wrong  receives the tets that fail
  void prove(Stage& stage, Faults& wrong);
  /// The same for some tets, ascending.
  void proveOnly(std::span<const Index> tets, Stage& stage, Faults& wrong);
  /// Checks that points are where the map has their lattice points.
  /// @param first  number of the first
  void compare(std::uint64_t first, std::span<const Vec3> points, Stage& stage,
               Faults& wrong) const;
  /// The same for points with explicit numbers, ascending.
  void compare(std::span<const std::uint64_t> numbers, std::span<const Vec3> points, Stage& stage,
               Faults& wrong) const;
  [[nodiscard]] bool owns(Index tet, std::uint64_t number) const noexcept {
    return begin_[tet] <= number && number < begin_[tet + 1];
  }
  [[nodiscard]] Index ownerOf(std::uint64_t number) const;
  /// The place of a lattice point.
  [[nodiscard]] LatticePlace placeIn(Index owner, std::uint64_t number) const;

  /// The lattice points that a tet owns, ascending.
  [[nodiscard]] std::span<const PlaceRun> runsOf(Index tet) const noexcept { return runs_.of(tet); }
  /// Per tet (+1): the first lattice point that it owns.
  [[nodiscard]] const Array<std::uint64_t>& begin() const noexcept { return begin_; }
  /// The number of the first lattice point that a tet owns.
  [[nodiscard]] std::uint64_t firstOf(Index tet) const noexcept { return begin_[tet]; }

 private:
  /// In the index: the run must be searched for.
  static constexpr std::uint16_t kUnknownRun = 0xffff;

  void proveTet(Index tet, const sweep::VertexNumbers& numbers,
                std::span<const lattice::SweptLine> lines, sweep::BlockLists<PlaceRun>& runs,
                Faults& wrong);
  void collectRuns(Index tet, const sweep::VertexNumbers& numbers,
                   std::span<const lattice::SweptLine> lines, std::vector<PlaceRun>& runs) const;
  [[nodiscard]] const PlaceRun& runWith(Index owner, std::uint64_t number) const;
  void enterInIndex(Index tet, std::span<const PlaceRun> runs);

  const igm::PreparedMap& map_;
  sweep::SweptVertices swept_;  ///< until proven
  const sweep::VertexNumbers* given_ = nullptr;
  Array<std::uint64_t> begin_;  ///< per tet (+1): the first lattice point it owns
  sweep::TetLists<PlaceRun> runs_;
  Array<std::uint16_t> runOf_;  ///< per lattice point: its run among those of the tet; or empty
};

/// The range of tets that own something in [first, end).
/// @param begin  per tet (+1): the first item it owns
[[nodiscard]] std::pair<std::size_t, std::size_t> tetsWith(const Array<std::uint64_t>& begin,
                                                           std::uint64_t first, std::uint64_t end);

/// Whether a tet's lines are in order and the simplices at their ends are right; by convexity, so
/// are those of all points in between.
/// @param shift  of the points, in lattice units along each axis: half a grid unit for centres
[[nodiscard]] bool areInTet(const igm::PreparedMap& map, const FaceSides& sides,
                            std::span<const lattice::SweptLine> lines, std::int64_t shift);

}  // namespace hexhex::verification
