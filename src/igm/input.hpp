// The input as the pipeline wants it: plausible, and positively oriented.
#pragma once

#include <cstdint>

#include <hexhex/types.hpp>

#include <base/parallel.hpp>
#include <igm/defects.hpp>

namespace hexhex {

/// More tets than this cannot be indexed by corner in 32 bits.
inline constexpr std::size_t kMaxTets = (std::size_t{1} << 30) - 1;

/// A view of a map whose tets are positive in the map and (but for a minority) in space, with
/// copies of the arrays where they had to change.
///
/// Decided here, once: if most tets are negative in space, their corners are listed in reverse, and
/// corners 2 and 3 of every tet are swapped. If most tets then have opposite signs in space and in
/// the map, the map is a reflection, and the first parameter is negated in every chart;
/// integer-grid maps stay integer-grid maps thereby. What is still negative in the map is a defect;
/// what is still negative in space does not matter, as the combinatorics lives in the map.
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
/// @throws Error InvalidArgument for arrays whose sizes do not match, and edge valences of vertices
/// that do not exist
[[nodiscard]] OrientedMap readInput(const TetMapView& map, Stage& stage, DefectCollector& defects);

}  // namespace hexhex
