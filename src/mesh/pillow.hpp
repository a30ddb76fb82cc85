// Pillows: a layer of cells between the boundary of a mesh and the cells that it had there.
//
// Where a cell has two faces on the boundary that are nearly coplanar, no position of its vertices
// makes it good. In a pillow, each cell has one face on the boundary, and those beneath have none.
// (Mitchell and Tautges 1995, "Pillowing doublets".)
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <hexhex/error.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex::mesh {

struct Pillow {
  /// Cells and vertices of the layer come last. Vertices on the boundary are those that were there,
  /// with their generators and tags; what is tagged inside ends at the boundary as before.
  HexMesh mesh;
  /// Per new vertex: one inside, on the same tagged or inner face and curve; kNone: nothing holds
  /// it.
  Array<Index> leaders;
  std::vector<Quad> walls;  ///< as given, and those that the layer adds
  /// Why there is no layer: then, the rest is empty.
  std::optional<Error> obstacle;
};

/// Halves the cells at the boundary, as it were: the depth of the layer is a quarter of theirs, and
/// nothing else moves.
/// @param mesh   without faces of more than two cells; its generators are optional
/// @param walls  faces inside on which vertices have to stay, each once, tagged ones among them
[[nodiscard]] Pillow addPillow(const HexMesh& mesh, std::span<const Quad> walls, Stage& stage);

}  // namespace hexhex::mesh
