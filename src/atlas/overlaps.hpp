// Where a chart overlaps itself: finds the points that several vertices claim, and moves the tets
// that claim them to charts where they do not overlap.
#pragma once

#include <cstdint>
#include <vector>

#include <hexhex/types.hpp>

#include <atlas/brick_grid.hpp>
#include <atlas/charts.hpp>
#include <igm/igm.hpp>

namespace hexhex::atlas {

/// Points of a tet in its chart, claimed for consecutive vertices.
struct Claim {
  ChartRow row;
  std::uint64_t first;
};

/// All claims of a tet.
struct TetClaims {
  Index tet;
  std::vector<Claim> claims;
};

/// @param claims  of all tets with a contested point, and of any others
/// @param charts  receives further charts
/// @param grid    with the claims of all tets entered; a contested point has one of its claims
/// @return the number of tets with contested points
template <class Id>
std::uint64_t resolveOverlaps(const igm::PreparedMap& map, const std::vector<TetClaims>& claims,
                              Charts& charts, BrickGrid<Id>& grid, Stage& stage);

}  // namespace hexhex::atlas
