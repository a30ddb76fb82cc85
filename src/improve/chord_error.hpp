// How far boundary quads are from the surface between their vertices, which are on it.
#pragma once

#include <cstdint>

#include <adjacency/hex_topology.hpp>

#include <hexhex/types.hpp>

#include <improve/vertex_places.hpp>

namespace hexhex::improvement {

/// All of it outlives this.
struct ChordError {
  const HexMesh& mesh;
  const VertexPlaces& places;
  const adjacency::VertexCells& around;
  const Array<std::uint8_t>& boundary;  ///< per cell: as of HexFaces
  double chord;  ///< so far may quads be from the surface, if they are not farther anyway

  /// The largest distance of centres of boundary quads at a vertex, and of edges on its curve.
  [[nodiscard]] double at(Index vertex) const;
};

}  // namespace hexhex::improvement
