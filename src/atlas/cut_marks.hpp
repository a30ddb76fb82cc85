// Cut faces, and the cells in which they come between the centre and corners.
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include <hexhex/types.hpp>

#include <atlas/brick_grid.hpp>
#include <atlas/charts.hpp>
#include <atlas/grid_region.hpp>
#include <igm/igm.hpp>

namespace hexhex::atlas {

/// What the faces of a cut have in common.
struct CutTransition {
  Index from;               ///< the chart on this side
  Index to;                 ///< the chart on the other side
  lattice::Gauge map;       ///< from places of the former to places of the latter
  CutTransitionId inverse;  ///< from the other side back
};

/// The distinct transitions across the cuts of an atlas. There are few: two per sheet of cuts. If
/// there are more than names, the last ones get none. (One-byte names let a cell record two of
/// them, see CutCell.)
class CutTransitions {
 public:
  /// The transition across an unglued half-face, found or added together with its inverse; kAnyCuts
  /// if one of the sides has no chart, or no name is left.
  [[nodiscard]] CutTransitionId across(const igm::PreparedMap& map, const Charts& charts,
                                       adjacency::HalfFace halfFace);

  [[nodiscard]] const CutTransition& operator[](CutTransitionId id) const noexcept {
    return all_[id];
  }

 private:
  using Key = std::array<std::uint32_t, 6>;  ///< charts, rotation, translation
  struct Hash {
    [[nodiscard]] std::size_t operator()(const Key& key) const noexcept;
  };
  [[nodiscard]] static Key keyOf(Index from, Index to, const lattice::Gauge& map) noexcept;

  std::vector<CutTransition> all_ = std::vector<CutTransition>(1);  ///< by id; kNoCut is none
  std::unordered_map<Key, CutTransitionId, Hash> ids_;
};

/// The unglued faces.
struct Cuts {
  std::uint64_t faces = 0;
  CutTransitions transitions;
};

/// Marks, on both sides of every unglued face, the cells in which the face may meet a half
/// diagonal. Boundary faces lie in grid planes and meet none.
/// @param identitiesGlue  whether faces with the identity as transition are known to be glued
template <class Id>
[[nodiscard]] Cuts markCutCells(const igm::PreparedMap& map, const Charts& charts,
                                bool identitiesGlue, BrickGrid<Id>& grid, Stage& stage);

/// The same for the cells in the boxes of a region; faces to tets without a chart count as cut.
template <class Id>
[[nodiscard]] Cuts markCutCells(const igm::PreparedMap& map, const Charts& charts,
                                const GridRegion& region, BrickGrid<Id>& grid, Stage& stage);

}  // namespace hexhex::atlas
