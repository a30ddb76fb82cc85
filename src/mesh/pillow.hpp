// Pillows: a layer of cells between the boundary of a mesh and its outermost cells.
//
// Where a cell has two nearly coplanar faces on the boundary, no position of its vertices makes it
// good. In a pillow, each cell has one face on the boundary, and those beneath have none. (Mitchell
// and Tautges 1995, "Pillowing doublets".)
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <hexhex/error.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex::mesh {

struct Pillow {
  /// Cells and vertices of the layer come last. Boundary vertices keep their numbers, generators
  /// and tags; interior features end at the boundary as before.
  HexMesh mesh;
  /// Per new vertex: an interior vertex on the same tagged or inner face and curve; kNone if
  /// nothing constrains it.
  Array<Index> leaders;
  std::vector<Quad> walls;  ///< as given, plus those that the layer adds
  /// Why there is no layer; everything else is then empty.
  std::optional<Error> obstacle;
};

/// Adds a layer as deep as a quarter of the boundary cells, at their expense; nothing else moves.
/// @param mesh   without faces of more than two cells; its generators are optional
/// @param walls  interior faces on which vertices must stay, each once, including tagged ones
[[nodiscard]] Pillow addPillow(const HexMesh& mesh, std::span<const Quad> walls, Stage& stage);

}  // namespace hexhex::mesh
