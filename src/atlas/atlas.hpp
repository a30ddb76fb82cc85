// The atlas engine: most cells are read off the charts of an atlas of the map; corners behind a cut
// of the atlas are resolved one by one (docs/developer/atlas.md).
//
// Why this is correct: consider a cell whose centre lies in a tet of chart C, such that no face
// that is not glued in C meets the cell's open cube. The part of the mesh around the centre that
// maps onto the open cube does so one to one, and no unglued face leads out of it; so all its tets
// are in C, and their points, the cell's corners among them, are in C's grid. As every point of
// these tets belongs to their own vertices there (VertexGrid), the grid shows the cell's corners.
#pragma once

#include <cstdint>

#include <hexhex/context.hpp>
#include <hexhex/extract.hpp>
#include <hexhex/stream.hpp>
#include <hexhex/types.hpp>

#include <base/switches.hpp>
#include <igm/igm.hpp>
#include <sweep/vertex_numbers.hpp>

namespace hexhex::atlas {

/// Extracts the mesh of a map that has passed all checks and is scaled.
/// @param expectedCells  the map's parametric volume
/// @param observer       sees the tets that are swept, if not null
[[nodiscard]] HexMesh runAtlas(const igm::PreparedMap& map, std::uint64_t expectedCells,
                               Context& context, ExtractStatistics& statistics,
                               const EngineSwitches& switches = {},
                               sweep::SweepObserver* observer = nullptr);

/// The same, piece by piece.
void streamAtlas(const igm::PreparedMap& map, std::uint64_t expectedCells, MeshSink& sink,
                 Context& context, ExtractStatistics& statistics,
                 const EngineSwitches& switches = {});

}  // namespace hexhex::atlas
