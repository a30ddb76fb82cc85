// Points, and cells of one kind: what readers take from files that may hold other cells, too.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <hexhex/error.hpp>
#include <hexhex/types.hpp>

namespace hexhex {

/// Hexahedra (8 corners) or tetrahedra (4) with their points. Corners are in the order of VTK.
template <std::size_t corners>
struct CellMesh {
  Array<Vec3> points;
  Array<std::array<Index, corners>> cells;
  // Where the format has them, and only with hexahedra.
  HexFeatures features = {};
  Array<std::int32_t> regions = {};
};
using TetCells = CellMesh<4>;

/// What formats and sentences call a kind of elements.
struct CellKind {
  std::size_t corners = 0;
  std::string_view singular;
  std::string_view plural;
  std::string_view meditKeyword = {};
  std::uint32_t meshbKeyword = 0;
  std::int64_t gmshType = 0;
  std::int64_t vtkType = 0;
  PlaceKind place = PlaceKind::None;
};

template <std::size_t corners>
inline constexpr CellKind kCellKind = {};
template <>
inline constexpr CellKind kCellKind<4> = {4,  "tetrahedron", "tetrahedra", "Tetrahedra", 8, 4,
                                          10, PlaceKind::Tet};
template <>
inline constexpr CellKind kCellKind<8> = {8, "hexahedron", "hexahedra",    "Hexahedra", 10,
                                          5, 12,           PlaceKind::Cell};

/// The same as a hex mesh.
[[nodiscard]] inline HexMesh toHexMesh(CellMesh<8>&& mesh) {
  HexMesh result;
  result.points = std::move(mesh.points);
  result.cells = std::move(mesh.cells);
  result.features = std::move(mesh.features);
  result.regions = std::move(mesh.regions);
  return result;
}

}  // namespace hexhex
