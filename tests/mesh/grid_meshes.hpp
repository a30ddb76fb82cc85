// Small meshes with known properties: grids of hexahedra, and tets with a map that is the identity.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>

#include <hexhex/types.hpp>

#include "support/random.hpp"

namespace hexhex::testing {

using test::Random;

/// Which cells of a grid exist.
using CellFilter = std::function<bool(std::size_t x, std::size_t y, std::size_t z)>;

/// Unit cubes of an n x n x n grid, those that `exists` accepts. All points of the grid come first;
/// unused ones are removed.
inline HexMesh gridMesh(std::size_t n, const CellFilter& exists = {}) {
  HexMesh mesh;
  const std::size_t side = n + 1;
  Array<Index> numbers(side * side * side, kNone);
  const auto vertex = [&](std::size_t x, std::size_t y, std::size_t z) {
    Index& number = numbers[(z * side + y) * side + x];
    if (number == kNone) {
      number = static_cast<Index>(mesh.points.size());
      mesh.points.push_back(
          {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
    }
    return number;
  };
  for (std::size_t z = 0; z < n; ++z) {
    for (std::size_t y = 0; y < n; ++y) {
      for (std::size_t x = 0; x < n; ++x) {
        if (exists && !exists(x, y, z)) continue;
        mesh.cells.push_back({vertex(x, y, z), vertex(x + 1, y, z), vertex(x + 1, y + 1, z),
                              vertex(x, y + 1, z), vertex(x, y, z + 1), vertex(x + 1, y, z + 1),
                              vertex(x + 1, y + 1, z + 1), vertex(x, y + 1, z + 1)});
      }
    }
  }
  return mesh;
}

/// The same cell the other way round.
inline Hex reversed(const Hex& cell) {
  return {cell[4], cell[5], cell[6], cell[7], cell[0], cell[1], cell[2], cell[3]};
}

/// An n x n x n box of unit cubes, each split into six tets around its diagonal, with parameters
/// equal to positions.
inline TetMap identityMap(std::size_t n) {
  const HexMesh grid = gridMesh(n);
  TetMap map;
  map.points.assign(grid.points.begin(), grid.points.end());
  // Kuhn's subdivision: paths from corner 0 to corner 6 along three edges, one per order of axes.
  constexpr std::array<std::array<std::size_t, 2>, 6> kPaths = {
      {{1, 2}, {2, 3}, {3, 7}, {7, 4}, {4, 5}, {5, 1}}};
  for (const Hex& cell : grid.cells) {
    for (const auto& [a, b] : kPaths) map.tets.push_back({cell[0], cell[a], cell[b], cell[6]});
  }
  for (const Tet& tet : map.tets) {
    map.parameters.push_back(
        {map.points[tet[0]], map.points[tet[1]], map.points[tet[2]], map.points[tet[3]]});
  }
  return map;
}

/// The same mesh with vertices and cells in random order.
inline HexMesh shuffled(const HexMesh& mesh, std::uint64_t seed) {
  Random random(seed);
  Array<Index> places(mesh.points.size());
  for (std::size_t v = 0; v < places.size(); ++v) places[v] = static_cast<Index>(v);
  for (std::size_t v = places.size(); v > 1; --v) {
    std::swap(places[v - 1], places[random.below(v)]);
  }
  HexMesh result;
  result.points.resize(mesh.points.size());
  for (std::size_t v = 0; v < places.size(); ++v) result.points[places[v]] = mesh.points[v];
  result.cells = mesh.cells;
  for (std::size_t c = result.cells.size(); c > 1; --c) {
    std::swap(result.cells[c - 1], result.cells[random.below(c)]);
  }
  for (Hex& cell : result.cells) {
    for (Index& v : cell) v = places[v];
  }
  return result;
}

}  // namespace hexhex::testing
