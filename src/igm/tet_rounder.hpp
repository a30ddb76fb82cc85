// Rounding of all tets to the lattice, where their corners do not depend on others.
#pragma once

#include <span>
#include <vector>

#include <igm/exact_map.hpp>

namespace hexhex {

struct RoundedTets {
  /// Those with corners that are decided by stars, and those that are not certainly positive; in
  /// ascending order, in lists to be worked on in parallel.
  std::vector<std::vector<Index>> unfinished;
  Int192 sixfoldVolume;  ///< of all others, if asked for
};

/// Rounds corners at regular and flat vertices, and others in vain where a star decides, and
/// updates map.maxDisplacement.
/// @param rounding  per vertex
/// @param tolerance  larger displacements are defects
[[nodiscard]] RoundedTets roundTets(const TetTopology& topology, const LocalParameters& parameters,
                                    std::span<const Rounding> rounding, double tolerance,
                                    bool measureVolume, Stage& stage, DefectCollector& defects,
                                    ExactMap& map);

}  // namespace hexhex
