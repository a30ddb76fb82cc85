// Maps in VTK's files: cells and points with arrays of numbers, one of which is the map.
//
// A cell array of 12 numbers per tet holds u0 v0 w0 u1 v1 w1 u2 v2 w2 u3 v3 w3, the parameters of
// its corners in their order; a point array of 3 numbers holds u v w of each point, for maps
// without jumps between charts.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <io/core/cell_mesh.hpp>

namespace hexhex {

/// Components of the two forms of a map.
inline constexpr std::size_t kCellMapComponents = 12;
inline constexpr std::size_t kPointMapComponents = 3;

/// The numbers of an array, tuple by tuple.
struct GridMap {
  bool ofCells = false;  ///< 12 numbers for each cell of the file; else 3 for each point
  Array<double> values;
};

/// Points and cells of one kind, and the map if there is one of the right name and form.
template <std::size_t corners>
struct Grid {
  CellMesh<corners> mesh;
  Array<std::size_t> cellInFile;  ///< which cell of the file each is; empty: the same number
  std::optional<GridMap> map;
  std::vector<std::string> arrays;  ///< all that were seen on the way, for messages
};
using TetGrid = Grid<4>;

/// "igm (cells, 3 components)": an entry for Grid::arrays.
[[nodiscard]] std::string describeArray(std::string_view name, bool ofCells,
                                        std::size_t components);

/// The map of tets.
/// @param name  of the map's array, for messages
/// @throws Error FileUnsupported without a map; NotFinite
[[nodiscard]] TetMap toTetMap(TetGrid&& grid, std::string_view name, const std::string& fileName,
                              Stage& stage);

}  // namespace hexhex
