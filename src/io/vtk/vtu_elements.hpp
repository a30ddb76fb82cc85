// Points and cells of one kind of a `.vtu` file, a range at a time, checked.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>

#include <hexhex/types.hpp>

#include <io/core/cell_mesh.hpp>
#include <io/vtk/vtu_file.hpp>

namespace hexhex {

/// Reads points from number `first` on.
/// @throws Error NotFinite
inline void readVtuPoints(const VtuFile& file, std::uint64_t first, std::span<Vec3> points) {
  file.copy(file.coordinates(), 3 * first, 3 * points.size(), points.data()->data());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (std::isfinite(points[i][0]) && std::isfinite(points[i][1]) && std::isfinite(points[i][2])) {
      continue;
    }
    file.fail(ErrorCode::NotFinite,
              "a coordinate of point " + std::to_string(first + i) + " is not finite.",
              Place{PlaceKind::Vertex, first + i});
  }
}

/// Number of cells of a kind among `count` cells from number `first` on.
[[nodiscard]] std::size_t countVtuCells(const VtuFile& file, const CellKind& kind,
                                        std::uint64_t first, std::size_t count);

/// Reads the cells with so many corners, hexahedra or tets, among `count` cells from number `first`
/// on.
/// @param cells  room for as many as countVtuCells() says
/// @param numbers  if not null, room for as many: which cells of the file they are
/// @throws Error FileSyntax, IndexOutOfRange
template <class Vertex, std::size_t corners>
void readVtuCells(const VtuFile& file, std::uint64_t first, std::size_t count,
                  std::array<Vertex, corners>* cells, std::size_t* numbers = nullptr);

/// Throws the error of a file with cells but none of a kind among them.
[[noreturn]] void failWithoutCells(const VtuFile& file, const CellKind& kind);

}  // namespace hexhex
