// Meshes of the library as data of VTK, and back.
#pragma once

#include <string>

#include <hexhex/curved.hpp>
#include <hexhex/map_structure.hpp>
#include <hexhex/structure.hpp>
#include <hexhex/types.hpp>

#include <vtkSmartPointer.h>

class vtkDataArray;
class vtkPolyData;
class vtkUnstructuredGrid;

namespace hexhex::paraview {

/// Name of the cell array with the twelve parameters of a tet: u, v, w of corner 0, then of
/// corners 1 to 3.
inline constexpr const char* kParameters = "hexhex_parameters";

/// Points, tets, parameters; region of each tet as cell array `region`; features as field data.
void fillGrid(vtkUnstructuredGrid& grid, const TetMap& map);

/// @param parameters  of the cells of the grid, twelve components
/// @throws Error InvalidArgument for cells that are no tets, or another number of components
[[nodiscard]] TetMap mapOf(vtkUnstructuredGrid& grid, vtkDataArray* parameters);

/// The tets of a grid alone.
/// @throws Error InvalidArgument for other cells; EmptyMesh without cells
[[nodiscard]] TetMesh tetsOf(vtkUnstructuredGrid& grid);

/// The triangles at which charts differ, with cell arrays `tets` (2 components), `rotation` (9, by
/// rows) and `translation` (3): u in the chart of the first tet is R u + t in that of the second.
void fillChartJumps(vtkPolyData& triangles, const TetMap& map, const MapStructure& structure);

/// The singular edges of a map as lines, with cell arrays `valence` and `boundary`.
void fillSingularEdges(vtkPolyData& lines, const TetMap& map, const MapStructure& structure);

/// Tagged vertices, edges and triangles of a map, with cell arrays `tag` and `dimension` (0 to 2).
void fillFeatures(vtkPolyData& features, const TetMap& map);

/// Points with their generators, cells with quality, regions; features as field data, and tagged
/// vertices as point array.
void fillGrid(vtkUnstructuredGrid& grid, const HexMesh& mesh, const Array<double>& quality);

/// Cells of higher order, VTK's Lagrange hexahedra.
void fillGrid(vtkUnstructuredGrid& grid, const LagrangeMesh& mesh, const Array<double>& quality);

/// The hexahedra of a grid, with what fillGrid() has put there beside them.
/// @throws Error InvalidArgument for other cells; EmptyMesh without cells
[[nodiscard]] HexMesh hexesOf(vtkUnstructuredGrid& grid);

/// Lines with cell arrays `valence` and `boundary`.
void fillSingularEdges(vtkPolyData& lines, const HexMesh& mesh, const MeshStructure& structure);

/// Arcs as polylines, patches as polygons with cell array `face`.
void fillArcs(vtkPolyData& lines, const PiecewiseLinearMesh& mesh);
void fillPatches(vtkPolyData& polygons, const PiecewiseLinearMesh& mesh);

}  // namespace hexhex::paraview
