// Meshes and maps from the data sets of vtk_source.hpp: which cells and arrays they are made of,
// and what is wrong with them, whatever the format.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <hexhex/features.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <io/core/cell_mesh.hpp>
#include <io/core/triangle_labels.hpp>
#include <io/vtk/vtk_source.hpp>

namespace hexhex::io {

/// Reads points from number `first` on; or all, with all threads.
/// @throws Error NotFinite
void readVtkPoints(const VtkSource& source, std::uint64_t first, std::span<Vec3> points);
void readVtkPoints(const VtkSource& source, std::span<Vec3> points, Stage& stage);

/// Number of wanted cells among `count` cells from number `first` on.
[[nodiscard]] std::size_t countVtkCells(const VtkSource& source, const CellKind& cells,
                                        std::uint64_t first, std::size_t count);

/// Reads the wanted cells among `count` cells from number `first` on.
/// @tparam Vertex   Index or std::uint64_t
/// @param vertices  room for the corners of as many cells as countVtkCells() says
/// @param numbers   if not null, room for as many: which cells of the file they are
/// @throws Error FileSyntax, IndexOutOfRange
template <class Vertex>
void readVtkCells(const VtkSource& source, const CellKind& cells, std::uint64_t first,
                  std::size_t count, Vertex* vertices, std::size_t* numbers = nullptr);

/// Reads all wanted cells, with all threads.
/// @param makeRoom  called with their number; returns where their corners go
/// @param[out] numbers  if not null: which cells of the file they are
/// @throws Error the same; FileUnsupported if there are only others
void readVtkCells(const VtkSource& source, const CellKind& cells,
                  const std::function<Index*(std::size_t)>& makeRoom, Array<std::size_t>* numbers,
                  Stage& stage);

/// Notes what types of cells there are.
/// @param count  of the wanted ones
void noteVtkCells(const VtkSource& source, const CellKind& cells, std::uint64_t count);

/// Throws the error of a file with cells, but no wanted ones.
[[noreturn]] void failWithoutVtkCells(const VtkSource& source, const CellKind& cells);

/// The simplices that points were generated on, in two arrays as this library writes them.
struct VtkGenerators {
  std::optional<VtkColumn> tets;
  std::optional<VtkColumn> corners;
};
[[nodiscard]] VtkGenerators findVtkGenerators(const VtkSource& source);
/// Reads both, unless arrays of their names are something else.
void readVtkGenerators(const VtkSource& source, Array<Index>& tets, Array<CornerSet>& corners);

/// Tags and regions as addTags() writes them. Arrays of other forms belong to other programs, and
/// are ignored.
/// @throws Error FileSyntax if an array has too few or too many numbers; FileUnsupported for a tag
///         or region that does not fit into 32 bits; IndexOutOfRange for a vertex that is no point
[[nodiscard]] HexFeatures readVtkHexFeatures(const VtkSource& source);
[[nodiscard]] Features readVtkTetFeatures(const VtkSource& source);
[[nodiscard]] bool hasVtkRegions(const VtkSource& source);
/// @param cells  the numbers of the cells that are wanted, ascending
[[nodiscard]] Array<std::int32_t> readVtkRegions(const VtkSource& source,
                                                 std::span<const std::size_t> cells);

/// Reads points and hexahedra, and what else writers of this library add.
[[nodiscard]] HexMesh readVtkHexMesh(const VtkSource& source, Stage& stage);
/// Reads points and tets.
[[nodiscard]] TetCells readVtkTets(const VtkSource& source, Stage& stage);
/// Reads tets and their map from an array of floating-point numbers. One of 12 numbers per cell
/// holds u0 v0 w0 u1 v1 w1 u2 v2 w2 u3 v3 w3, the parameters of a tet's corners in their order; one
/// of 3 numbers per point holds its u v w, for maps with one chart.
/// @param mapArray  its name
/// @throws Error FileUnsupported without such an array; NotFinite
[[nodiscard]] TetMap readVtkMap(VtkSource& source, std::string_view mapArray, Stage& stage);

/// Reads triangles with a whole number each.
/// @param name  of the cell array
[[nodiscard]] TriangleLabels readVtkLabels(VtkSource& source, std::string_view name, Stage& stage);

}  // namespace hexhex::io
