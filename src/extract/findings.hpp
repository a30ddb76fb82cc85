// What an engine has found of a map besides the mesh, for later stages that would have to find it
// again.
#pragma once

#include <optional>
#include <vector>

#include <extract/edge_records.hpp>
#include <extract/lattice_lines.hpp>

namespace hexhex {

/// The propeller engine has all of it, the atlas engine nothing.
struct EngineFindings {
  std::optional<LatticeLines> lines;  ///< vertices by tet and grid point
  /// All hex edges, in any order. Which end of an edge is its beginning may depend on threads.
  std::vector<EdgeRecords> edges;
};

}  // namespace hexhex
