// The tets around a defect whose parameters a repair may change.
#pragma once

#include <span>
#include <vector>

#include <adjacency/tet_topology.hpp>
#include <tetmap/cut.hpp>

#include <igm/vertex_star.hpp>

namespace hexhex::repairs {

struct Patch {
  std::vector<Index> startTets;  ///< the bad tets, ascending
  std::vector<Index> vertices;   ///< ascending; with their whole stars in the patch, so they may
                                 ///< move
  std::vector<Index> tets;       ///< ascending: the tets at these vertices
  /// Per entry of `vertices`: its star.
  std::vector<std::vector<igm::VertexStar::Member>> stars;
};

/// The vertices of the start tets, extended `rings - 1` times by those of the surrounding tets.
/// @param startTets  ascending
/// @param rings  at least 1
[[nodiscard]] Patch growPatch(const adjacency::TetTopology& topology,
                              std::span<const Index> startTets, int rings);

/// Splits bad tets into groups whose patches of `rings` rings share no tet.
[[nodiscard]] std::vector<std::vector<Index>> separateRegions(
    const adjacency::TetTopology& topology, std::span<const Index> bad, int rings);

}  // namespace hexhex::repairs
