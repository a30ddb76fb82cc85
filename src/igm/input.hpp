// The input as Section 5.1 needs it: plausible, positively oriented, and with charts near the
// origin.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include <hexhex/types.hpp>

#include <base/low_level.hpp>
#include <base/parallel.hpp>
#include <base/vector3.hpp>
#include <igm/defects.hpp>

namespace hexhex::igm {

/// With more tets than this, 32 bits cannot index corners.
inline constexpr std::size_t kMaxTets = (std::size_t{1} << 30) - 1;

/// A view of a map whose tets are positive in the map and (except for a minority) in space, with
/// copies of the arrays that had to change.
///
/// Decided here, once: if most tets are negative in space, their corners are listed in reverse:
/// corners 2 and 3 of every tet are swapped. If most tets then have opposite signs in space and in
/// the map, the map is a reflection, and the first parameter is negated in every chart;
/// integer-grid maps remain integer-grid maps. Tets that are still negative in the map are defects;
/// tets that are still negative in space do not matter, as the combinatorics depends on the map
/// alone.
struct OrientedMap {
  TetMapView view;
  bool cornersReversed = false;
  bool mirrored = false;
  std::uint64_t tetsInvertedInSpace = 0;
  bool flippedTets = false;  ///< some tets are (nearly) flipped or degenerate in the map as given
  double largestCoordinate = 0;  ///< of a parameter, in magnitude
  double largestExtent = 0;      ///< of a tet in the map, along an axis

  Array<Tet> tets;
  Array<TetParameters> parameters;

  OrientedMap() = default;
  // Moving an Array keeps its elements in place, so `view` stays valid; copying would not.
  OrientedMap(OrientedMap&&) = default;
  OrientedMap& operator=(OrientedMap&&) = default;
  OrientedMap(const OrientedMap&) = delete;
  OrientedMap& operator=(const OrientedMap&) = delete;
  ~OrientedMap() = default;

  /// The corner of the caller's tet that is corner i here, and conversely.
  [[nodiscard]] int callersCorner(int i) const noexcept {
    return cornersReversed && i >= 2 ? 5 - i : i;
  }
  /// A set of corners of a tet here, in terms of the caller's tet.
  [[nodiscard]] CornerSet callersCorners(CornerSet corners) const noexcept {
    if (!cornersReversed) return corners;
    const unsigned set = corners;
    return static_cast<CornerSet>((set & 3U) | ((set & 4U) << 1) | ((set & 8U) >> 1));
  }
};

/// Checks indices and numbers, and orients the map. After a defect (indices out of range, a vertex
/// twice in a tet, numbers that are not finite, no tets or too many) the result must not be used.
/// @throws Error InvalidArgument for arrays whose sizes do not match, and for edge valences and
///         features of vertices that do not exist
[[nodiscard]] OrientedMap readInput(const TetMapView& map, Stage& stage, DefectCollector& defects);

/// Parameters near the origin. Charts may lie far away (translations of 1e9 occur), which would
/// cost fractional bits; so each tet's chart is moved by a multiple of `grid`, exactly. The grid is
/// coarse, so that neighbours in one chart nearly always move alike and identity transitions remain
/// identities.
class LocalParameters {
 public:
  /// @param map  must outlive this
  explicit LocalParameters(const OrientedMap& map) noexcept;

  /// Whether coordinates are too large for the arithmetic of later stages. Parameters may then only
  /// be compared.
  [[nodiscard]] bool tooLarge() const noexcept { return tooLarge_; }

  [[nodiscard]] Vec3 operator()(Index tet, int corner) const noexcept {
    return at(tet, static_cast<std::size_t>(corner));
  }
  [[nodiscard]] Vec3 at(Index tet, std::size_t corner) const noexcept {
    const TetParameters& parameters = parameters_[tet];
    const Vec3& u = parameters[corner];
    return moved_ ? minus(u, move(parameters)) : u;
  }
  /// All corners of a tet.
  [[nodiscard]] TetParameters operator()(Index tet) const noexcept {
    TetParameters parameters = parameters_[tet];
    if (moved_) {
      const Vec3 by = move(parameters);
      for (Vec3& u : parameters) u = minus(u, by);
    }
    return parameters;
  }
  /// Whether (*this)(tet) may differ from the caller's parameters.
  [[nodiscard]] bool moved() const noexcept { return moved_; }
  /// The caller's parameters.
  [[nodiscard]] const TetParameters& given(Index tet) const noexcept { return parameters_[tet]; }
  /// The multiple of the grid by which a chart with this coordinate at corner 0 is moved.
  [[nodiscard]] double roundedToGrid(double coordinate) const noexcept {
    return std::nearbyint(coordinate / grid_) * grid_;
  }
  /// Prefetches the parameters of a tet.
  void prefetch(Index tet) const noexcept {
    const TetParameters& parameters = parameters_[tet];
    hexhex::prefetch(&parameters.front());
    hexhex::prefetch(&parameters.back().back());
  }
  /// All corners of a tet, without a copy if they are where the caller put them.
  /// @param scratch  must outlive the result
  [[nodiscard]] const TetParameters& see(Index tet, TetParameters& scratch) const noexcept {
    return moved_ ? copyTo(scratch, tet) : parameters_[tet];
  }
  /// Largest magnitude of a coordinate.
  [[nodiscard]] double largest() const noexcept { return largest_; }
  /// Largest extent of a tet along an axis.
  [[nodiscard]] double largestExtent() const noexcept { return largestExtent_; }

 private:
  /// Separate, as compilers would otherwise share the copy's loads with the usual case.
  const TetParameters& copyTo(TetParameters& scratch, Index tet) const noexcept;
  [[nodiscard]] Vec3 move(const TetParameters& parameters) const noexcept {
    Vec3 by{};
    for (std::size_t k = 0; k < 3; ++k) by[k] = roundedToGrid(parameters[0][k]);
    return by;
  }

  std::span<const TetParameters> parameters_;
  double grid_ = 0;
  double largest_ = 0;
  double largestExtent_ = 0;
  bool moved_ = false;
  bool tooLarge_ = false;
};

}  // namespace hexhex::igm
