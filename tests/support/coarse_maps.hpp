// Valid maps so coarse that cells meet themselves: different edges and faces of the mesh have the
// same vertices.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <hexhex/types.hpp>

namespace hexhex::test {

/// A 3-torus, which has no boundary and no positions in space that make sense, in one chart up to
/// translations by `cells` along each axis.
inline TetMap threeTorus(Index cells) {
  constexpr Index kSide = 3;  // the fewest of which vertices name tets
  constexpr std::array<std::array<std::size_t, 3>, 6> kOrders = {
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  TetMap map;
  for (Index i = 0; i < kSide * kSide * kSide; ++i) {
    map.points.push_back({i % kSide * 1.0, i / kSide % kSide * 1.0, i / kSide / kSide * 1.0});
  }
  for (Index i = 0; i < kSide * kSide * kSide; ++i) {
    for (std::size_t order = 0; order < 6; ++order) {
      std::array<Index, 3> at = {i % kSide, i / kSide % kSide, i / kSide / kSide};
      Tet tet{};
      TetParameters parameters{};
      for (std::size_t c = 0; c < 4; ++c) {
        if (c > 0) ++at[kOrders[order][c - 1]];
        tet[c] = at[0] % kSide + kSide * (at[1] % kSide + kSide * (at[2] % kSide));
        for (std::size_t k = 0; k < 3; ++k) {
          parameters[c][k] = static_cast<double>(cells * at[k]) / kSide;
        }
      }
      if (order >= 3) {
        std::swap(tet[2], tet[3]);
        std::swap(parameters[2], parameters[3]);
      }
      map.tets.push_back(tet);
      map.parameters.push_back(parameters);
    }
  }
  return map;
}

/// A stack of quads each of which is rolled up around a corner, so that two of its sides meet: an
/// inner edge of valence 1.
inline TetMap rolledUp(Index layers) {
  constexpr Index kRing = 4;  // vertices of a layer: the corner, and these around it
  constexpr std::array<std::array<double, 2>, kRing + 1> kAround = {
      {{1, 0}, {1, 0.5}, {1, 1}, {0.5, 1}, {0, 1}}};
  TetMap map;
  for (Index level = 0; level <= layers; ++level) {
    map.points.push_back({0, 0, level * 1.0});
    for (Index i = 0; i < kRing; ++i) {
      const double angle = i * 2 * std::numbers::pi / kRing;
      map.points.push_back({std::cos(angle), std::sin(angle), level * 1.0});
    }
  }
  for (Index level = 0; level < layers; ++level) {
    for (Index i = 0; i < kRing; ++i) {
      // A prism: its three tets follow from the order of vertices, as do those of its neighbours.
      std::array<Index, 3> base = {0, 1 + i, 1 + (i + 1) % kRing};
      std::array<std::array<double, 2>, 3> u = {{{0, 0}, kAround[i], kAround[i + 1]}};
      if (base[1] > base[2]) {
        std::swap(base[1], base[2]);
        std::swap(u[1], u[2]);
      }
      for (std::size_t raised = 0; raised < 3; ++raised) {
        Tet tet{};
        TetParameters parameters{};
        for (std::size_t c = 0; c < 4; ++c) {
          const std::size_t corner = c <= raised ? c : c - 1;
          const Index z = level + (c > raised ? 1 : 0);
          tet[c] = base[corner] + z * (kRing + 1);
          parameters[c] = {u[corner][0], u[corner][1], z * 1.0};
        }
        if ((raised == 1) != (i + 1 == kRing)) {
          std::swap(tet[0], tet[1]);
          std::swap(parameters[0], parameters[1]);
        }
        map.tets.push_back(tet);
        map.parameters.push_back(parameters);
      }
    }
  }
  return map;
}

}  // namespace hexhex::test
