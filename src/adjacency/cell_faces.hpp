// Faces and edges of cells: their corners, and which of them coincide.
#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include <hexhex/types.hpp>

#include <lattice/tet_geometry.hpp>

namespace hexhex::adjacency {

/// Two edges are the same if these are equal.
[[nodiscard]] inline std::array<Index, 2> ascending(Index a, Index b) noexcept {
  return {std::min(a, b), std::max(a, b)};
}

/// Two quads are the same if these are equal.
[[nodiscard]] inline Quad ascending(Quad quad) noexcept {
  std::sort(quad.begin(), quad.end());
  return quad;
}

[[nodiscard]] inline bool namesAVertexTwice(Hex cell) noexcept {
  std::sort(cell.begin(), cell.end());
  return std::adjacent_find(cell.begin(), cell.end()) != cell.end();
}

/// Local corners of the six faces of a hexahedron, counter-clockwise seen from outside, in VTK's
/// order: 2 * axis at corner 0, 2 * axis + 1 across from it.
inline constexpr std::array<std::array<std::uint8_t, 4>, 6> kHexFaces = {
    {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}}};

/// Local corners of the twelve edges of a hexahedron, in VTK's order.
inline constexpr std::array<std::array<std::uint8_t, 2>, 12> kHexEdges = {{{0, 1},
                                                                           {1, 2},
                                                                           {3, 2},
                                                                           {0, 3},
                                                                           {4, 5},
                                                                           {5, 6},
                                                                           {7, 6},
                                                                           {4, 7},
                                                                           {0, 4},
                                                                           {1, 5},
                                                                           {3, 7},
                                                                           {2, 6}}};

/// Local corners of the six edges of a tet.
inline constexpr std::array<std::array<std::uint8_t, 2>, 6> kTetEdges = {
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

/// Local corners of the faces of a cell; face i of a tet is opposite corner i.
template <class Cell>
[[nodiscard]] constexpr const auto& facesOf() noexcept {
  if constexpr (std::is_same_v<Cell, Hex>) {
    return kHexFaces;
  } else {
    static_assert(std::is_same_v<Cell, Tet>);
    return lattice::kFaceCorners;
  }
}

/// Number of faces of a cell, and of corners of a face.
template <class Cell>
inline constexpr std::size_t kFaceCount =
    std::tuple_size_v<std::decay_t<decltype(facesOf<Cell>())>>;
template <class Cell>
inline constexpr std::size_t kFaceSize = std::is_same_v<Cell, Hex> ? 4 : 3;

/// The vertices of a face of a cell: counter-clockwise seen from outside for a hexahedron, from
/// inside for a positive tet.
template <std::size_t n>
[[nodiscard]] constexpr auto faceVertices(const std::array<Index, n>& cell,
                                          std::size_t face) noexcept {
  using Cell = std::array<Index, n>;
  std::array<Index, kFaceSize<Cell>> vertices{};
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    vertices[i] = cell[static_cast<std::size_t>(facesOf<Cell>()[face][i])];
  }
  return vertices;
}

/// Whether two faces list the same vertices in opposite directions, starting anywhere.
template <std::size_t n>
[[nodiscard]] constexpr bool areOpposite(const std::array<Index, n>& here,
                                         const std::array<Index, n>& there) noexcept {
  for (std::size_t shift = 0; shift < n; ++shift) {
    bool same = true;
    for (std::size_t i = 0; i < n; ++i) same = same && here[i] == there[(shift + n - i) % n];
    if (same) return true;
  }
  return false;
}

/// Calls visit(run) for each run of equal elements of a sorted list.
template <class T, class Same, class Visit>
void forEachRun(std::span<const T> sorted, const Same& same, const Visit& visit) {
  for (std::size_t begin = 0; begin < sorted.size();) {
    std::size_t end = begin + 1;
    while (end < sorted.size() && same(sorted[begin], sorted[end])) ++end;
    visit(sorted.subspan(begin, end - begin));
    begin = end;
  }
}

/// A half-face: a face as one of its cells sees it.
template <class Cell>
struct CellFace {
  /// The face's vertices except the smallest, ascending.
  std::array<Index, kFaceSize<Cell> - 1> others{};
  Index cell = kNone;
  std::uint8_t face = 0;

  auto operator<=>(const CellFace&) const = default;
};

/// Calls visit(half-faces of the face, by cell) for each face, by smallest vertex and then in
/// lexicographic order. Faces are the same if they have the same vertices, so all cells of a face
/// are found at its smallest vertex.
/// @param begin, end  range of the smallest vertices of faces
/// @param cellsAt  cellsAt(vertex): the cells at it, ascending; a repeated one counts once
/// @param isWanted  isWanted(cell, face): whether to look at a half-face
template <class Cell, class CellsAt, class Filter, class Visit>
void forEachFace(std::span<const Cell> cells, std::size_t begin, std::size_t end,
                 const CellsAt& cellsAt, const Filter& isWanted, const Visit& visit) {
  std::vector<CellFace<Cell>> found;
  for (std::size_t vertex = begin; vertex < end; ++vertex) {
    found.clear();
    Index previous = kNone;
    for (const Index cell : cellsAt(vertex)) {
      if (cell == previous) continue;
      previous = cell;
      for (std::uint8_t face = 0; face < kFaceCount<Cell>; ++face) {
        if (!isWanted(cell, face)) continue;
        auto vertices = faceVertices(cells[cell], face);
        Index smallest = vertices[0];
        for (const Index other : vertices) smallest = std::min(smallest, other);
        if (smallest != vertex) continue;
        std::sort(vertices.begin(), vertices.end());
        found.push_back({{}, cell, face});
        std::copy(vertices.begin() + 1, vertices.end(), found.back().others.begin());
      }
    }
    std::sort(found.begin(), found.end());
    forEachRun(
        std::span<const CellFace<Cell>>(found),
        [](const auto& a, const auto& b) { return a.others == b.others; }, visit);
  }
}

/// The same for all half-faces.
template <class Cell, class CellsAt, class Visit>
void forEachFace(std::span<const Cell> cells, std::size_t begin, std::size_t end,
                 const CellsAt& cellsAt, const Visit& visit) {
  forEachFace(
      cells, begin, end, cellsAt, [](Index /*cell*/, std::size_t /*face*/) { return true; }, visit);
}

}  // namespace hexhex::adjacency
