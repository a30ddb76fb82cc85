// Layers of cells around sets of cells; the layers end at the boundary of the mesh. This is
// pillowing (Mitchell and Tautges 1995) of parts of a mesh.
//
// A boundary quad with two edges on one smooth curve has a corner of 180 degrees wherever its
// vertices are. A layer around its cell puts quads with right angles between it and the curve.
#pragma once

#include <span>

#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex::mesh {

struct SetLayers {
  /// Cells and vertices of the layers come last. Cells outside all sets keep their vertices; cells
  /// of a set get copies where they touch others. Tags of quads and edges move along.
  HexMesh mesh;
  Array<Index> originals;  ///< per new vertex: the vertex it copies
  Array<Index> sets;       ///< per new vertex: the set whose cells use it
};

/// @param mesh    without faces of more than two cells, and without tagged interior faces
/// @param setOf   per cell: the number of its set, or kNone. Around each vertex, the cells of a set
///                are connected by faces, and so are the others
[[nodiscard]] SetLayers addSetLayers(const HexMesh& mesh, std::span<const Index> setOf,
                                     Stage& stage);

}  // namespace hexhex::mesh
