// What an engine has found of a map besides the mesh, for later stages that would have to find it
// again.
#pragma once

#include <optional>
#include <vector>

#include <sweep/sweep_guest.hpp>

#include <extract/edge_records.hpp>
#include <extract/lattice_lines.hpp>

namespace hexhex {

struct EngineFindings {
  SweepGuest* guest = nullptr;  ///< sees the tets that the atlas engine sweeps, if there is one
  // Of the propeller engine:
  std::optional<LatticeLines> lines;  ///< vertices by tet and grid point
  /// All hex edges, in any order. Which end of an edge is its beginning may depend on threads.
  std::vector<EdgeRecords> edges;
};

}  // namespace hexhex
