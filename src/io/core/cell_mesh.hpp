// Points, and cells of one kind: what readers take from files that may hold other cells, too.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>

#include <hexhex/error.hpp>
#include <hexhex/types.hpp>

namespace hexhex::io {

/// Tetrahedra with their points. Corners are in the order of VTK.
struct TetCells {
  Array<Vec3> points;
  Array<Tet> cells;
  // Readers leave them empty: features and regions are read of hexahedra only.
  HexFeatures features = {};
  Array<std::int32_t> regions = {};
};

/// What readers make of hexahedra (8 corners) or tetrahedra (4).
template <std::size_t corners>
using CellMesh = std::conditional_t<corners == 8, HexMesh, TetCells>;

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

/// Triangles, which carry labels.
inline constexpr CellKind kTriangleKind = {
    .corners = 3, .singular = "triangle", .plural = "triangles", .vtkType = 5};

}  // namespace hexhex::io
